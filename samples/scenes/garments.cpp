// The clothes of the walking figure and the curtains.
#include "garments.hpp"

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

// Two triangles per quad of a grid; with as many quads as columns its ends are joined.
void add_triangles(voile::engine::Mesh& mesh, uint32_t columns, uint32_t rows, uint32_t quads)
{
    for (uint32_t row = 0; row + 1 < rows; ++row)
        for (uint32_t column = 0; column < quads; ++column)
        {
            const uint32_t next = (column + 1) % columns;
            const uint32_t a = row * columns;
            const uint32_t b = a + columns;
            const bool turned = (row + column) % 2 == 0; // diagonals alternate
            mesh.triangles.emplace_back(a + column, b + column, turned ? b + next : a + next);
            mesh.triangles.emplace_back(turned ? a + column : b + column, b + next, a + next);
        }
}

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
    add_triangles(mesh, cone.columns, cone.rows, quads);
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

voile::engine::Mesh make_curtain()
{
    constexpr uint32_t k_pleats = 6;
    constexpr uint32_t k_edges = 10; // along a pleat
    constexpr uint32_t k_columns = k_edges * k_pleats + 1;
    constexpr uint32_t k_rows = 48;
    constexpr float k_pleat = 0.18f; // m along x
    constexpr float k_depth = 0.06f; // m, from the middle to the front
    constexpr float k_height = 1.84f;
    constexpr float k_frequency = 2 * std::numbers::pi_v<float> / k_pleat;
    // Vertices are evenly spaced along the sine, whose length is summed over short parts.
    constexpr uint32_t k_parts = 200 * k_edges; // of a pleat
    const auto slant = [](float x) { return std::hypot(1.f, k_depth * k_frequency * std::cos(k_frequency * x)); };
    float length = 0; // of a pleat
    for (uint32_t i = 0; i < k_parts; ++i)
        length += slant(k_pleat * (static_cast<float>(i) + 0.5f) / k_parts) * k_pleat / k_parts;
    std::vector<glm::vec2> outline; // x and z
    for (float x = 0; outline.size() < k_columns;)
    {
        outline.emplace_back(x - 0.5f * k_pleats * k_pleat, k_depth * std::sin(k_frequency * x));
        for (uint32_t i = 0; i < k_parts / k_edges; ++i)
            x += length / k_parts / slant(x);
    }
    voile::engine::Mesh mesh;
    for (uint32_t row = 0; row < k_rows; ++row)
    {
        const float down = k_height * static_cast<float>(row) / (k_rows - 1);
        float along = 0; // the straight edges of the mesh, which are the fabric's
        for (uint32_t column = 0; column < k_columns; ++column)
        {
            along += column > 0 ? glm::distance(outline[column], outline[column - 1]) : 0;
            mesh.positions.emplace_back(outline[column].x, -down, outline[column].y);
            mesh.texture_coordinates.emplace_back(along, -down);
        }
    }
    add_triangles(mesh, k_columns, k_rows, k_columns - 1);
    return mesh;
}

} // namespace scenes
