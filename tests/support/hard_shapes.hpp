// Shapes that are hard to collide with: thin, pointed, open, lumpy. y is up, units are meters, winding is outward or
// upward.
#pragma once

#include "voile/engine/assets/shapes.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace tests
{

// Two triangles side by side, facing up, 1 m along x and `width` along z, about the origin.
inline voile::engine::Mesh triangle_pair(float width)
{
    voile::engine::Mesh mesh = voile::engine::make_ground(0.5f);
    for (glm::vec3& p : mesh.positions)
        p.z *= width;
    return mesh;
}

// A tetrahedron on a base `thin` high and wide, its tip `length` above it.
inline voile::engine::Mesh needle(float length, float thin)
{
    voile::engine::Mesh mesh;
    const float third = thin / 3;
    mesh.positions = {{-1.5f * third, 0, -third}, {1.5f * third, 0, -third}, {0, 0, 2 * third}, {0, length, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
    return mesh;
}

// A closed cylinder, or prism, about the z axis from `first` to `last`: two triangles per flat, over its whole length,
// and fans at both ends.
inline voile::engine::Mesh closed_cylinder(double radius, double first, double last, uint32_t sides)
{
    voile::engine::Mesh mesh;
    for (uint32_t i = 0; i < sides; ++i)
    {
        const double angle = 2 * std::numbers::pi * i / sides;
        for (const double z : {first, last})
            mesh.positions.emplace_back(glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), z));
    }
    mesh.positions.emplace_back(glm::dvec3(0, 0, first));
    mesh.positions.emplace_back(glm::dvec3(0, 0, last));
    for (uint32_t i = 0; i < sides; ++i)
    {
        const uint32_t next = (i + 1) % sides;
        mesh.triangles.emplace_back(2 * i, 2 * next, 2 * i + 1);
        mesh.triangles.emplace_back(2 * next, 2 * next + 1, 2 * i + 1);
        mesh.triangles.emplace_back(2 * next, 2 * i, 2 * sides);
        mesh.triangles.emplace_back(2 * i + 1, 2 * next + 1, 2 * sides + 1);
    }
    return mesh;
}

// Half a sphere, open at the top, its lowest point at y = 0. It faces inward.
inline voile::engine::Mesh round_bowl(float radius)
{
    constexpr uint32_t k_rings = 16;
    constexpr uint32_t k_segments = 48;
    voile::engine::Mesh mesh;
    mesh.positions.emplace_back(0, 0, 0);
    for (uint32_t ring = 1; ring <= k_rings; ++ring)
        for (uint32_t segment = 0; segment < k_segments; ++segment)
        {
            const float polar = 0.5f * std::numbers::pi_v<float> * static_cast<float>(ring) / k_rings;
            const float around = 2 * std::numbers::pi_v<float> * static_cast<float>(segment) / k_segments;
            mesh.positions.emplace_back(radius * std::sin(polar) * std::cos(around), radius * (1 - std::cos(polar)),
                                        radius * std::sin(polar) * std::sin(around));
        }
    const auto at = [](uint32_t ring, uint32_t segment)
    { return ring == 0 ? 0 : 1 + (ring - 1) * k_segments + segment % k_segments; };
    for (uint32_t ring = 0; ring < k_rings; ++ring)
        for (uint32_t segment = 0; segment < k_segments; ++segment)
        {
            mesh.triangles.emplace_back(at(ring, segment), at(ring + 1, segment + 1), at(ring + 1, segment));
            if (ring > 0)
                mesh.triangles.emplace_back(at(ring, segment), at(ring, segment + 1), at(ring + 1, segment + 1));
        }
    return mesh;
}

// Three squares that share a corner, the lowest point, at the origin: a cube on its corner, open at the top. It faces
// inward.
inline voile::engine::Mesh corner_bowl(float side)
{
    const float radius = side * std::sqrt(2.f / 3);
    const float rise = side / std::sqrt(3.f);
    voile::engine::Mesh mesh;
    mesh.positions.emplace_back(0, 0, 0);
    for (int corner = 0; corner < 6; ++corner) // alternating one and two rises
    {
        const float around = std::numbers::pi_v<float> / 3 * static_cast<float>(corner) + 0.2f;
        mesh.positions.emplace_back(radius * std::cos(around), corner % 2 == 0 ? rise : 2 * rise,
                                    radius * std::sin(around));
    }
    for (uint32_t face = 0; face < 3; ++face)
    {
        const uint32_t first = 1 + 2 * face;
        const uint32_t last = 1 + (2 * face + 2) % 6;
        mesh.triangles.emplace_back(0, first + 1, first);
        mesh.triangles.emplace_back(0, last, first + 1);
    }
    return mesh;
}

// A closed lump with two ears, star-shaped about the origin, about 0.3 m in radius: 4 * `rings`^2 triangles.
inline voile::engine::Mesh lump_with_ears(uint32_t rings)
{
    const glm::vec3 ears[] = {glm::normalize(glm::vec3(0.5f, 1, 0.1f)), glm::normalize(glm::vec3(-0.45f, 1, 0.2f))};
    voile::engine::Mesh mesh = voile::engine::make_sphere({0, 0, 0}, 1, rings);
    for (glm::vec3& p : mesh.positions)
    {
        const glm::vec3 n = p;
        float radius = 0.3f + 0.02f * std::sin(9 * n.x + 2) * std::sin(7 * n.y) * std::cos(8 * n.z + 1) +
                       0.006f * std::sin(23 * n.x + 1) * std::sin(19 * n.z);
        for (const glm::vec3& ear : ears)
            radius += 0.3f * std::exp(-glm::dot(n - ear, n - ear) / (0.12f * 0.12f));
        p = radius * n;
    }
    return mesh;
}

inline void transform_mesh(voile::engine::Mesh& mesh, const glm::mat4& transform)
{
    for (glm::vec3& p : mesh.positions)
        p = glm::vec3(transform * glm::vec4(p, 1));
}

} // namespace tests
