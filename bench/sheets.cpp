// Sheets.
#include "sheets.hpp"

#include "voile/engine/gpu/device.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace bench
{

voile::GridCloth reference_grid(uint32_t side, float x, float z)
{
    const float size = k_reference_spacing * static_cast<float>(side - 1);
    voile::GridCloth grid;
    grid.columns = side;
    grid.rows = side;
    grid.width = size;
    grid.depth = size;
    grid.transform[3] = {x + size / 2, 4.8f, z + size / 2, 1};
    grid.material = voile::reference_material();
    return grid;
}

voile::GridCloth drape_grid(uint32_t side)
{
    voile::Fabric fabric;
    fabric.areal_density = 0.3f;
    fabric.stretch_stiffness = {1000, 1000};
    fabric.shear_stiffness = 333;
    fabric.bending_stiffness = 2e-5f;
    fabric.thickness = 0.005f;
    fabric.static_friction = 0.4f;
    fabric.kinetic_friction = 0.4f;
    fabric.air_drag_normal = 0;
    fabric.air_drag_tangential = 0;
    voile::GridCloth grid;
    grid.columns = side;
    grid.rows = side;
    grid.width = 2.4f;
    grid.depth = 2.4f;
    grid.transform[3] = {0, 0.85f, 0, 1};
    grid.material = fabric;
    return grid;
}

voile::GridCloth verlet_grid(uint32_t side, bool self_collision)
{
    voile::GridCloth grid = drape_grid(side);
    grid.integrator = voile::Integrator::verlet;
    grid.self_collision = self_collision;
    return grid;
}

voile::ClothId add_as_mesh(voile::Solver& solver, const voile::GridCloth& grid, bool shuffled,
                           voile::BendingModel bending)
{
    const uint32_t side = grid.columns;
    std::vector<uint32_t> order(size_t{side} * side);
    std::iota(order.begin(), order.end(), 0u);
    if (shuffled) // files may have their vertices in any order
        std::shuffle(order.begin(), order.end(), std::mt19937(1));
    std::vector<glm::vec3> positions(order.size());
    std::vector<glm::uvec3> triangles;
    for (uint32_t row = 0; row < side; ++row)
        for (uint32_t column = 0; column < side; ++column)
        {
            const uint32_t corner = row * side + column;
            const auto along = [&](uint32_t i)
            { return grid.width * (static_cast<float>(i) / static_cast<float>(side - 1) - 0.5f); };
            positions[order[corner]] = {along(column), 0.85f, along(row)};
            if (row + 1 == side || column + 1 == side)
                continue;
            triangles.emplace_back(order[corner], order[corner + side], order[corner + 1]);
            triangles.emplace_back(order[corner + 1], order[corner + side], order[corner + side + 1]);
        }
    voile::MeshCloth mesh;
    mesh.positions = positions;
    mesh.triangles = triangles;
    voile::Fabric fabric = std::get<voile::Fabric>(grid.material);
    fabric.bending_model = bending;
    mesh.material = fabric;
    mesh.integrator = grid.integrator;
    mesh.self_collision = grid.self_collision;
    std::vector<uint32_t> pins;
    for (const uint32_t pin : grid.pins)
        pins.push_back(order[pin]);
    mesh.pins = pins;
    return voile::engine::take(solver.add_cloth(mesh));
}

std::vector<glm::vec4> folds_upright_on(float ground, uint32_t side)
{
    constexpr float k_size = 2.4f;  // m
    constexpr float k_panel = 0.2f; // m, from fold to fold
    constexpr float k_pitch = 0.03f;
    const float height = std::sqrt(k_panel * k_panel - k_pitch * k_pitch);
    const auto last = static_cast<float>(side - 1);
    std::vector<glm::vec4> positions;
    positions.reserve(size_t{side} * side);
    for (uint32_t row = 0; row < side; ++row)
        for (uint32_t column = 0; column < side; ++column)
        {
            const float along = k_size * static_cast<float>(column) / last / k_panel;
            const float z = k_size * (static_cast<float>(row) / last - 0.5f);
            const float part = along - std::floor(along);
            const bool down = static_cast<int>(along) % 2 != 0;
            const float up = height * (down ? 1 - part : part);
            positions.emplace_back(k_pitch * along + (0.3f + 0.1f * z) * up, ground + 0.02f + up, z, 0);
        }
    return positions;
}

} // namespace bench
