// The clothes of the walking figure and the curtains.
#include "garments.hpp"

#include "voile/engine/assets/normals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace scenes
{

namespace
{

constexpr float k_cape_distance = 0.009f; // m, from the skin: 1.5 times the thickness of the scene's fabric

// An elliptic cone from a ring to a hem, around the y axis.
struct Cone
{
    glm::vec2 ring; // m, half widths along x and z
    glm::vec2 hem;
    float ring_height; // m
    float hem_height;
    float ring_z; // of its middle
    float hem_z;
    uint32_t columns; // vertices
    uint32_t rows;
};

constexpr Cone k_skirt{.ring = {0.152f, 0.112f},
                       .hem = {0.40f, 0.37f},
                       .ring_height = 1.055f,
                       .hem_height = 0.56f,
                       .ring_z = -0.006f,
                       .hem_z = 0.f,
                       .columns = 64,
                       .rows = 20};

// Two triangles per quad of a grid; with as many quads as columns its ends are joined.
void add_triangles(voile::engine::Mesh& mesh, uint32_t columns, uint32_t rows, uint32_t quads)
{
    for (uint32_t row = 0; row + 1 < rows; ++row)
        for (uint32_t column = 0; column < quads; ++column)
        {
            const uint32_t next = (column + 1) % columns;
            const uint32_t a = row * columns;
            const uint32_t b = a + columns;
            // Diagonals alternate. In a skew quad the longer one could cut through what the cloth lies on.
            const float down = glm::distance(mesh.positions[a + column], mesh.positions[b + next]);
            const float up = glm::distance(mesh.positions[b + column], mesh.positions[a + next]);
            constexpr float k_skew = 1.2f;
            const bool turned = up > k_skew * down || (down < k_skew * up && (row + column) % 2 == 0);
            mesh.triangles.emplace_back(a + column, b + column, turned ? b + next : a + next);
            mesh.triangles.emplace_back(turned ? a + column : b + column, b + next, a + next);
        }
}

voile::engine::Mesh make_cone(const Cone& cone)
{
    voile::engine::Mesh mesh;
    for (uint32_t row = 0; row < cone.rows; ++row)
        for (uint32_t column = 0; column < cone.columns; ++column)
        {
            const float down = static_cast<float>(row) / static_cast<float>(cone.rows - 1);
            const float angle = std::numbers::pi_v<float> *
                                (2 * static_cast<float>(column) / static_cast<float>(cone.columns) - 1); // from +z
            const glm::vec2 half = glm::mix(cone.ring, cone.hem, down);
            mesh.positions.emplace_back(half.x * std::sin(angle), glm::mix(cone.ring_height, cone.hem_height, down),
                                        glm::mix(cone.ring_z, cone.hem_z, down) + half.y * std::cos(angle));
            // Mirrored at the front, so that the fabric has no seam.
            const float along = 0.5f * (half.x + half.y) * std::abs(angle);
            const float slant = std::hypot(cone.ring_height - cone.hem_height, cone.hem.x - cone.ring.x);
            mesh.texture_coordinates.emplace_back(along, -slant * down);
        }
    add_triangles(mesh, cone.columns, cone.rows, cone.columns);
    return mesh;
}

// The surface at a distance from a mesh, outside of it.
voile::engine::Mesh inflated(const voile::engine::Mesh& mesh, float distance)
{
    voile::engine::Mesh result = mesh;
    std::vector<glm::dvec3> normals;
    voile::engine::sum_normals(mesh.positions, mesh.triangles, normals);
    for (size_t i = 0; i < normals.size(); ++i)
        result.positions[i] += distance * voile::engine::unit_normal(normals[i]);
    return result;
}

// The farthest point of a mesh on a level ray: its distance (m) from `start`, 0 if the ray passes the mesh.
float reach(const voile::engine::Mesh& mesh, const glm::vec3& start, const glm::vec2& direction)
{
    float farthest = 0;
    for (const glm::uvec3& triangle : mesh.triangles)
    {
        std::array<glm::vec2, 2> cut{}; // along and across the ray
        uint32_t cuts = 0;
        for (int i = 0; i < 3 && cuts < 2; ++i)
        {
            const glm::vec3 a = mesh.positions[triangle[i]] - start;
            const glm::vec3 b = mesh.positions[triangle[(i + 1) % 3]] - start;
            if ((a.y < 0) == (b.y < 0))
                continue;
            const glm::vec3 p = glm::mix(a, b, a.y / (a.y - b.y));
            cut[cuts++] = {p.x * direction.x + p.z * direction.y, p.x * direction.y - p.z * direction.x};
        }
        if (cuts == 2 && (cut[0].y < 0) != (cut[1].y < 0))
            farthest = std::max(farthest, glm::mix(cut[0].x, cut[1].x, cut[0].y / (cut[0].y - cut[1].y)));
    }
    return farthest;
}

// Half of the angle that the cape takes around the figure at a height: it covers the shoulders and leaves the arms
// free.
float cape_angle(float height)
{
    return glm::mix(glm::radians(62.f), glm::radians(112.f), glm::smoothstep(1.2f, 1.38f, height));
}

// One column of the cape from the neck to the hem, in small steps. `side` is -1 at one edge and 1 at the other. The
// column lies on `body` where that is widest and hangs from there.
std::vector<glm::vec3> cape_column(const voile::engine::Mesh& body, float side)
{
    constexpr glm::vec2 k_ring{0.085f, 0.06f}; // m, half widths along x and z of what the neck leaves open
    constexpr glm::vec3 k_axis{0, 0, 0.003f};
    constexpr float k_top = 1.46f; // m, below the head
    constexpr float k_hem = 0.48f;
    constexpr float k_step = 0.001f;
    constexpr float k_flare = 0.12f; // growth of the radius per height
    std::vector<glm::vec3> column;
    float radius = 0;
    for (float y = k_top; y >= k_hem; y -= k_step)
    {
        const float angle = side * cape_angle(y);
        const glm::vec2 direction{std::sin(angle), -std::cos(angle)};
        const float skin = reach(body, {k_axis.x, y, k_axis.z}, direction);
        if (column.empty())
        {
            if (skin < 1 / glm::length(direction / k_ring))
                continue;
            radius = skin;
        }
        constexpr float k_above_skirt = 0.04f; // m
        const float down = (k_skirt.ring_height - y) / (k_skirt.ring_height - k_skirt.hem_height);
        const float skirt = down > 0 ? glm::mix(k_skirt.ring.y, k_skirt.hem.y, down) + k_above_skirt : 0.f;
        radius = std::max({radius + k_flare * k_step, skin, skirt});
        column.emplace_back(k_axis.x + radius * direction.x, y, k_axis.z + radius * direction.y);
    }
    return column;
}

} // namespace

voile::engine::Mesh make_skirt(uint32_t coarseness)
{
    Cone cone = k_skirt;
    cone.columns /= coarseness;
    cone.rows /= coarseness;
    return make_cone(cone);
}

voile::engine::Mesh make_cape(const voile::engine::Mesh& figure, uint32_t coarseness)
{
    const uint32_t columns = 24 / coarseness;
    const uint32_t rows = 40 / coarseness;
    const voile::engine::Mesh body = inflated(figure, k_cape_distance);
    voile::engine::Mesh mesh;
    mesh.positions.resize(size_t{rows} * columns);
    mesh.texture_coordinates.resize(mesh.positions.size());
    for (uint32_t column = 0; column < columns; ++column)
    {
        const float side = 2 * static_cast<float>(column) / static_cast<float>(columns - 1) - 1;
        const std::vector<glm::vec3> points = cape_column(body, side);
        std::vector<float> lengths{0}; // from the neck
        for (size_t i = 1; i < points.size(); ++i)
            lengths.push_back(lengths.back() + glm::distance(points[i - 1], points[i]));
        size_t next = 1;
        for (uint32_t row = 0; row < rows; ++row)
        {
            const float length = lengths.back() * static_cast<float>(row) / static_cast<float>(rows - 1);
            while (next + 1 < points.size() && lengths[next] < length)
                ++next;
            const float part = (length - lengths[next - 1]) / (lengths[next] - lengths[next - 1]);
            const glm::vec3 p = glm::mix(points[next - 1], points[next], part);
            const size_t vertex = size_t{row} * columns + column;
            mesh.positions[vertex] = p;
            mesh.texture_coordinates[vertex] = {side * cape_angle(p.y) * std::hypot(p.x, p.z), -length};
        }
    }
    add_triangles(mesh, columns, rows, columns - 1);
    return mesh;
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
