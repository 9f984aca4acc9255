// The clothes of the walking figure.
#include "figure.hpp"

#include <cmath>
#include <numbers>

namespace scenes
{

namespace
{

// A part of an elliptic cone from a ring to a hem, around the y axis.
struct Cone
{
    glm::vec2 ring; // m, half widths along x and z
    glm::vec2 hem;
    float ring_height; // m
    float hem_height;
    float ring_z; // of its middle
    float hem_z;
    float half_angle; // from the middle, +z or, if `back`, -z; pi: all around
    bool back;
    uint32_t columns; // vertices
    uint32_t rows;
};

voile::engine::Mesh make_cone(const Cone& cone)
{
    voile::engine::Mesh mesh;
    const bool closed = cone.half_angle > 3.14f;
    const uint32_t quads = closed ? cone.columns : cone.columns - 1;
    for (uint32_t row = 0; row < cone.rows; ++row)
        for (uint32_t column = 0; column < cone.columns; ++column)
        {
            const float down = static_cast<float>(row) / static_cast<float>(cone.rows - 1);
            const float angle = cone.half_angle * (2 * static_cast<float>(column) / static_cast<float>(quads) - 1);
            const glm::vec2 half = glm::mix(cone.ring, cone.hem, down);
            const float side = cone.back ? -1.f : 1.f;
            mesh.positions.emplace_back(side * half.x * std::sin(angle),
                                        glm::mix(cone.ring_height, cone.hem_height, down),
                                        glm::mix(cone.ring_z, cone.hem_z, down) + side * half.y * std::cos(angle));
            // Mirrored at the front, so that the fabric of a closed cone has no seam.
            const float along = 0.5f * (half.x + half.y) * (closed ? std::abs(angle) : angle);
            const float slant = std::hypot(cone.ring_height - cone.hem_height, cone.hem.x - cone.ring.x);
            mesh.texture_coordinates.emplace_back(along, -slant * down);
        }
    for (uint32_t row = 0; row + 1 < cone.rows; ++row)
        for (uint32_t column = 0; column < quads; ++column)
        {
            const uint32_t next = (column + 1) % cone.columns;
            const uint32_t a = row * cone.columns;
            const uint32_t b = a + cone.columns;
            const bool turned = (row + column) % 2 == 0; // diagonals alternate
            mesh.triangles.emplace_back(a + column, b + column, turned ? b + next : a + next);
            mesh.triangles.emplace_back(turned ? a + column : b + column, b + next, a + next);
        }
    return mesh;
}

} // namespace

voile::engine::Mesh make_skirt(uint32_t coarseness)
{
    return make_cone({.ring = {0.152f, 0.112f},
                      .hem = {0.40f, 0.37f},
                      .ring_height = 1.055f,
                      .hem_height = 0.56f,
                      .ring_z = -0.006f,
                      .hem_z = 0.f,
                      .half_angle = std::numbers::pi_v<float>,
                      .back = false,
                      .columns = 64 / coarseness,
                      .rows = 20 / coarseness});
}

voile::engine::Mesh make_cape(uint32_t coarseness)
{
    return make_cone({.ring = {0.145f, 0.1f},
                      .hem = {0.42f, 0.42f},
                      .ring_height = 1.4f,
                      .hem_height = 0.5f,
                      .ring_z = -0.052f,
                      .hem_z = -0.1f,
                      .half_angle = 1.15f,
                      .back = true,
                      .columns = 28 / coarseness,
                      .rows = 36 / coarseness});
}

} // namespace scenes
