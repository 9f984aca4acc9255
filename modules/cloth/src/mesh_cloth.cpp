// Meshes as cloth: validation, their lists, and the layout of these on the GPU.
#include "mesh_input.hpp"
#include "model.hpp"

#include <algorithm>
#include <cmath>

namespace cloth
{

namespace
{

Result<void> validate_shape(const MeshCloth& cloth)
{
    const auto bad = [&](const std::string& reason) { return invalid("cloth", cloth.name, reason); };
    if (cloth.triangles.empty())
        return bad("the mesh has no triangles");
    if (auto valid = validate_triangles("cloth", cloth.name, cloth.positions, cloth.triangles); !valid)
        return valid.error();
    if (!cloth.texture_coordinates.empty() && cloth.texture_coordinates.size() != cloth.positions.size())
        return bad(std::to_string(cloth.texture_coordinates.size()) + " texture coordinates for " +
                   std::to_string(cloth.positions.size()) + " positions");
    return {};
}

std::vector<glm::dvec3> places(const MeshCloth& cloth)
{
    const glm::dmat4 transform = without_rounding(cloth.transform);
    std::vector<glm::dvec3> result;
    result.reserve(cloth.positions.size());
    for (const glm::vec3& p : cloth.positions)
        result.emplace_back(transform * glm::dvec4(p, 1));
    return result;
}

// The mesh seen along the axis of its smallest extent.
std::vector<glm::vec2> projected(std::span<const glm::dvec3> positions)
{
    glm::dvec3 low(std::numeric_limits<double>::max());
    glm::dvec3 high(std::numeric_limits<double>::lowest());
    for (const glm::dvec3& p : positions)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::dvec3 extent = high - low;
    const int along = extent.x <= extent.y && extent.x <= extent.z ? 0 : extent.y <= extent.z ? 1 : 2;
    std::vector<glm::vec2> result;
    result.reserve(positions.size());
    for (const glm::dvec3& p : positions)
        result.emplace_back((p - low)[along == 0 ? 1 : 0], (p - low)[along == 2 ? 1 : 2]);
    return result;
}

// Places the lists of `count` vertices, from `first` on, in one workgroup's block of `entries`, which grows by it.
template <typename Entry>
void interleave_block(std::span<shared::MeshVertex> vertices, uint32_t stride, uint32_t shared::MeshVertex::*first,
                      uint32_t shared::MeshVertex::*count, std::span<const Entry> source, std::vector<Entry>& entries)
{
    uint32_t longest = 0;
    for (const shared::MeshVertex& vertex : vertices)
        longest = std::max(longest, vertex.*count);
    const auto begin = static_cast<uint32_t>(entries.size());
    entries.resize(entries.size() + size_t{longest} * stride);
    for (uint32_t lane = 0; lane < vertices.size(); ++lane)
    {
        shared::MeshVertex& vertex = vertices[lane];
        for (uint32_t entry = 0; entry < vertex.*count; ++entry)
            entries[begin + lane + size_t{entry} * stride] = source[vertex.*first + entry];
        vertex.*first = begin + lane;
    }
}

} // namespace

Result<ClothId> Model::add(const MeshCloth& description)
{
    if (auto valid = validate_shape(description); !valid)
        return valid.error();
    const ClothInput input{description.name,     description.transform, description.velocity,
                           description.material, description.held,      description.inverse_masses};
    const size_t first = positions.size();
    const size_t count = description.positions.size();
    if (auto valid = validate(input, count); !valid)
        return valid.error();
    if (first + count > UINT32_MAX / 2)
        return invalid("cloth", description.name, "more than 2 147 483 647 vertices in one solver");
    const std::vector<glm::dvec3> world = places(description);
    if (auto range = check_places(description.name, world); !range)
        return range.error();

    ClothModel cloth;
    cloth.name = description.name;
    cloth.material = description.material;
    cloth.integrator = description.integrator;
    cloth.mesh = make_mesh_topology(world, description.triangles, bends_isometrically(description.material),
                                    std::holds_alternative<Material>(description.material));
    if (cloth.mesh->springs.empty())
        return invalid("cloth", description.name,
                       "none of its " + std::to_string(description.triangles.size()) + " triangles has an area");
    cloth.triangles.assign(description.triangles.begin(), description.triangles.end());
    cloth.texture_coordinates.assign(description.texture_coordinates.begin(), description.texture_coordinates.end());
    if (cloth.texture_coordinates.empty())
        cloth.texture_coordinates = projected(world);

    shared::ClothRecord record{};
    record.layers = description.layers;
    record.first_vertex = static_cast<uint32_t>(first);
    record.vertices = static_cast<uint32_t>(count);
    record.first_list = static_cast<uint32_t>(mesh_vertices.size());
    apply_material(cloth, record);
    for (shared::MeshVertex vertex : cloth.mesh->vertices)
    {
        vertex.first_spring += static_cast<uint32_t>(mesh_springs.size());
        vertex.first_corner += static_cast<uint32_t>(mesh_corners.size());
        mesh_vertices.push_back(vertex);
    }
    mesh_springs.insert(mesh_springs.end(), cloth.mesh->springs.begin(), cloth.mesh->springs.end());
    mesh_corners.insert(mesh_corners.end(), cloth.mesh->corners.begin(), cloth.mesh->corners.end());
    const auto index = static_cast<uint32_t>(cloths.size());
    cloths.push_back(std::move(cloth));
    records.push_back(record);
    append_state(*this, input, world, index);
    return ClothId{index};
}

MeshLists interleave(const Model& model, uint32_t workgroup_size)
{
    MeshLists lists;
    lists.vertices = model.mesh_vertices;
    for (const shared::ClothRecord& record : model.records)
    {
        if (record.columns > 0)
            continue;
        const auto vertices = std::span(lists.vertices).subspan(record.first_list, record.vertices);
        for (size_t first = 0; first < vertices.size(); first += workgroup_size)
        {
            const auto block = vertices.subspan(first, std::min<size_t>(workgroup_size, vertices.size() - first));
            interleave_block<shared::MeshSpring>(block, workgroup_size, &shared::MeshVertex::first_spring,
                                                 &shared::MeshVertex::springs, model.mesh_springs, lists.springs);
            interleave_block<shared::MeshCorner>(block, workgroup_size, &shared::MeshVertex::first_corner,
                                                 &shared::MeshVertex::corners, model.mesh_corners, lists.corners);
        }
    }
    return lists;
}

} // namespace cloth
