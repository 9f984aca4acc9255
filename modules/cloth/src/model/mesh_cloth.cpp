// Meshes as cloth: validation, their lists, and the layout of these on the GPU.
#include "model/model.hpp"

#include <algorithm>
#include <cmath>

namespace voile
{

namespace
{

constexpr float k_most_texture_coordinate = 1e6f;

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
    for (size_t i = 0; i < cloth.texture_coordinates.size(); ++i)
        if (const glm::vec2 uv = cloth.texture_coordinates[i];
            !(std::abs(uv.x) <= k_most_texture_coordinate && std::abs(uv.y) <= k_most_texture_coordinate))
            return bad("texture coordinate " + std::to_string(i) + " is " + std::to_string(uv.x) + " " +
                       std::to_string(uv.y) + ", must be within 1e6");
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
struct Projection
{
    std::vector<glm::vec2> coordinates; // m
    glm::dvec3 view{0};                 // unit length, world
};

// Along the mesh's own axes, so that the fabric turns with the mesh.
Projection project(const MeshCloth& cloth)
{
    const glm::dmat3 axes(cloth.transform);
    const glm::dvec3 scale(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
    glm::dvec3 low(std::numeric_limits<double>::max());
    glm::dvec3 high(std::numeric_limits<double>::lowest());
    for (const glm::vec3& p : cloth.positions)
    {
        low = glm::min(low, glm::dvec3(p));
        high = glm::max(high, glm::dvec3(p));
    }
    const glm::dvec3 extent = scale * (high - low);
    const int along = extent.x <= extent.y && extent.x <= extent.z ? 0 : extent.y <= extent.z ? 1 : 2;
    Projection result{{}, axes[along] / scale[along]};
    result.coordinates.reserve(cloth.positions.size());
    for (const glm::vec3& p : cloth.positions)
    {
        const glm::dvec3 place = scale * (glm::dvec3(p) - low);
        result.coordinates.emplace_back(place[along == 0 ? 1 : 0], place[along == 2 ? 1 : 2]);
    }
    return result;
}

// Appends the lists of `vertices` as one workgroup's block to `entries`.
template <typename Entry>
void interleave_block(std::span<const shared::MeshVertex> vertices, uint32_t stride,
                      uint32_t shared::MeshVertex::*first, uint32_t shared::MeshVertex::*count,
                      std::span<const Entry> source, std::vector<Entry>& entries)
{
    uint32_t longest = 0;
    for (const shared::MeshVertex& vertex : vertices)
        longest = std::max(longest, vertex.*count);
    const size_t begin = entries.size();
    entries.resize(begin + size_t{longest} * stride);
    for (size_t lane = 0; lane < vertices.size(); ++lane)
        for (uint32_t entry = 0; entry < vertices[lane].*count; ++entry)
            entries[begin + lane + size_t{entry} * stride] = source[vertices[lane].*first + entry];
}

} // namespace

Result<ClothId> Model::add(const MeshCloth& description)
{
    if (auto valid = validate_shape(description); !valid)
        return valid.error();
    const ClothInput input{description.name,          description.transform,  description.velocity,
                           description.material,      description.integrator, description.pins,
                           description.inverse_masses};
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
    Projection projection = project(description);
    cloth.mesh = make_mesh_topology(
        world, description.triangles, {description.texture_coordinates, projection.coordinates, projection.view},
        bends_isometrically(description.material), std::holds_alternative<Material>(description.material));
    if (cloth.mesh->springs.empty())
        return invalid("cloth", description.name,
                       "none of its " + std::to_string(description.triangles.size()) + " triangles has an area");
    cloth.triangles.assign(description.triangles.begin(), description.triangles.end());
    cloth.texture_coordinates.assign(description.texture_coordinates.begin(), description.texture_coordinates.end());
    if (cloth.texture_coordinates.empty())
        cloth.texture_coordinates = std::move(projection.coordinates);

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
    membrane_corners.insert(membrane_corners.end(), cloth.mesh->membrane_corners.begin(),
                            cloth.mesh->membrane_corners.end());
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
            const auto first_spring = static_cast<uint32_t>(lists.springs.size());
            const auto first_corner = static_cast<uint32_t>(lists.corners.size());
            interleave_block<shared::MeshSpring>(block, workgroup_size, &shared::MeshVertex::first_spring,
                                                 &shared::MeshVertex::springs, model.mesh_springs, lists.springs);
            interleave_block<shared::MeshCorner>(block, workgroup_size, &shared::MeshVertex::first_corner,
                                                 &shared::MeshVertex::corners, model.mesh_corners, lists.corners);
            interleave_block<shared::MembraneCorner>(block, workgroup_size, &shared::MeshVertex::first_corner,
                                                     &shared::MeshVertex::corners, model.membrane_corners,
                                                     lists.membrane);
            for (uint32_t lane = 0; lane < block.size(); ++lane)
            {
                block[lane].first_spring = first_spring + lane;
                block[lane].first_corner = first_corner + lane;
            }
        }
    }
    return lists;
}

} // namespace voile
