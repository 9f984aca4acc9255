// Meshes that deform: their vertices from the host or from its buffers, and the refit of their hierarchies.
#include "solver/solver_state.hpp"

namespace voile
{

namespace
{

// Where a mesh's input lies, bytes.
VkDeviceSize input_offset(const DeformingMesh& mesh)
{
    return VkDeviceSize{mesh.first_vertex} / 2 * k_most_stride;
}

uint32_t stride_of(const Deformation& deformation)
{
    return deformation.source ? deformation.source->stride : static_cast<uint32_t>(sizeof(glm::vec3));
}

void record_vertices(gpu::Recorder& recorder, const Solver::State& solver, const DeformingMesh& mesh,
                     const Deformation& deformation)
{
    const glm::vec3 origin = solver.collider_models.colliders[mesh.collider].record.origin;
    glm::dmat4 transform(mesh.transform);
    transform[3] -= glm::dvec4(origin, 0);
    const shared::DeformPush push{glm::mat4(transform),
                                  origin,
                                  static_cast<uint32_t>(input_offset(mesh) / sizeof(float)),
                                  stride_of(deformation) / static_cast<uint32_t>(sizeof(float)),
                                  mesh.first(deformation.now),
                                  mesh.first(1 - deformation.now),
                                  mesh.vertices};
    recorder.dispatch(solver.kernels.deform, solver.device->sets.deform, mesh.vertices,
                      solver.options.tuning.workgroup_size, push);
}

// Boxes of the triangles as they move from one of the mesh's two sets of positions to the other.
void record_boxes(gpu::Recorder& recorder, const Solver::State& solver, const DeformingMesh& mesh, uint32_t from,
                  uint32_t to)
{
    const shared::ColliderRecord& collider = solver.collider_models.colliders[mesh.collider].record;
    record_refit(recorder, solver.kernels.refit, solver.device->sets.refit,
                 {collider.first_node, collider.first_triangle, mesh.first(from), mesh.first(to), collider.triangles});
}

// The deforming mesh of a collider, or the reason why there is none.
Result<size_t> find_deforming(const ColliderModels& models, ColliderId collider)
{
    for (size_t i = 0; i < models.deforming.size(); ++i)
        if (models.deforming[i].collider == collider.index)
            return i;
    if (auto exists = check_id("collider", collider.index, models.colliders.size()); !exists)
        return exists.error();
    return Error{"collider " + std::to_string(collider.index) + " does not deform: it was added without \"deforms\""};
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

} // namespace

void record_deforming_input(gpu::Recorder& recorder, const Solver::State& solver)
{
    for (size_t i = 0; i < solver.device->deforming_count; ++i)
    {
        const DeformingMesh& mesh = solver.collider_models.deforming[i];
        const Deformation& deformation = solver.deformations[i];
        const VkBuffer input = (*solver.device)[buffer::deforming_input].handle();
        if (!deformation.due)
            continue;
        if (!deformation.source)
        {
            recorder.update(input, input_offset(mesh), std::as_bytes(std::span(deformation.positions)));
            continue;
        }
        const DeviceVertices& source = *deformation.source;
        const VkDeviceSize bytes = VkDeviceSize{mesh.vertices - 1} * source.stride + sizeof(glm::vec3);
        const VkBufferCopy region{source.offset, input_offset(mesh), bytes};
        recorder.copy(source.buffer, input, region);
    }
}

void record_deforming_passes(gpu::Recorder& recorder, Solver::State& solver)
{
    bool came_to_rest = false;
    for (size_t i = 0; i < solver.device->deforming_count; ++i)
    {
        const DeformingMesh& mesh = solver.collider_models.deforming[i];
        Deformation& deformation = solver.deformations[i];
        if (deformation.due)
            record_vertices(recorder, solver, mesh, deformation);
        if (deformation.due || solver.refit_due)
            record_boxes(recorder, solver, mesh, deformation.now,
                         deformation.due ? 1 - deformation.now : deformation.now);
        came_to_rest |= deformation.due; // if it stays where it goes: the boxes of this step are too large for the next
        if (deformation.due)
            deformation.now = 1 - deformation.now;
        deformation.due = false;
    }
    solver.refit_due = came_to_rest;
}

void record_uploaded_boxes(gpu::Recorder& recorder, Solver::State& solver)
{
    if (solver.collider_models.deforming.empty())
        return;
    recorder.barrier(VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR,
                     VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR, VK_ACCESS_2_SHADER_STORAGE_READ_BIT_KHR);
    for (size_t i = 0; i < solver.device->deforming_count; ++i)
        record_boxes(recorder, solver, solver.collider_models.deforming[i], solver.deformations[i].now,
                     solver.deformations[i].now);
    solver.refit_due = false;
}

Result<void> Solver::deform_collider(ColliderId collider, std::span<const glm::vec3> positions)
{
    State& s = *state_;
    const auto index = find_deforming(s.collider_models, collider);
    if (!index)
        return index.error();
    const DeformingMesh& mesh = s.collider_models.deforming[index.value()];
    const std::string name = "collider " + std::to_string(collider.index);
    if (positions.size() != mesh.vertices)
        return Error{name + ": " + std::to_string(positions.size()) + " positions, but it was added with " +
                     std::to_string(mesh.vertices)};
    for (size_t i = 0; i < positions.size(); ++i)
        if (!finite(positions[i]))
            return Error{name + ": position " + std::to_string(i) + " is not finite"};
    if (auto range = check_deformed(name, mesh, positions); !range)
        return range;
    Deformation& deformation = s.deformations[index.value()];
    deformation.positions.assign(positions.begin(), positions.end());
    deformation.source.reset();
    deformation.due = true;
    return {};
}

Result<void> Solver::deform_collider(ColliderId collider, const DeviceVertices& vertices)
{
    State& s = *state_;
    const auto index = find_deforming(s.collider_models, collider);
    if (!index)
        return index.error();
    const std::string name = "collider " + std::to_string(collider.index);
    if (vertices.buffer == VK_NULL_HANDLE)
        return Error{name + ": no buffer of vertices"};
    if (vertices.offset % 4 != 0)
        return Error{name + ": the vertices' offset is " + std::to_string(vertices.offset) +
                     " bytes, must be a multiple of 4"};
    if (vertices.stride < sizeof(glm::vec3) || vertices.stride > k_most_stride || vertices.stride % 4 != 0)
        return Error{name + ": the vertices' stride is " + std::to_string(vertices.stride) +
                     " bytes, must be 12 to 64 and a multiple of 4"};
    Deformation& deformation = s.deformations[index.value()];
    deformation.source = vertices;
    deformation.due = true;
    return {};
}

} // namespace voile
