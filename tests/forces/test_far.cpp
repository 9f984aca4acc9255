// Far from the origin, where float coordinates are coarse: positions keep what rounding would lose.
#include "support/close_to.hpp"
#include "support/cloth_harness.hpp"

#include "voile/fabrics.hpp"

#include <cmath>

namespace
{

// Hangs from its row 0, at rest.
voile::Statistics hanging_cotton(float distance)
{
    voile::Fabric fabric = voile::cotton();
    fabric.damping_ratio = 0.5f;
    voile::GridCloth grid{.columns = 9, .rows = 9, .material = fabric, .integrator = voile::Integrator::verlet};
    grid.transform[1] = {0, 0, 1, 0}; // grid z to -y
    grid.transform[2] = {0, -1, 0, 0};
    grid.transform[3] = {distance, distance, -distance, 1};
    for (uint32_t column = 0; column < grid.columns; ++column)
        grid.pins.push_back(column);
    tests::ClothHarness harness;
    (void)voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    harness.step({.duration = 0.1f}, 10);
    return harness.statistics();
}

} // namespace

TEST_CASE("cloth 10 km from the origin hangs and rests as at the origin, and 100 km from it stays finite")
{
    const voile::Statistics here = hanging_cotton(0);
    const voile::Statistics far = hanging_cotton(1e4f);
    CAPTURE(here.mean_stretch);
    CAPTURE(far.mean_stretch);
    CAPTURE(here.kinetic_energy);
    CAPTURE(far.kinetic_energy);
    CHECK(far.max_stretch == tests::close_to(here.max_stretch, 5e-4));
    CHECK(far.mean_stretch == tests::close_to(here.mean_stretch, 2.5e-4));
    CHECK(far.kinetic_energy < 1.2e-10f);
    const voile::Statistics farther = hanging_cotton(1e5f);
    CHECK(farther.nan_vertices == 0);
    CHECK(std::isfinite(farther.kinetic_energy));
}
