// Closed meshes that are hard to leave: a sharp spire, and meshes of several parts.
#pragma once

#include "voile/engine/assets/mesh.hpp"

#include <cstdint>

namespace tests
{

// A spire on a triangle: angles of 4 degrees at its top, edges of very different lengths.
inline voile::engine::Mesh spire()
{
    voile::engine::Mesh mesh;
    mesh.positions = {{-0.05f, -0.2f, -0.04f}, {0.06f, -0.2f, -0.03f}, {0, -0.2f, 0.07f}, {0.01f, 1.2f, 0.005f}};
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    return mesh;
}

// Both meshes, as separate parts.
inline voile::engine::Mesh joined(voile::engine::Mesh mesh, const voile::engine::Mesh& other)
{
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const glm::uvec3& t : other.triangles)
        mesh.triangles.push_back(t + first);
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    return mesh;
}

} // namespace tests
