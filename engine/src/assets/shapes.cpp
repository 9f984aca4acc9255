// Simple procedural meshes.
#include "voile/engine/assets/shapes.hpp"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace voile::engine
{

namespace
{

// Adds the circle at fraction `v` from pole to pole of a sphere.
void add_ring(Mesh& mesh, const glm::vec3& center, float radius, float v, uint32_t segments)
{
    for (uint32_t segment = 0; segment <= segments; ++segment)
    {
        const float u = static_cast<float>(segment) / static_cast<float>(segments);
        // The seam's two columns coincide exactly, and so do the vertices of a pole: the sphere is closed.
        const bool pole = v == 0 || v == 1;
        const float polar = v * glm::pi<float>();
        const float azimuth =
            static_cast<float>(segment % segments) / static_cast<float>(segments) * glm::two_pi<float>();
        const float across = pole ? 0.f : std::sin(polar);
        const glm::vec3 n{across * std::cos(azimuth), std::cos(polar), -across * std::sin(azimuth)};
        mesh.positions.push_back(center + radius * n);
        mesh.normals.push_back(n);
        mesh.texture_coordinates.emplace_back(u, v);
    }
}

enum class Ends
{
    poles,    // both
    pole_rim, // a pole at the first ring only
    rims
};

// A band at a pole has one triangle per segment, the others two.
void join_rings(Mesh& mesh, uint32_t bands, uint32_t segments, Ends ends = Ends::poles)
{
    const uint32_t stride = segments + 1;
    for (uint32_t band = 0; band < bands; ++band)
        for (uint32_t segment = 0; segment < segments; ++segment)
        {
            const uint32_t corner = band * stride + segment;
            if (band + 1 < bands || ends != Ends::poles)
                mesh.triangles.emplace_back(corner, corner + stride, corner + stride + 1);
            if (band > 0 || ends == Ends::rims)
                mesh.triangles.emplace_back(corner, corner + stride + 1, corner + 1);
        }
}

} // namespace

glm::mat3 turn_to(const glm::vec3& axis)
{
    const glm::vec3 aside = std::abs(axis.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
    const glm::vec3 x = glm::normalize(aside - glm::dot(aside, axis) * axis);
    return {x, axis, glm::cross(x, axis)};
}

Mesh make_sphere(const glm::vec3& center, float radius, uint32_t rings)
{
    Mesh mesh;
    for (uint32_t ring = 0; ring <= rings; ++ring)
        add_ring(mesh, center, radius, static_cast<float>(ring) / static_cast<float>(rings), 2 * rings);
    join_rings(mesh, rings, 2 * rings);
    return mesh;
}

Mesh make_capsule(const glm::vec3& from, const glm::vec3& to, float radius, uint32_t rings)
{
    Mesh mesh;
    const float length = glm::distance(from, to);
    const glm::vec3 half(0, 0.5f * length, 0);
    const uint32_t cap = std::max(rings / 2, 1u); // bands on each end
    for (uint32_t ring = 0; ring <= 2 * cap + 1; ++ring)
    {
        const bool lower = ring > cap;
        const float v = static_cast<float>(lower ? ring - 1 : ring) / static_cast<float>(2 * cap);
        add_ring(mesh, lower ? -half : half, radius, v, 4 * cap);
    }
    join_rings(mesh, 2 * cap + 1, 4 * cap);
    const glm::mat3 turn = turn_to(length > 0 ? (to - from) / length : glm::vec3(0, 1, 0));
    for (glm::vec3& p : mesh.positions)
        p = 0.5f * (from + to) + turn * p;
    for (glm::vec3& n : mesh.normals)
        n = turn * n;
    return mesh;
}

Mesh make_dome(uint32_t rings)
{
    Mesh mesh;
    for (uint32_t ring = 0; ring <= rings; ++ring)
        add_ring(mesh, glm::vec3(0), 1, 0.5f * static_cast<float>(ring) / static_cast<float>(rings), 4 * rings);
    join_rings(mesh, rings, 4 * rings, Ends::pole_rim);
    return mesh;
}

Mesh make_tube(uint32_t segments)
{
    Mesh mesh;
    for (const float y : {1.f, 0.f})
    {
        const size_t first = mesh.positions.size();
        add_ring(mesh, glm::vec3(0), 1, 0.5f, segments);
        for (size_t i = first; i < mesh.positions.size(); ++i)
        {
            mesh.positions[i].y = y;
            mesh.normals[i].y = 0;
        }
    }
    join_rings(mesh, 1, segments, Ends::rims);
    return mesh;
}

Mesh make_box(const glm::vec3& min, const glm::vec3& max)
{
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool far : {false, true})
        {
            const int u = (axis + 1) % 3;
            const int v = (axis + 2) % 3;
            const auto first = static_cast<uint32_t>(mesh.positions.size());
            for (uint32_t corner = 0; corner < 4; ++corner)
            {
                glm::vec3 p = far ? max : min;
                p[u] = (corner & 1) != 0 ? max[u] : min[u];
                p[v] = (corner & 2) != 0 ? max[v] : min[v];
                glm::vec3 n(0);
                n[axis] = far ? 1.f : -1.f;
                mesh.positions.push_back(p);
                mesh.normals.push_back(n);
                mesh.texture_coordinates.emplace_back(p[u], p[v]);
            }
            const glm::uvec3 halves[2] = {{0, 1, 3}, {0, 3, 2}};
            for (const glm::uvec3& t : halves)
                mesh.triangles.push_back(first + (far ? t : glm::uvec3(t.x, t.z, t.y)));
        }
    return mesh;
}

Mesh make_ground(float half_size, float y)
{
    Mesh mesh;
    for (const float z : {-half_size, half_size})
        for (const float x : {-half_size, half_size})
        {
            mesh.positions.emplace_back(x, y, z);
            mesh.normals.emplace_back(0, 1, 0);
            mesh.texture_coordinates.emplace_back(x, z);
        }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}};
    return mesh;
}

} // namespace voile::engine
