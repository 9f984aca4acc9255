// Penetration by exact distances, self-intersection by exact pairs.
#include "samples/viewer/verify.hpp"

#include "cloth/mesh_checks.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace viewer
{
namespace
{

// How deep a point that started at `start` lies under a solid, m; 0 or less if it does not.
using Depth = std::function<double(const glm::dvec3& point, const glm::dvec3& start)>;

gpu::Result<Depth> depth_of(const Solid& solid)
{
    if (const auto* plane = std::get_if<PlaneShape>(&solid.shape))
        return Depth([y = static_cast<double>(plane->y)](const glm::dvec3& p, const glm::dvec3&) { return y - p.y; });
    if (const auto* sphere = std::get_if<SphereShape>(&solid.shape))
        return Depth([s = *sphere](const glm::dvec3& p, const glm::dvec3&)
                     { return static_cast<double>(s.radius) - glm::distance(p, glm::dvec3(s.center)); });
    const auto& mesh = std::get<engine::Mesh>(solid.shape);
    auto created = cloth::MeshDistance::create(
        {.name = solid.name, .positions = mesh.positions, .triangles = mesh.triangles, .transform = solid.transform});
    if (!created)
        return created.error();
    const auto distance = std::make_shared<cloth::MeshDistance>(std::move(created.value()));
    if (distance->closed())
        return Depth([distance](const glm::dvec3& p, const glm::dvec3&)
                     { return -distance->nearest(p).signed_distance; });
    if (!distance->has_sides())
        return Depth(
            [distance](const glm::dvec3& p, const glm::dvec3&)
            {
                const bool inside = std::abs(distance->winding_number(p)) > 0.5;
                return inside ? std::abs(distance->nearest(p).signed_distance) : 0;
            });
    return Depth(
        [distance](const glm::dvec3& p, const glm::dvec3& start)
        {
            const auto now = distance->nearest(p);
            const double side = distance->nearest(start).signed_distance < 0 ? -1 : 1;
            return now.on_boundary ? 0 : -side * now.signed_distance;
        });
}

} // namespace

gpu::Result<Verification> verify(const Stage& stage, const std::vector<Solid>& solids,
                                 const std::vector<FinalCloth>& state)
{
    std::vector<Depth> depths;
    for (const Solid& solid : solids)
    {
        auto depth = depth_of(solid);
        if (!depth)
            return depth.error();
        depths.push_back(std::move(depth.value()));
    }
    Verification result;
    for (size_t i = 0; i < state.size(); ++i)
    {
        for (size_t v = 0; v < state[i].positions.size(); ++v)
        {
            const glm::dvec3 start(stage.cloths[i].start[v]);
            double deepest = 0;
            for (const Depth& depth : depths)
                deepest = std::max(deepest, depth(state[i].positions[v], start));
            if (deepest > 0)
                ++result.penetrating_vertices;
            result.deepest_penetration = std::max(result.deepest_penetration, deepest);
        }
        result.self_intersections += cloth::count_self_intersections(state[i].positions, state[i].triangles);
    }
    return result;
}

} // namespace viewer
