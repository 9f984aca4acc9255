// Cloth at rest under its own weight: a hanging sheet, a strip held at both ends.
#include "physics/cases.hpp"
#include "physics/sheets.hpp"

#include <algorithm>

namespace physics
{

namespace
{

double elongation(uint32_t side, double shear)
{
    voile::Fabric fabric = plain_fabric(1000);
    fabric.shear_stiffness = static_cast<float>(shear);
    const voile::GridCloth grid = hanging_sheet(side, side, 1, 1, fabric);
    Rig rig;
    const voile::ClothId id = voile::engine::take(rig.solver.add_cloth(grid));
    rig.upload();
    rig.settle(id, {.duration = 0.005f}, 400);
    return -rig.positions(id)[size_t{side} * (side - 1) + side / 2].y - 1;
}

// The parameter u of a catenary, sinh(u) / u = length / span.
double catenary_parameter(double span)
{
    double low = 1e-3;
    double high = 20;
    for (int i = 0; i < 100; ++i)
    {
        const double u = 0.5 * (low + high);
        (std::sinh(u) / u < 1 / span ? low : high) = u;
    }
    return 0.5 * (low + high);
}

Curve catenary_curve(double span)
{
    Curve curve{"exact", {}, {}, false};
    const double u = catenary_parameter(span);
    const double a = span / (2 * u);
    for (int i = 0; i <= 100; ++i)
    {
        const double x = span * (i / 100.0 - 0.5);
        curve.x.push_back(x);
        curve.y.push_back(a * (std::cosh(x / a) - std::cosh(u)));
    }
    return curve;
}

// The center line of a strip of unit length, held at both ends.
std::vector<glm::dvec3> hanging_strip(uint32_t links, double span)
{
    // Stretched by less than rho g L / k = 0.07 %. Two rows without shear, which hang identically.
    const voile::Fabric fabric = plain_fabric(3000);
    voile::GridCloth grid;
    grid.integrator = voile::Integrator::verlet;
    grid.columns = links + 1;
    grid.rows = 2;
    grid.width = 1;
    grid.depth = 1.f / static_cast<float>(links);
    grid.material = fabric;
    grid.pins = {0, links, links + 1, 2 * links + 1};
    Rig rig;
    const voile::ClothId id = voile::engine::take(rig.solver.add_cloth(grid));
    rig.upload();
    // A nearby start: a parabola with the right sag, its points evenly spaced over the span.
    const double u = catenary_parameter(span);
    const double sag = (std::cosh(u) - 1) / (2 * std::sinh(u));
    std::vector<glm::dvec3> start;
    for (uint32_t row = 0; row < 2; ++row)
        for (uint32_t i = 0; i <= links; ++i)
        {
            const double s = static_cast<double>(i) / links - 0.5;
            start.emplace_back(span * s, sag * (4 * s * s - 1), (row - 0.5) / links);
        }
    rig.set_positions(id, start);
    // Steps are shorter than the fastest swings of the links: otherwise their energy would never be seen to fall.
    rig.settle(id, {.duration = 0.005f}, 1600, 1e-9);
    auto x = rig.positions(id);
    x.resize(links + 1);
    return x;
}

} // namespace

CaseResult hanging_sheet(Detail detail)
{
    CaseResult result;
    const double exact = 0.2 * k_gravity / (2 * 1000);
    const std::vector<uint32_t> sides = detail == Detail::fine ? std::vector{9u, 17u, 33u} : std::vector{5u, 9u, 17u};
    double least = 1e9;
    double most = 0;
    for (size_t i = 0; i < sides.size(); ++i)
    {
        const double found = elongation(sides[i], 0);
        const char* names[] = {"elongation, coarse", "elongation, middle", "elongation, fine"};
        result.measurements.push_back({names[i], grid_size(sides[i], sides[i]), found, exact, 1.3e-4});
        const double sheared = elongation(sides[i], 300);
        least = std::min(least, sheared);
        most = std::max(most, sheared);
    }
    result.measurements.push_back({"spread of three resolutions, with shear stiffness", "all three", most / least - 1,
                                   0, Target{0.02, 0.01}.at(detail)});
    return result;
}

CaseResult catenary(Detail detail)
{
    CaseResult result;
    const uint32_t links = detail == Detail::fine ? 64 : 32;
    Plot plot{"catenary", "Strip held at both ends", "x / length", "y / length", {}, false, true};
    for (const double span : {0.5, 0.6, 0.8, 0.9})
    {
        const auto x = hanging_strip(links, span);
        Curve curve{"ours", {}, {}, true};
        double lowest = 0;
        for (const glm::dvec3& p : x)
        {
            curve.x.push_back(p.x);
            curve.y.push_back(p.y);
            lowest = std::min(lowest, p.y);
        }
        const double u = catenary_parameter(span);
        result.measurements.push_back({"sag at span " + short_number(span), std::to_string(links) + " links", -lowest,
                                       (std::cosh(u) - 1) / (2 * std::sinh(u)), 0.004});
        plot.curves.push_back(curve);
        plot.curves.push_back(catenary_curve(span)); // above the dots
    }
    result.plots.push_back(plot);
    return result;
}

} // namespace physics
