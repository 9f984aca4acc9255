// A square grid 2 m above the origin that feels no air.
#pragma once

#include "voile/descriptions.hpp"

#include <cstdint>

namespace tests
{

inline voile::GridCloth airless_sheet(uint32_t side)
{
    voile::GridCloth grid;
    grid.columns = grid.rows = side;
    grid.transform[3] = {0, 2, 0, 1};
    voile::Fabric fabric;
    fabric.air_drag_normal = fabric.air_drag_tangential = 0;
    grid.material = fabric;
    return grid;
}

} // namespace tests
