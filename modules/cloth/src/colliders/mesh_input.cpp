// Meshes as they are given: validation, placement, welding, orientation.
#include "colliders/mesh_input.hpp"

#include "colliders/collider_model.hpp"
#include "geometry/closedness.hpp"
#include "geometry/mesh_parts.hpp"
#include "geometry/rounding.hpp"

#include <algorithm>

namespace voile
{

namespace
{

Result<void> validate(const MeshCollider& collider)
{
    const auto bad = [&](const std::string& reason) { return invalid("collider", collider.name, reason); };
    if (collider.triangles.empty())
        return bad("the mesh has no triangles");
    if (auto affine = check_affine(subject("collider", collider.name), collider.transform); !affine)
        return affine;
    if (auto valid = validate_triangles("collider", collider.name, collider.positions, collider.triangles); !valid)
        return valid.error();
    return check_friction(collider.name, collider.friction);
}

std::vector<glm::dvec3> to_world(const MeshCollider& collider)
{
    const glm::dmat4 transform(collider.transform);
    std::vector<glm::dvec3> world;
    world.reserve(collider.positions.size());
    for (const glm::vec3& p : collider.positions)
        world.emplace_back(transform * glm::dvec4(p, 1));
    return world;
}

glm::dvec3 middle_of(std::span<const glm::dvec3> positions)
{
    glm::dvec3 min = positions.front();
    glm::dvec3 max = positions.front();
    for (const glm::dvec3& p : positions)
    {
        min = glm::min(min, p);
        max = glm::max(max, p);
    }
    return 0.5 * (min + max);
}

// A triangle whose normal vanishes in float has no side to push to.
bool has_area(const std::vector<glm::dvec3>& positions, const glm::uvec3& t)
{
    const glm::vec3 a(positions[t.y] - positions[t.x]);
    const glm::vec3 b(positions[t.z] - positions[t.x]);
    const glm::vec3 n = glm::cross(a, b);
    return glm::dot(n, n) > 1e-30f;
}

// Only of corners of triangles: other vertices may be anywhere.
glm::dvec3 middle_of(const std::vector<glm::dvec3>& positions, std::span<const glm::uvec3> triangles)
{
    glm::dvec3 min = positions[triangles.front().x];
    glm::dvec3 max = min;
    for (const glm::uvec3& t : triangles)
        for (int corner = 0; corner < 3; ++corner)
        {
            min = glm::min(min, positions[t[corner]]);
            max = glm::max(max, positions[t[corner]]);
        }
    return 0.5 * (min + max);
}

} // namespace

Result<MeshInput> prepare_mesh(const MeshCollider& collider)
{
    if (auto valid = validate(collider); !valid)
        return valid.error();
    MeshInput mesh;
    const std::vector<glm::dvec3> world = to_world(collider);
    mesh.positions.assign(world.begin(), world.end());
    if (auto range = check_positions(subject("collider", collider.name), mesh.positions,
                                     "its transform takes position ", " to ");
        !range)
        return range.error();
    mesh.origin = rounded(middle_of(world));
    std::transform(world.begin(), world.end(), mesh.positions.begin(),
                   [&](const glm::dvec3& p) { return glm::vec3(p - glm::dvec3(mesh.origin)); });
    mesh.triangles.reserve(collider.triangles.size());
    std::copy_if(collider.triangles.begin(), collider.triangles.end(), std::back_inserter(mesh.triangles),
                 [&](const glm::uvec3& t) { return has_area(world, t); });
    if (mesh.triangles.empty())
        return invalid("collider", collider.name,
                       "none of its " + std::to_string(collider.triangles.size()) + " triangles has an area");
    mesh.origin = rounded(middle_of(world, mesh.triangles));
    std::transform(world.begin(), world.end(), mesh.positions.begin(),
                   [&](const glm::dvec3& p) { return glm::vec3(p - glm::dvec3(mesh.origin)); });

    const std::vector<uint32_t> welded = weld(mesh.positions);
    mesh.closed = is_closed(welded, mesh.triangles);
    if (mesh.closed)
        face_outwards(mesh.positions, welded, mesh.triangles);
    return mesh;
}

} // namespace voile
