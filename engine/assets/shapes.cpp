// Simple meshes made by rule.
#include "engine/assets/shapes.hpp"

#include <glm/gtc/constants.hpp>

#include <cmath>

namespace engine
{

Mesh make_sphere(const glm::vec3& center, float radius, uint32_t rings)
{
    Mesh mesh;
    const uint32_t segments = 2 * rings;
    for (uint32_t ring = 0; ring <= rings; ++ring)
        for (uint32_t segment = 0; segment <= segments; ++segment)
        {
            const float v = static_cast<float>(ring) / static_cast<float>(rings);
            const float u = static_cast<float>(segment) / static_cast<float>(segments);
            // The seam's two columns and the poles' vertices lie exactly on each other: the sphere is closed.
            const bool pole = ring == 0 || ring == rings;
            const float polar = v * glm::pi<float>();
            const float azimuth =
                static_cast<float>(segment % segments) / static_cast<float>(segments) * glm::two_pi<float>();
            const float across = pole ? 0.f : std::sin(polar);
            const glm::vec3 n{across * std::cos(azimuth), std::cos(polar), -across * std::sin(azimuth)};
            mesh.positions.push_back(center + radius * n);
            mesh.normals.push_back(n);
            mesh.texture_coordinates.emplace_back(u, v);
        }
    const uint32_t stride = segments + 1;
    for (uint32_t ring = 0; ring < rings; ++ring)
        for (uint32_t segment = 0; segment < segments; ++segment)
        {
            const uint32_t corner = ring * stride + segment;
            // The bands at the poles have one triangle a segment, the others two.
            if (ring + 1 < rings)
                mesh.triangles.emplace_back(corner, corner + stride, corner + stride + 1);
            if (ring > 0)
                mesh.triangles.emplace_back(corner, corner + stride + 1, corner + 1);
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

} // namespace engine
