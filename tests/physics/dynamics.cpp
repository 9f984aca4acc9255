// Cloth in motion: the periods of a hanging chain and the terminal speed of a falling plate.
#include "physics/cases.hpp"
#include "physics/sheets.hpp"

#include <algorithm>

namespace physics
{

namespace
{

// Started in the shape of a mode, J0(j sqrt(s / L)) with s the height above the free end (Daniel Bernoulli 1733), a
// strip swings only in that mode: T = 4 pi sqrt(L / g) / j.
double chain_period(double root, uint32_t rows, Curve& curve)
{
    const voile::GridCloth grid = [&]
    {
        voile::Fabric fabric = plain_fabric(10000); // its own weight lengthens it by 0.01 %
        fabric.damping_ratio = 0;
        return hanging_sheet(2, rows, 1.0 / (rows - 1), 1, fabric);
    }();
    const auto shape = [&](uint32_t row)
    { return std::cyl_bessel_j(0, root * std::sqrt(static_cast<double>(rows - 1 - row) / (rows - 1))); };
    Rig rig;
    const voile::ClothId id = voile::engine::take(rig.solver.add_cloth(grid));
    rig.upload();
    auto x = rig.positions(id);
    for (uint32_t i = 0; i < 2 * rows; ++i)
        x[i].z += 0.01 * shape(i / 2); // the shape is 0 at the pinned row; to first order it lengthens nothing
    rig.set_positions(id, x);
    constexpr double k_interval = 0.01;
    std::vector<double> crossings; // of the projection onto the shape, s
    double previous = 1;
    for (int i = 1; crossings.size() < 5 && i < 500; ++i)
    {
        rig.step({.duration = static_cast<float>(k_interval)});
        const auto now_at = rig.positions(id);
        double now = 0;
        for (uint32_t row = 1; row < rows; ++row)
            now += (row + 1 == rows ? 0.5 : 1) * shape(row) * now_at[size_t{2} * row].z;
        if ((previous < 0) != (now < 0))
            crossings.push_back((i - 1 - previous / (now - previous)) * k_interval);
        previous = now;
        curve.x.push_back(k_interval * i);
        curve.y.push_back(1000 * now_at[size_t{2} * (rows - 1)].z);
    }
    return crossings.size() < 5 ? 0 : (crossings[4] - crossings[0]) / 2;
}

} // namespace

CaseResult hanging_chain(Detail detail)
{
    CaseResult result;
    const uint32_t rows = detail == Detail::fine ? 65 : 33;
    Plot plot{"chain", "Free end of a hanging strip, started in its modes", "time, s", "position, mm", {}, false,
              false};
    const struct
    {
        const char* name;
        double root; // of J0
        double period;
        Target target;
    } modes[] = {{"first period, s", 2.404826, 1.668, {0.002, 0.0015}},
                 {"second period, s", 5.520078, 0.7268, {0.012, 0.003}}};
    for (const auto& mode : modes)
    {
        Curve curve{mode.name, {0}, {10}, false};
        const double found = chain_period(mode.root, rows, curve);
        result.measurements.push_back(
            {mode.name, std::to_string(rows - 1) + " links", found, mode.period, mode.target.at(detail)});
        plot.curves.push_back(curve);
    }
    result.plots.push_back(plot);
    return result;
}

CaseResult terminal_speed(Detail detail)
{
    CaseResult result;
    const uint32_t side = detail == Detail::fine ? 17 : 5;
    voile::Fabric fabric = plain_fabric(1000);
    fabric.shear_stiffness = 100;
    fabric.air_drag_normal = 1.28f;
    voile::GridCloth grid;
    grid.integrator = voile::Integrator::verlet;
    grid.columns = grid.rows = side;
    grid.width = grid.depth = 0.5f;
    grid.material = fabric;
    Rig rig;
    const voile::ClothId id = voile::engine::take(rig.solver.add_cloth(grid));
    rig.upload();
    rig.step({.duration = 0.1f}, 15); // nine times v / g
    const double exact = std::sqrt(2 * 0.2 * k_gravity / (1.225 * 1.28));
    double slowest = 1e9;
    double fastest = 0;
    for (const glm::dvec3& v : rig.velocities(id))
    {
        slowest = std::min(slowest, -v.y);
        fastest = std::max(fastest, -v.y);
    }
    const double target = Target{1.5e-5, 6e-5}.at(detail);
    result.measurements.push_back({"slowest vertex, m/s", grid_size(side, side), slowest, exact, target});
    result.measurements.push_back({"fastest vertex, m/s", grid_size(side, side), fastest, exact, target});
    return result;
}

} // namespace physics
