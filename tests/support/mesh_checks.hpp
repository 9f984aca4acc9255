// Checks of meshes.
#pragma once

#include "voile/engine/assets/mesh.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

// Every directed edge belongs to one triangle, and its reverse to another.
inline bool is_closed(const voile::engine::Mesh& mesh)
{
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (const glm::uvec3& t : mesh.triangles)
        for (int i = 0; i < 3; ++i)
            ++edges[{t[i], t[(i + 1) % 3]}];
    return !edges.empty() && std::all_of(edges.begin(), edges.end(),
                                         [&](const auto& e) {
                                             return e.second == 1 && edges.contains({e.first.second, e.first.first});
                                         });
}

// Positive for a closed mesh that is wound outward.
inline double signed_volume(const voile::engine::Mesh& mesh)
{
    double volume = 0;
    for (const glm::uvec3& t : mesh.triangles)
        volume += glm::dot(glm::dvec3(mesh.positions[t.x]),
                           glm::cross(glm::dvec3(mesh.positions[t.y]), glm::dvec3(mesh.positions[t.z]))) /
                  6.;
    return volume;
}

// The sum of the triangles' areas.
inline double total_area(const voile::engine::Mesh& mesh)
{
    double area = 0;
    for (const glm::uvec3& t : mesh.triangles)
        area += glm::length(glm::cross(glm::dvec3(mesh.positions[t.y] - mesh.positions[t.x]),
                                       glm::dvec3(mesh.positions[t.z] - mesh.positions[t.x]))) /
                2.;
    return area;
}
