#include "physics/sheets.hpp"

#include <cstdio>

namespace physics
{

voile::Fabric plain_fabric(double stretch)
{
    voile::Fabric fabric;
    fabric.areal_density = 0.2f;
    fabric.stretch_stiffness = {static_cast<float>(stretch), static_cast<float>(stretch)};
    fabric.shear_stiffness = 0;
    fabric.bending_stiffness = 0;
    fabric.damping_ratio = 0.1f;
    fabric.air_drag_normal = fabric.air_drag_tangential = 0;
    return fabric;
}

voile::GridCloth hanging_sheet(uint32_t columns, uint32_t rows, double width, double length,
                               const voile::Fabric& fabric)
{
    voile::GridCloth grid;
    grid.integrator = voile::Integrator::verlet;
    grid.columns = columns;
    grid.rows = rows;
    grid.width = static_cast<float>(width);
    grid.depth = static_cast<float>(length);
    grid.transform[1] = {0, 0, 1, 0}; // maps grid z to -y
    grid.transform[2] = {0, -1, 0, 0};
    grid.transform[3] = {0, -0.5f * grid.depth, 0, 1};
    grid.material = fabric;
    for (uint32_t column = 0; column < columns; ++column)
        grid.pins.push_back(column);
    return grid;
}

std::string grid_size(uint32_t columns, uint32_t rows)
{
    return std::to_string(columns) + " × " + std::to_string(rows);
}

std::string short_number(double value)
{
    char text[32];
    std::snprintf(text, sizeof(text), "%.4g", value);
    return text;
}

} // namespace physics
