// Parts of scenes in which cloth that collides with itself is carried, or slides.
#pragma once

#include "support/collider_scenes.hpp"
#include "support/fastest.hpp"
#include "support/pair_harness.hpp"

#include "voile/engine/assets/shapes.hpp"

namespace tests
{

inline constexpr float k_frame = 1.f / 60;
inline constexpr float k_pi = std::numbers::pi_v<float>;

inline voile::GridCloth airless_pair_sheet(uint32_t size, float spacing, const glm::vec3& velocity)
{
    voile::GridCloth result = pair_sheet(size, size, spacing);
    fabric_of(result).air_drag_normal = fabric_of(result).air_drag_tangential = 0;
    result.velocity = velocity;
    return result;
}

inline glm::dvec3 mean_of(const std::vector<glm::vec4>& values)
{
    glm::dvec3 sum(0);
    for (const glm::vec4& value : values)
        sum += glm::dvec3(value);
    return sum / static_cast<double>(values.size());
}

// m, along x.
inline double position_of(PairHarness& harness, voile::ClothId cloth)
{
    return mean_of(harness.positions(cloth)).x;
}

// m/s, relative to what moves along x.
inline float fastest_beside(PairHarness& harness, voile::ClothId cloth, float speed)
{
    std::vector<glm::vec4> relative = harness.velocities(cloth);
    for (glm::vec4& v : relative)
        v.x -= speed;
    return fastest(relative);
}

inline constexpr uint32_t k_all = voile::Step{}.max_substeps;

// A mesh of quads whose vertices are the points of columns and rows.
template <typename Point>
voile::engine::Mesh quads(uint32_t columns, uint32_t rows, const Point& point)
{
    voile::engine::Mesh mesh;
    for (uint32_t row = 0; row <= rows; ++row)
        for (uint32_t column = 0; column <= columns; ++column)
            mesh.positions.push_back(point(static_cast<float>(column), static_cast<float>(row)));
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column)
        {
            const uint32_t first = row * (columns + 1) + column;
            const uint32_t below = first + columns + 1;
            mesh.triangles.insert(mesh.triangles.end(), {{first, below, first + 1}, {first + 1, below, below + 1}});
        }
    return mesh;
}

// In at most so many substeps.
inline voile::Step step_of(uint32_t substeps)
{
    return {.duration = k_frame, .max_substeps = substeps, .air_density = 0};
}

inline constexpr uint32_t k_budgets[] = {k_all, 8};

// Where all combinations of factors would take a software device minutes, budgets take turns. With an odd number of
// runs per value of the outer factor, each value of a factor meets each budget.
inline uint32_t budget_in_turn(uint32_t run)
{
    return k_budgets[run % std::size(k_budgets)];
}

// Two layers, the upper one turned a little.
inline void add_layers(PairHarness& harness, const voile::GridCloth& lower, const glm::vec3& position)
{
    for (const float layer : {0.f, 1.f})
    {
        voile::GridCloth grid = lower;
        const float height = 1.02f * fabric_of(grid).thickness * (1 + layer);
        grid.transform = at(position + glm::vec3(0, height, 0)) * turned(0.2f * layer, {0, 1, 0});
        harness.add(grid);
    }
}

// Capes whose upper edge is pinned to an anchor.
class Capes
{
public:
    Capes(PairHarness& harness, uint32_t layers, const voile::GridCloth& cape, const glm::vec3& position,
          const glm::vec3& direction = {1, 0, 0})
        : harness_(harness), anchor_(voile::engine::take(harness.solver.add_anchor(at(position)))), start_(position),
          direction_(direction)
    {
        for (uint32_t layer = 0; layer < layers; ++layer)
        {
            voile::GridCloth grid = cape;
            const float apart = 2 * fabric_of(grid).thickness * static_cast<float>(layer);
            const glm::vec3 middle = position + glm::vec3(0, -0.5f * grid.depth, apart);
            grid.transform = at(middle) * turned(k_pi / 2, {1, 0, 0});
            const voile::ClothId id = harness.add(grid);
            std::vector<voile::Attachment> pins;
            for (uint32_t column = 0; column < grid.columns; ++column)
                pins.push_back(voile::pin(column, anchor_));
            voile::engine::take(harness.solver.set_attachments(id, pins));
        }
    }

    void move(float along)
    {
        voile::engine::take(harness_.solver.move_anchor(anchor_, at(start_ + along * direction_)));
    }

private:
    PairHarness& harness_;
    voile::AnchorId anchor_;
    glm::vec3 start_;
    glm::vec3 direction_;
};

} // namespace tests
