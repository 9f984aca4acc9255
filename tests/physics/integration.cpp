// The integrators: free fall, order, the period of a spring pair, energy drift.
#include "physics/cases.hpp"
#include "physics/sheets.hpp"

#include <algorithm>
#include <numbers>

namespace physics
{

namespace
{

const char* name_of(voile::Integrator integrator)
{
    return integrator == voile::Integrator::rk4 ? "RK4" : "Verlet";
}

// Two vertices one meter apart on a spring of 50 N/m. Stretched, they swing with omega^2 = 2 k / m.
struct Pair
{
    double mass;
    double amplitude; // m

    [[nodiscard]] double omega() const { return std::sqrt(2 * 50 / mass); }

    [[nodiscard]] voile::GridCloth grid(voile::Integrator integrator) const
    {
        voile::GridCloth grid; // of 2 x 2 vertices with springs only along rows: two such pairs
        grid.integrator = integrator;
        grid.columns = grid.rows = 2;
        grid.transform[0] *= static_cast<float>(1 + amplitude);
        voile::Material material;
        material.vertex_mass = static_cast<float>(mass);
        material.springs.structural_warp = {50, 0};
        grid.material = material;
        return grid;
    }
};

struct PairState
{
    double stretch;  // m
    double velocity; // m/s, of lengthening
};

PairState swing(const Pair& pair, voile::Integrator integrator, double duration, uint32_t substeps)
{
    Rig rig;
    const voile::ClothId id = voile::engine::take(rig.solver.add_cloth(pair.grid(integrator)));
    rig.upload();
    rig.step({.duration = static_cast<float>(duration), .substeps = substeps, .gravity = {0, 0, 0}});
    const auto x = rig.positions(id);
    const auto v = rig.velocities(id);
    return {x[1].x - x[0].x - 1, v[1].x - v[0].x};
}

// In phase space, where errors of amplitude and phase cannot cancel.
double swing_error(const Pair& pair, voile::Integrator integrator, uint32_t substeps)
{
    const PairState end = swing(pair, integrator, 1, substeps);
    return std::hypot(end.stretch - pair.amplitude * std::cos(pair.omega()),
                      end.velocity / pair.omega() + pair.amplitude * std::sin(pair.omega()));
}

struct Energy
{
    double potential = 0;
    double kinetic = 0;
};

constexpr uint32_t k_side = 9;
constexpr double k_spacing = 0.125; // m

// In double precision, from positions and velocities: springs along rows, columns and diagonals.
Energy energy_of(const voile::Material& m, const std::vector<glm::dvec3>& x, const std::vector<glm::dvec3>& v)
{
    const struct
    {
        int row;
        int column;
        double stiffness;
        double length;
    } springs[] = {{0, 1, static_cast<double>(m.springs.structural_warp.stiffness), k_spacing},
                   {1, 0, static_cast<double>(m.springs.structural_weft.stiffness), k_spacing},
                   {1, 1, static_cast<double>(m.springs.shear.stiffness), k_spacing * std::numbers::sqrt2},
                   {1, -1, static_cast<double>(m.springs.shear.stiffness), k_spacing * std::numbers::sqrt2}};
    Energy energy;
    const int side = static_cast<int>(k_side);
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
        {
            const auto i = static_cast<size_t>(row * side + column);
            energy.kinetic += 0.5 * static_cast<double>(m.vertex_mass) * glm::dot(v[i], v[i]);
            for (const auto& spring : springs)
            {
                const int other_row = row + spring.row;
                const int other_column = column + spring.column;
                if (other_row >= side || other_column < 0 || other_column >= side)
                    continue;
                const double l = glm::distance(x[i], x[static_cast<size_t>(other_row * side + other_column)]);
                energy.potential += 0.5 * spring.stiffness * (l - spring.length) * (l - spring.length);
            }
        }
    return energy;
}

// The largest deviation of the energy from its start within 10 s, relative. Also returns the curve.
double energy_drift(voile::Integrator integrator, uint32_t substeps, Curve& curve)
{
    voile::Material material;
    material.vertex_mass = 0.01f;
    material.springs.structural_warp = material.springs.structural_weft = {50, 0};
    material.springs.shear = {20, 0};
    voile::GridCloth grid;
    grid.integrator = integrator;
    grid.columns = grid.rows = k_side;
    grid.transform[0] *= 1.03f;
    grid.transform[2] *= 0.99f;
    grid.material = material;
    Rig rig;
    const voile::ClothId id = voile::engine::take(rig.solver.add_cloth(grid));
    rig.upload();
    const auto total = [&]
    {
        const Energy energy = energy_of(material, rig.positions(id), rig.velocities(id));
        return energy.potential + energy.kinetic;
    };
    const double start = total();
    double drift = 0;
    for (int i = 1; i <= 50; ++i)
    {
        rig.step({.duration = 0.2f, .substeps = substeps, .gravity = {0, 0, 0}});
        const double deviation = total() / start - 1;
        drift = std::max(drift, std::abs(deviation));
        curve.x.push_back(0.2 * i);
        curve.y.push_back(100 * deviation);
    }
    return drift;
}

} // namespace

CaseResult free_fall(Detail detail)
{
    CaseResult result;
    const uint32_t side = detail == Detail::fine ? 17 : 9;
    for (const auto integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
    {
        voile::Fabric fabric = plain_fabric(1000);
        fabric.damping_ratio = 0.5f;
        fabric.shear_stiffness = 100;
        const bool rk4 = integrator == voile::Integrator::rk4;
        // The velocity's roundings in each of 618 and 1236 substeps, of either sign, equal for all vertices.
        const Target target = rk4 ? Target{8e-6, 5e-5} : Target{9e-6, 5e-5};
        voile::GridCloth grid;
        grid.integrator = integrator;
        grid.columns = grid.rows = side;
        grid.material = fabric;
        Rig rig;
        const voile::ClothId id = voile::engine::take(rig.solver.add_cloth(grid));
        rig.upload();
        rig.step({.duration = 0.5f});
        double farthest = 0;
        const double exact = -0.5 * k_gravity * 0.25;
        for (const glm::dvec3& x : rig.positions(id))
            if (std::abs(x.y - exact) >= std::abs(farthest - exact) || farthest == 0)
                farthest = x.y;
        result.measurements.push_back({std::string("height after 0.5 s, m, ") + name_of(integrator),
                                       grid_size(side, side), farthest, exact, target.at(detail)});
    }
    return result;
}

CaseResult order(Detail detail)
{
    CaseResult result;
    const Pair pair{1, 0.5};
    Plot plot{"order", "Error of a swinging pair", "step, s", "error, m", {}, true, false};
    for (const auto integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
    {
        const bool rk4 = integrator == voile::Integrator::rk4;
        // Shorter steps of RK4 hit float rounding. In longer steps of Verlet the pair is fast enough for viscosity.
        const uint32_t first = (rk4 ? 20 : 40) * (detail == Detail::fine ? 2 : 1);
        Curve curve{name_of(integrator), {}, {}, false};
        for (uint32_t substeps = first / 2; substeps <= 4 * first; substeps *= 2)
        {
            curve.x.push_back(1.0 / substeps);
            curve.y.push_back(swing_error(pair, integrator, substeps));
        }
        const double exact = rk4 ? 4 : 2;
        const Target target = rk4 ? Target{0.002, 0.015} : Target{0.02, 0.003};
        result.measurements.push_back({std::string("slope, ") + name_of(integrator),
                                       std::to_string(first) + " and " + std::to_string(2 * first) + " steps/s",
                                       std::log2(curve.y[1] / curve.y[2]), exact, target.at(detail)});
        plot.curves.push_back(curve);
    }
    result.plots.push_back(plot);
    return result;
}

CaseResult spring_pair(Detail detail)
{
    CaseResult result;
    const Pair pair{0.2, 0.05};
    const uint32_t substeps = detail == Detail::fine ? 100 : 50;
    const double exact = 2 * std::numbers::pi / pair.omega();
    for (const auto integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
    {
        // After four exact periods the phase gives the error of the period.
        const PairState end = swing(pair, integrator, 4 * exact, 4 * substeps);
        const bool rk4 = integrator == voile::Integrator::rk4;
        const Target target = rk4 ? Target{1e-5, 5.5e-7} : Target{2e-3, 5e-4};
        const double phase = std::atan2(-end.velocity / pair.omega(), end.stretch);
        result.measurements.push_back({std::string("period, s, ") + name_of(integrator),
                                       std::to_string(substeps) + " steps per period",
                                       exact / (1 + phase / (8 * std::numbers::pi)), exact, target.at(detail)});
    }
    return result;
}

CaseResult energy(Detail detail)
{
    CaseResult result;
    Plot plot{"energy", "Energy of a free cloth", "time, s", "deviation, %", {}, false, false};
    for (const auto integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
    {
        // The fastest mode of the grid swings with 208 1/s. RK4 loses (omega h)^6 / 72 of a mode's energy per step.
        const uint32_t substeps = detail == Detail::fine ? 160 : 80;
        const bool rk4 = integrator == voile::Integrator::rk4;
        const Target target = rk4 ? Target{5e-3, 2e-4} : Target{5e-3, 1.2e-3};
        Curve curve{name_of(integrator), {0}, {0}, false};
        const double drift = energy_drift(integrator, substeps, curve);
        result.measurements.push_back({std::string("largest deviation in 10 s, ") + name_of(integrator),
                                       std::to_string(5 * substeps) + " steps/s", drift, 0, target.at(detail)});
        plot.curves.push_back(curve);
    }
    result.plots.push_back(plot);
    return result;
}

} // namespace physics
