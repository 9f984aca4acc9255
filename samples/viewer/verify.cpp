// Penetration by exact distances, self-intersection by exact pairs.
#include "samples/viewer/verify.hpp"

#include "voile/mesh_checks.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

namespace viewer
{
namespace
{

// How deep a point that started at `start` lies under a solid, m; 0 or less if it does not. Both as seen from the solid
// where it was at time 0.
using Depth = std::function<double(const glm::dvec3& point, const glm::dvec3& start)>;
using Distance = std::shared_ptr<const voile::MeshDistance>;

double segment_distance(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& p)
{
    const glm::dvec3 along = b - a;
    const double length2 = glm::dot(along, along);
    const double t = length2 > 0 ? glm::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0;
    return glm::distance(p, a + t * along);
}

// To the nearest face, from inside.
double box_depth(const BoxShape& box, const glm::dvec3& p)
{
    const glm::dvec3 inside = glm::min(p - glm::dvec3(box.min), glm::dvec3(box.max) - p);
    return std::min({inside.x, inside.y, inside.z});
}

// Of a shape with a formula, in its own space.
double formula_depth(const Solid& solid, const glm::dvec3& p)
{
    if (const auto* plane = std::get_if<PlaneShape>(&solid.shape))
        return static_cast<double>(plane->y) - p.y;
    if (const auto* sphere = std::get_if<SphereShape>(&solid.shape))
        return static_cast<double>(sphere->radius) - glm::distance(p, glm::dvec3(sphere->center));
    if (const auto* capsule = std::get_if<CapsuleShape>(&solid.shape))
        return static_cast<double>(capsule->radius) -
               segment_distance(glm::dvec3(capsule->from), glm::dvec3(capsule->to), p);
    return box_depth(std::get<BoxShape>(solid.shape), p);
}

// Inside a mesh; with two sides, where a vertex did not start, as the mesh was `at_start`.
Depth winding_depth(const Distance& distance, const Distance& at_start, bool two_sided)
{
    return [=](const glm::dvec3& p, const glm::dvec3& start)
    {
        const bool free = two_sided && at_start->winding_number(start) > 0.5;
        const bool inside = distance->winding_number(p) > 0.5;
        return inside != free ? std::abs(distance->nearest(p).signed_distance) : 0;
    };
}

// An open mesh whose triangles face one way: the side where they face is free, or the one where a vertex started as the
// mesh was `at_start`, which may be null.
Depth side_depth(const Distance& distance, const Distance& at_start)
{
    return [distance, at_start](const glm::dvec3& p, const glm::dvec3& start)
    {
        const auto now = distance->nearest(p);
        const double side = at_start && at_start->nearest(start).signed_distance < 0 ? -1 : 1;
        return now.on_boundary ? 0 : -side * now.signed_distance;
    };
}

voile::Result<Distance> mesh_distance(const Solid& solid, const std::vector<glm::vec3>& positions)
{
    auto created = voile::MeshDistance::create({.name = solid.name,
                                                .positions = positions,
                                                .triangles = std::get<voile::engine::Mesh>(solid.shape).triangles,
                                                .transform = solid.transform});
    if (!created)
        return created.error();
    return std::make_shared<const voile::MeshDistance>(std::move(created.value()));
}

// `deformed`: where its vertices have come to; null if they stay.
voile::Result<Depth> mesh_depth(const Solid& solid, const std::vector<glm::vec3>* deformed)
{
    const auto first = mesh_distance(solid, std::get<voile::engine::Mesh>(solid.shape).positions);
    if (!first)
        return first.error();
    const auto now = deformed != nullptr ? mesh_distance(solid, *deformed) : first;
    if (!now)
        return now.error();
    const Distance& start = first.value();
    const Distance& distance = now.value();
    if (!distance->closed() && distance->has_sides() && start->has_sides())
        return side_depth(distance, solid.sides == MeshSides::one ? nullptr : start);
    if (!distance->closed() && solid.sides != MeshSides::one) // a bowl may hold cloth
        return Depth([](const glm::dvec3&, const glm::dvec3&) { return 0.0; });
    return winding_depth(distance, start, solid.sides == MeshSides::two);
}

voile::Result<Depth> depth_of(const Solid& solid, const std::vector<glm::vec3>* deformed)
{
    if (std::holds_alternative<voile::engine::Mesh>(solid.shape))
        return mesh_depth(solid, deformed);
    return Depth([&solid, back = glm::inverse(glm::dmat4(solid.transform))](const glm::dvec3& p, const glm::dvec3&)
                 { return formula_depth(solid, glm::dvec3(back * glm::dvec4(p, 1))); });
}

// A solid where it has come to.
struct Obstacle
{
    Depth depth;
    glm::dmat4 back{1.0}; // to where it was at time 0
    uint32_t layers = 1;
};

voile::Result<std::vector<Obstacle>> obstacles_of(const Stage& stage, const std::vector<Solid>& solids)
{
    std::vector<Obstacle> obstacles;
    for (size_t i = 0; i < solids.size(); ++i)
    {
        auto depth = depth_of(solids[i], stage.motions->positions(i));
        if (!depth)
            return depth.error();
        obstacles.push_back(
            {std::move(depth.value()), glm::inverse(glm::dmat4(stage.motions->pose(i))), solids[i].layers});
    }
    return obstacles;
}

double deepest_of(const std::vector<Obstacle>& obstacles, const StageCloth& cloth, size_t vertex, const glm::dvec3& p)
{
    double deepest = 0;
    for (const Obstacle& obstacle : obstacles)
        if ((obstacle.layers & cloth.layers) != 0)
            deepest = std::max(
                deepest, obstacle.depth(glm::dvec3(obstacle.back * glm::dvec4(p, 1)), glm::dvec3(cloth.start[vertex])));
    return deepest;
}

} // namespace

voile::Result<Verification> verify(const Stage& stage, const std::vector<Solid>& solids,
                                   const std::vector<FinalCloth>& state)
{
    const auto obstacles = obstacles_of(stage, solids);
    if (!obstacles)
        return obstacles.error();
    Verification result;
    for (size_t i = 0; i < state.size(); ++i)
    {
        for (size_t v = 0; v < state[i].positions.size(); ++v)
        {
            const double depth = deepest_of(obstacles.value(), stage.cloths[i], v, glm::dvec3(state[i].positions[v]));
            result.penetrating_vertices += depth > 0 ? 1 : 0;
            result.deepest_penetration = std::max(result.deepest_penetration, depth);
        }
        result.self_intersections += voile::count_self_intersections(state[i].positions, state[i].triangles);
    }
    return result;
}

} // namespace viewer
