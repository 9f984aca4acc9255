// Meshes as cloth: validation, their places and topology.
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

std::shared_ptr<const MeshTopology> make_topology(const MeshCloth& cloth, std::span<const glm::dvec3> world)
{
    const Projection projection = project(cloth);
    return std::make_shared<const MeshTopology>(
        make_mesh_topology(world, cloth.triangles, {cloth.texture_coordinates, projection.coordinates, projection.view},
                           bends_isometrically(cloth.material), std::holds_alternative<Material>(cloth.material)));
}

} // namespace

Result<ClothId> Model::add(const MeshCloth& description)
{
    if (auto valid = validate_shape(description); !valid)
        return valid.error();
    const ClothInput input{description.name,          description.transform,  description.velocity,
                           description.material,      description.integrator, description.pins,
                           description.inverse_masses};
    const size_t count = description.positions.size();
    if (auto valid = validate(input, count); !valid)
        return valid.error();
    const std::vector<glm::dvec3> world = places(description);
    if (auto range = check_places(description.name, world); !range)
        return range.error();

    ClothModel cloth;
    cloth.name = description.name;
    cloth.material = description.material;
    cloth.integrator = description.integrator;
    cloth.mesh = make_topology(description, world);
    if (cloth.mesh->lists.springs.empty())
        return invalid("cloth", description.name,
                       "none of its " + std::to_string(description.triangles.size()) + " triangles has an area");
    cloth.lists = uploaded_lists(cloth.mesh);
    cloth.record.layers = description.layers;
    return append(std::move(cloth), input, world);
}

std::shared_ptr<const MeshLists> Model::uploaded_lists(const std::shared_ptr<const MeshTopology>& mesh) const
{
    for (auto cloth = cloths.rbegin(); cloth != cloths.rend(); ++cloth) // instances are added one after the other
        if (cloth->mesh == mesh)
            return cloth->lists;
    if (interleaved)
        return std::make_shared<const MeshLists>(interleave(mesh->lists, limits.workgroup_size));
    return {mesh, &mesh->lists};
}

} // namespace voile
