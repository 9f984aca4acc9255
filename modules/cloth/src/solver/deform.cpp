// Meshes that deform: their vertices from the host or from its buffers, and the refit of their hierarchies.
#include "solver/solver_state.hpp"

#include <algorithm>
#include <cmath>

namespace voile
{

namespace
{

// Offset of a mesh's input, bytes.
VkDeviceSize input_offset(const DeformingMesh& mesh)
{
    return VkDeviceSize{mesh.first_vertex} / 2 * k_most_stride;
}

uint32_t stride_of(const DeformingMesh& mesh)
{
    return mesh.source ? mesh.source->stride : static_cast<uint32_t>(sizeof(glm::vec3));
}

void record_vertices(gpu::Recorder& recorder, const Solver::State& solver, const ColliderModel& collider)
{
    const DeformingMesh& mesh = *collider.deforming;
    const glm::vec3 origin = collider.record.origin;
    glm::dmat4 transform(mesh.transform);
    transform[3] -= glm::dvec4(origin, 0);
    const shared::DeformPush push{glm::mat4(transform),
                                  origin,
                                  static_cast<uint32_t>(input_offset(mesh) / sizeof(float)),
                                  stride_of(mesh) / static_cast<uint32_t>(sizeof(float)),
                                  mesh.first_from(),
                                  mesh.first_to(),
                                  mesh.vertices};
    recorder.dispatch(solver.kernels.deform, solver.device->sets.deform, mesh.vertices,
                      solver.options.tuning.workgroup_size, push);
}

// Boxes of the triangles as they move from one of the mesh's two sets of positions to the other.
void record_boxes(gpu::Recorder& recorder, const Solver::State& solver, const ColliderModel& collider)
{
    const shared::ColliderRecord& record = collider.record;
    shared::TreeRecord tree{};
    tree.first_box = record.first_node;
    tree.first_leaf = record.first_triangle;
    tree.first_from = collider.deforming->first_from();
    tree.first_to = collider.deforming->first_to();
    tree.triangles = record.triangles;
    record_refit(recorder, solver.kernels.refit, solver.device->sets.refit, tree);
}

// Which way its features face in one of the two sets of positions.
void record_facings(gpu::Recorder& recorder, const Solver::State& solver, const ColliderModel& collider, uint32_t half)
{
    if (!collider.features || collider.features->set.features == 0)
        return;
    const ColliderFeatures& features = *collider.features;
    const auto& first = solver.collider_models.features.find(&features)->first;
    const uint32_t count = features.set.features;
    const shared::FaceFeaturesPush push{static_cast<uint32_t>(first[k_feature_sources]),
                                        count,
                                        collider.deforming->first(half),
                                        static_cast<uint32_t>(first[k_feature_facings]) + half * count,
                                        (collider.record.flags & VOILE_COLLIDER_ONE_SIDED) == 0 ? 1u : 0u,
                                        features.scale.edge,
                                        k_allowed_fraction * features.scale.thickness};
    recorder.dispatch(solver.kernels.face_features, solver.device->sets.face_features, count,
                      solver.options.tuning.workgroup_size, push);
}

// The deforming mesh of a collider, or the reason why there is none.
Result<DeformingMesh*> find_deforming(ColliderModels& models, ColliderId id)
{
    if (auto exists = models.colliders.check("collider", id); !exists)
        return exists.error();
    ColliderModel& collider = *models.colliders.find(id);
    if (!collider.deforming)
        return Error{"collider " + std::to_string(id.index) + " does not deform: it was added without \"deforms\""};
    return &*collider.deforming;
}

// In the world, as the vertices of other meshes.
Result<void> check_deformed(const std::string& name, const DeformingMesh& mesh, std::span<const glm::vec3> positions)
{
    for (size_t i = 0; i < positions.size(); ++i)
    {
        const glm::vec3 world(mesh.transform * glm::vec4(positions[i], 1));
        if (!within(world, k_most_coordinate))
            return Error{name + ": position " + std::to_string(i) + " is at " + text(world) + ", each must be " +
                         text(-k_most_coordinate) + " to " + text(k_most_coordinate) + " m"};
    }
    return {};
}

// m: how far a vertex moves from what the host gave last.
float farthest_vertex(const DeformingMesh& mesh, std::span<const glm::vec3> positions)
{
    const std::vector<glm::vec3>& last = mesh.input.empty() ? mesh.positions : mesh.input;
    float farthest = 0;
    for (size_t i = 0; i < positions.size(); ++i)
    {
        const glm::vec3 motion = glm::mat3(mesh.transform) * (positions[i] - last[i]);
        farthest = std::max(farthest, glm::dot(motion, motion));
    }
    return std::sqrt(farthest);
}

} // namespace

void record_deforming_input(gpu::Recorder& recorder, const Solver::State& solver)
{
    const VkBuffer input = (*solver.device)[buffer::deforming_input].handle();
    recorder.fill((*solver.device)[buffer::deforming_reach].handle(), 0);
    for (const auto [index, collider] : solver.collider_models.colliders)
    {
        if (!collider.uploaded || !collider.deforming || !collider.deforming->due)
            continue;
        const DeformingMesh& mesh = *collider.deforming;
        if (!mesh.source)
        {
            recorder.update(input, input_offset(mesh), std::as_bytes(std::span(mesh.input)));
            continue;
        }
        const VkDeviceSize bytes = VkDeviceSize{mesh.vertices - 1} * mesh.source->stride + sizeof(glm::vec3);
        recorder.copy(mesh.source->buffer, input, {mesh.source->offset, input_offset(mesh), bytes});
    }
}

void record_deforming_passes(gpu::Recorder& recorder, Solver::State& solver)
{
    for (auto [index, collider] : solver.collider_models.colliders)
    {
        if (!collider.uploaded || !collider.deforming)
            continue;
        DeformingMesh& mesh = *collider.deforming;
        if (mesh.due)
        {
            record_vertices(recorder, solver, collider);
            record_facings(recorder, solver, collider, mesh.next());
        }
        if (mesh.due || mesh.refit_due)
            record_boxes(recorder, solver, collider);
        mesh.refit_due = mesh.due; // if it rests then: this step's boxes are too large for the next
        if (mesh.due)
            mesh.now = 1 - mesh.now;
        mesh.due = false;
    }
}

void record_at_rest(gpu::Recorder& recorder, const Solver::State& solver, const NewDeforming& colliders)
{
    for (const ColliderId id : colliders.meshes)
        record_boxes(recorder, solver, *solver.find(id));
    for (const ColliderId id : colliders.features)
    {
        const ColliderModel& collider = *solver.find(id);
        record_facings(recorder, solver, collider, collider.deforming->now);
    }
}

Result<void> Solver::deform_collider(ColliderId collider, std::span<const glm::vec3> positions)
{
    State& s = *state_;
    const auto found = find_deforming(s.collider_models, collider);
    if (!found)
        return found.error();
    DeformingMesh& mesh = *found.value();
    const std::string name = "collider " + std::to_string(collider.index);
    if (positions.size() != mesh.vertices)
        return Error{name + ": " + std::to_string(positions.size()) + " positions, but it was added with " +
                     std::to_string(mesh.vertices)};
    for (size_t i = 0; i < positions.size(); ++i)
        if (!finite(positions[i]))
            return Error{name + ": position " + std::to_string(i) + " is not finite"};
    if (auto range = check_deformed(name, mesh, positions); !range)
        return range;
    mesh.farthest = (mesh.due ? mesh.farthest : 0) + farthest_vertex(mesh, positions);
    mesh.input.assign(positions.begin(), positions.end());
    mesh.source.reset();
    mesh.due = true;
    return {};
}

Result<void> Solver::deform_collider(ColliderId collider, const DeviceVertices& vertices)
{
    State& s = *state_;
    const auto found = find_deforming(s.collider_models, collider);
    if (!found)
        return found.error();
    DeformingMesh& mesh = *found.value();
    const std::string name = "collider " + std::to_string(collider.index);
    if (vertices.buffer == VK_NULL_HANDLE)
        return Error{name + ": no buffer of vertices"};
    if (vertices.offset % 4 != 0)
        return Error{name + ": the vertices' offset is " + std::to_string(vertices.offset) +
                     " bytes, must be a multiple of 4"};
    if (vertices.stride < sizeof(glm::vec3) || vertices.stride > k_most_stride || vertices.stride % 4 != 0)
        return Error{name + ": the vertices' stride is " + std::to_string(vertices.stride) +
                     " bytes, must be 12 to 64 and a multiple of 4"};
    mesh.source = vertices;
    mesh.farthest = 0;
    mesh.due = true;
    return {};
}

} // namespace voile
