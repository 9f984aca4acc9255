// Meshes as cloth: validation, positions and topology.
#include "model/model.hpp"

#include "geometry/parallel.hpp"
#include "geometry/same_shape.hpp"
#include "model/cooked_cloth.hpp"

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

std::vector<glm::dvec3> world_positions(std::span<const glm::vec3> positions, const glm::mat4& transform)
{
    const glm::dmat4 exact = without_rounding(transform);
    std::vector<glm::dvec3> result;
    result.reserve(positions.size());
    for (const glm::vec3& p : positions)
        result.emplace_back(exact * glm::dvec4(p, 1));
    return result;
}

// Shorter triangles need more substeps than a step may have, and their weights leave the range of floats.
Result<void> check_triangle_sizes(const std::string& name, std::span<const glm::dvec3> world,
                                  std::span<const glm::uvec3> triangles)
{
    for (size_t i = 0; i < triangles.size(); ++i)
    {
        const auto side = static_cast<float>(longest_side(world, triangles[i]));
        const bool within_range = side >= k_least_cloth_size && side <= k_most_cloth_size;
        if (within_range || solid_area(world, triangles[i], 0) == 0)
            continue;
        const std::string what = "the longest side of triangle " + std::to_string(i);
        return check(subject("cloth", name), {what.c_str(), side, k_least_cloth_size, k_most_cloth_size, " m"});
    }
    return {};
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
        const glm::dvec3 offset = scale * (glm::dvec3(p) - low);
        result.coordinates.emplace_back(offset[along == 0 ? 1 : 0], offset[along == 2 ? 1 : 2]);
    }
    return result;
}

Result<std::shared_ptr<const MeshTopology>> make_topology(const MeshCloth& cloth, std::span<const glm::dvec3> world)
{
    const Projection projection = project(cloth);
    auto mesh = std::make_shared<const MeshTopology>(
        make_mesh_topology(world, cloth.triangles, {cloth.texture_coordinates, projection.coordinates, projection.view},
                           bends_isometrically(cloth.material), std::holds_alternative<Material>(cloth.material)));
    if (mesh->lists.springs.empty())
        return invalid("cloth", cloth.name,
                       "none of its " + std::to_string(cloth.triangles.size()) + " triangles has an area");
    return std::shared_ptr<const MeshTopology>(std::move(mesh));
}

Result<void> validate_cooked(const MeshCloth& cloth)
{
    const auto bad = [&](const std::string& reason) { return invalid("cloth", cloth.name, reason); };
    const CookedCloth::State& cooked = *cloth.cooked.state();
    if (!cloth.positions.empty() || !cloth.triangles.empty() || !cloth.texture_coordinates.empty())
        return bad("it is cooked, so its positions, triangles and texture coordinates must be empty");
    if (cooked.mesh->uniform_masses != std::holds_alternative<Material>(cloth.material))
        return bad(cooked.mesh->uniform_masses ? "it was cooked with a Material and cannot have a Fabric"
                                               : "it was cooked with a Fabric and cannot have a Material");
    if (bends_isometrically(cloth.material) && !cooked.mesh->isometric)
        return bad("isometric bending of a mesh must be there when it is cooked");
    if (auto affine = check_affine(subject("cloth", cloth.name), cloth.transform); !affine)
        return affine;
    if (!same_shape(cooked.transform, cloth.transform))
        return bad("its transform changes the shape that it was cooked in: it may turn and move it");
    return {};
}

ClothInput input_of(const MeshCloth& cloth)
{
    return {cloth.name,       cloth.transform, cloth.velocity,       cloth.material,
            cloth.integrator, cloth.pins,      cloth.inverse_masses, cloth.sleep_speed};
}

// The mesh with its topology, cooked or made now.
struct Shape
{
    std::vector<glm::dvec3> world;
    std::shared_ptr<const MeshTopology> mesh;
};

Result<Shape> make_shape(const MeshCloth& cloth)
{
    const CookedCloth::State* cooked = cloth.cooked.state().get();
    if (auto valid = cooked ? validate_cooked(cloth) : validate_shape(cloth); !valid)
        return valid.error();
    const std::span<const glm::vec3> positions = cooked ? std::span(cooked->positions) : cloth.positions;
    if (auto valid = validate(input_of(cloth), positions.size()); !valid)
        return valid.error();
    Shape shape{world_positions(positions, cloth.transform), cooked ? cooked->mesh : nullptr};
    if (auto range = check_world_positions(cloth.name, shape.world); !range)
        return range.error();
    if (cooked)
        return shape;
    if (auto sizes = check_triangle_sizes(cloth.name, shape.world, cloth.triangles); !sizes)
        return sizes.error();
    auto mesh = make_topology(cloth, shape.world);
    if (!mesh)
        return mesh.error();
    shape.mesh = std::move(mesh.value());
    return shape;
}

} // namespace

Result<CookedCloth> cook(const MeshCloth& cloth, const Jobs& jobs)
{
    const JobScope scope(jobs);
    auto shape = make_shape(cloth);
    if (!shape)
        return shape.error();
    if (cloth.cooked)
        return cloth.cooked;
    return CookedCloth(std::make_shared<const CookedCloth::State>(CookedCloth::State{
        cloth.transform, std::vector(cloth.positions.begin(), cloth.positions.end()), std::move(shape.value().mesh)}));
}

Result<ClothId> Model::add(const MeshCloth& description)
{
    auto shape = make_shape(description);
    if (!shape)
        return shape.error();
    ClothModel cloth;
    cloth.name = description.name;
    cloth.material = description.material;
    cloth.integrator = description.integrator;
    cloth.mesh = std::move(shape.value().mesh);
    cloth.lists = uploaded_lists(cloth.mesh);
    cloth.record.layers = description.layers;
    cloth.self_collision = description.self_collision;
    if (cloth.self_collision)
        cloth.fans = uploaded_fans(cloth.mesh);
    return append(std::move(cloth), input_of(description), shape.value().world);
}

namespace
{

// What `make` makes of a mesh, if nothing of it exists yet.
template <typename T, typename Make>
std::shared_ptr<const T> kept_or_made(std::unordered_map<const MeshTopology*, std::weak_ptr<const T>>& kept,
                                      const std::shared_ptr<const MeshTopology>& mesh, const Make& make)
{
    // Who holds what is made of a mesh holds the mesh, so that no other mesh has its address while it exists.
    if (auto made = kept[mesh.get()].lock())
        return made;
    std::erase_if(kept, [&](const auto& entry) { return entry.first != mesh.get() && entry.second.expired(); });
    const std::shared_ptr<const T> made = make();
    kept[mesh.get()] = made;
    return made;
}

} // namespace

std::shared_ptr<const MeshLists> Model::uploaded_lists(const std::shared_ptr<const MeshTopology>& mesh)
{
    return kept_or_made(lists_of_, mesh,
                        [&]
                        {
                            if (!interleaved)
                                return std::shared_ptr<const MeshLists>(mesh, &mesh->lists);
                            return std::make_shared<const MeshLists>(interleave(mesh->lists, limits.workgroup_size));
                        });
}

std::shared_ptr<const MeshFans> Model::uploaded_fans(const std::shared_ptr<const MeshTopology>& mesh)
{
    return kept_or_made(fans_of_, mesh, [&] { return std::make_shared<const MeshFans>(make_mesh_fans(mesh->lists)); });
}

} // namespace voile
