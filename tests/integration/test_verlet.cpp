// Velocity Verlet on the GPU: against the double-precision reference, its order with and without damping, exact free
// fall, energy over a long time, RK4 and Verlet cloths side by side, contact.
#include "reference/mesh_reference.hpp"
#include "support/close_to.hpp"
#include "support/cloth_harness.hpp"
#include "support/cloth_meshes.hpp"

#include <algorithm>
#include <cmath>

namespace
{

using tests::ClothHarness;

voile::GridCloth uneven_sheet(uint32_t columns, uint32_t rows)
{
    voile::GridCloth grid = tests::stretched_sheet(columns, rows);
    tests::raw(grid).springs.shear = {120, 1};
    tests::raw(grid).springs.bend_weft = {60, 0.5f};
    tests::raw(grid).springs.diagonal_bend = {30, 0.2f};
    tests::raw(grid).air_drag_normal = 1.28f;
    tests::raw(grid).air_drag_tangential = 0.1f;
    tests::raw(grid).border_scale = 0.7f;
    grid.integrator = voile::Integrator::verlet;
    return grid;
}

struct State
{
    std::vector<glm::vec4> x;
    std::vector<glm::vec4> v;
    bool operator==(const State&) const = default;
};

State state_of(ClothHarness& harness, voile::ClothId id)
{
    return {harness.positions(id), harness.velocities(id)};
}

double largest(const std::vector<glm::dvec3>& values)
{
    double result = 0;
    for (const glm::dvec3& v : values)
        result = std::max(result, glm::length(v));
    return result;
}

double largest_difference(const std::vector<glm::vec4>& a, const std::vector<glm::dvec3>& b)
{
    double result = 0;
    for (size_t i = 0; i < b.size(); ++i)
        result = std::max(result, glm::distance(glm::dvec3(a[i]), b[i]));
    return result;
}

// Two masses on a spring, twice. They start stretched along x. `apart` is 1 m at rest.
voile::GridCloth pairs(float stretch, float mass, voile::Spring spring)
{
    voile::GridCloth grid;
    grid.columns = grid.rows = 2;
    grid.transform[0] *= 1 + stretch;
    grid.material = voile::Material{};
    tests::raw(grid).vertex_mass = mass;
    tests::raw(grid).springs.structural_warp = spring;
    grid.integrator = voile::Integrator::verlet;
    return grid;
}

struct Swing
{
    double length; // m
    double rate;   // m/s
};

// The state of the pair in its spring after `duration` seconds in `substeps`, in one step.
Swing swing(const voile::GridCloth& grid, double duration, uint32_t substeps)
{
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    harness.step({.duration = static_cast<float>(duration), .substeps = substeps, .gravity = {0, 0, 0}});
    const State s = state_of(harness, id);
    return {static_cast<double>(s.x[1].x - s.x[0].x), static_cast<double>(s.v[1].x - s.v[0].x)};
}

} // namespace

TEST_CASE("a Verlet step of one and of several substeps equals the double-precision reference")
{
    struct Size
    {
        uint32_t columns;
        uint32_t rows;
    };
    // 4, 63, 64, 65 and 1234 vertices.
    constexpr float k_step = 1e-3f;
    ClothHarness harness;
    std::vector<voile::GridCloth> grids;
    std::vector<voile::ClothId> ids;
    for (const Size& size : {Size{2, 2}, Size{9, 7}, Size{8, 8}, Size{13, 5}, Size{617, 2}})
    {
        grids.push_back(uneven_sheet(size.columns, size.rows));
        grids.back().pins = {1};
        ids.push_back(voile::engine::take(harness.solver.add_cloth(grids.back())));
    }
    harness.upload();
    std::vector<reference::Cloth> references(grids.begin(), grids.end());
    uint32_t steps = 0;
    for (const uint32_t substeps : {1u, 2u, 7u})
    {
        CAPTURE(substeps);
        steps += substeps;
        const voile::Step step{
            .duration = k_step * static_cast<float>(substeps), .substeps = substeps, .wind = {1, 0.5f, -2}};
        harness.step(step);
        for (size_t i = 0; i < ids.size(); ++i)
        {
            CAPTURE(grids[i].columns);
            reference::Cloth& reference = references[i];
            reference.verlet_step(static_cast<double>(k_step), substeps, {.wind = {1, 0.5, -2}},
                                  static_cast<double>(harness.solver.stability(ids[i], step).load));
            // Positions round once at upload and once per substep. Velocities: rounded positions give an acceleration
            // that is off by up to omega^2 times their error, twice per substep; omega^2 <= 2 * 400 * 16 / (0.15 *
            // 0.7^2), from at most 16 springs of 400 N/m. The errors of substeps add up, and positions move by h times
            // the errors of v.
            const double rounding = std::exp2(-24) * largest(reference.state.x);
            const double omega_squared = 2 * 400 * 16 / (0.15 * 0.49);
            const double h = static_cast<double>(k_step);
            const double bound_v =
                steps * (2 * h * omega_squared * rounding + 2 * std::exp2(-24) * largest(reference.state.v));
            CHECK(largest_difference(harness.velocities(ids[i]), reference.state.v) < bound_v);
            CHECK(largest_difference(harness.positions(ids[i]), reference.state.x) <
                  2 * steps * rounding + steps * h * bound_v);
        }
    }
}

TEST_CASE("a short Verlet trajectory of a grid and of meshes follows the reference")
{
    voile::GridCloth grid = uneven_sheet(13, 11);
    grid.pins = {0, 12};
    voile::Fabric fabric;
    fabric.stretch_stiffness = {300, 300};
    fabric.bending_stiffness = 1e-3f;
    fabric.damping_ratio = 0.1f;
    fabric.bending_model = voile::BendingModel::isometric;
    const tests::ClothMesh open = tests::jittered_sheet(9, 7);
    const tests::ClothMesh closed = tests::torus(13, 5);
    ClothHarness harness;
    const voile::ClothId grid_id = voile::engine::take(harness.solver.add_cloth(grid));
    std::vector<voile::ClothId> mesh_ids;
    std::vector<reference::MeshCloth> meshes;
    for (const tests::ClothMesh* mesh : {&open, &closed})
    {
        voile::MeshCloth cloth = mesh->cloth();
        cloth.material = fabric;
        cloth.integrator = voile::Integrator::verlet;
        cloth.pins = {0, 12};
        mesh_ids.push_back(voile::engine::take(harness.solver.add_cloth(cloth)));
        meshes.emplace_back(cloth);
    }
    harness.upload();
    const voile::Step step{.duration = 0.05f};
    const uint32_t substeps = harness.solver.stable_substeps(step.duration);
    const double h = static_cast<double>(step.duration) / substeps;
    harness.step(step, 2);
    reference::Cloth reference(grid);
    const auto follow = [&](auto& cloth, voile::ClothId id)
    {
        const auto load = static_cast<double>(harness.solver.stability(id, step).load);
        cloth.verlet_step(h, substeps, {}, load);
        cloth.verlet_step(h, substeps, {}, load);
        // Rounding of each substep adds up, amplified by the motion's own divergence, which is mild over 0.1 s.
        CHECK(tests::relative_error(harness.positions(id), cloth.state.x) < 2 * substeps * std::exp2(-24));
    };
    follow(reference, grid_id);
    for (size_t i = 0; i < meshes.size(); ++i)
        follow(meshes[i], mesh_ids[i]);
    CHECK(harness.velocities(grid_id)[12] == glm::vec4(0));
}

TEST_CASE("Verlet's error falls with the square of the step")
{
    // x'' = -w^2 x - d x' for the stretch of a pair: twice the spring's constants and the drag, over the mass.
    struct Case
    {
        const char* name;
        voile::Spring spring;
        float drag;
    };
    for (const Case& c : {Case{"undamped", {50, 0}, 0}, Case{"damping and drag", {50, 0.6f}, 0.8f}})
    {
        CAPTURE(c.name);
        voile::GridCloth grid = pairs(0.4f, 1, c.spring);
        tests::raw(grid).linear_drag = c.drag;
        const double d = 2 * static_cast<double>(c.spring.damping) + static_cast<double>(c.drag);
        const double omega = std::sqrt(2 * 50.0);
        const double damped = std::sqrt(omega * omega - d * d / 4);
        const double t = 1;
        const double decay = 0.4 * std::exp(-d / 2 * t);
        const double stretch = decay * (std::cos(damped * t) + d / 2 / damped * std::sin(damped * t));
        const double rate = -decay * omega * omega / damped * std::sin(damped * t);
        std::vector<double> errors; // in phase space, where errors of amplitude and phase cannot cancel
        for (const uint32_t substeps : {40u, 80u, 160u})
        {
            const Swing s = swing(grid, t, substeps);
            errors.push_back(std::hypot(s.length - 1 - stretch, (s.rate - rate) / omega));
        }
        for (size_t i = 1; i < errors.size(); ++i)
        {
            CAPTURE(errors[i]);
            CHECK(std::abs(std::log2(errors[i - 1] / errors[i]) - 2) < 0.1);
        }
    }
}

TEST_CASE("a spring pair under Verlet swings with the period of the discrete method")
{
    // The method swings with 2 / h asin(w h / 2) instead of w: after that period the pair is back at its start.
    const voile::GridCloth grid = pairs(0.05f, 0.2f, {50, 0});
    const double omega = std::sqrt(2 * 50 / 0.2);
    const uint32_t substeps = 40;
    const double two_pi = 2 * 3.14159265358979;
    const double h = 2 / omega * std::sin(two_pi / substeps / 2); // 40 substeps are one period of the method
    CHECK(substeps * h == tests::close_to(two_pi / omega, 2e-3));
    const Swing whole = swing(grid, 4 * substeps * h, 4 * substeps);
    // Lengths near 1 m, rounded in each of 160 substeps to 2^-24. One rounding becomes w h = 0.16 of it in other
    // substeps.
    CHECK(std::abs(whole.length - 1.05) < 160 * std::exp2(-24));
    CHECK(std::abs(whole.rate / omega) < 160 * std::exp2(-24));
    CHECK(std::abs(swing(grid, substeps * h / 2, substeps / 2).length - 0.95) < 20 * std::exp2(-24));
}

TEST_CASE("free fall under Verlet is exact")
{
    // x and v are quadratic and linear in time, which the method reproduces exactly. Internal damping has no effect.
    voile::GridCloth grid;
    grid.columns = 17;
    grid.rows = 9;
    grid.transform[3] = {0, 4, 0, 1};
    grid.velocity = {0, 1, 0};
    grid.material = voile::reference_material();
    grid.integrator = voile::Integrator::verlet;
    tests::raw(grid).linear_drag = 0;
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    harness.step({.duration = 0.5f, .substeps = 330});
    const double t = 0.5;
    for (const glm::vec4& x : harness.positions(id))
        CHECK(double(x.y) == tests::close_to(4 + t - 0.5 * 9.81 * t * t, 2.5e-7));
    for (const glm::vec4& v : harness.velocities(id))
        CHECK(double(v.y) == tests::close_to(1 - 9.81 * t, 1e-5));
}

TEST_CASE("an undamped cloth that flaps freely keeps its energy for 10 s")
{
    for (const auto integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
    {
        CAPTURE(static_cast<int>(integrator));
        voile::GridCloth grid;
        grid.columns = 7;
        grid.rows = 6;
        grid.width = 0.6f;
        grid.depth = 0.5f;
        grid.material = voile::Material{};
        tests::raw(grid).vertex_mass = 0.1f;
        tests::raw(grid).springs = {{200, 0}, {200, 0}, {60, 0}, {5, 0}, {5, 0}, {}};
        grid.integrator = integrator;
        grid.pins = {0, 6};
        ClothHarness harness;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        harness.upload();
        reference::Cloth reference(grid);
        const auto energy = [&]
        {
            const State s = state_of(harness, id);
            reference.state.x.assign(s.x.begin(), s.x.end());
            reference.state.v.assign(s.v.begin(), s.v.end());
            return reference.energy({});
        };
        const double start = energy();
        // The exchanged energy is the potential energy of the fall: the sheet's weight times half its depth.
        const double swings = 40 * 0.1 * 9.81 * 0.25;
        // omega h = 0.09 for the fastest mode, 126 1/s, so errors are at most (omega h)^2 / 8 of its energy: 0.1 %.
        double furthest = 0;
        for (int i = 0; i < 10; ++i)
        {
            harness.step({.duration = 1, .substeps = 1400});
            furthest = std::max(furthest, std::abs(energy() - start));
        }
        CHECK(furthest < 1e-3 * swings);
        CHECK(harness.statistics().kinetic_energy > 0.02 * swings); // the sheet does flap
    }
}

TEST_CASE("RK4 and Verlet cloths in one solver change no bit of each other")
{
    const tests::ClothMesh mesh = tests::torus(9, 7);
    voile::GridCloth rk4 = uneven_sheet(13, 5);
    rk4.integrator = voile::Integrator::rk4;
    const voile::GridCloth verlet = uneven_sheet(9, 7);
    voile::MeshCloth ball = mesh.cloth();
    ball.transform[3] = {0.1f, 2.1f, -0.3f, 1};
    ball.velocity = {0, -0.5f, 0};
    ball.integrator = voile::Integrator::verlet;
    // The choice of feature edges and vertices depends on all cloths together; here there are none.
    const voile::SolverOptions options{.feature_contact = false};
    for (const bool contact : {false, true})
    {
        CAPTURE(contact);
        const auto add_collider = [&](ClothHarness& harness)
        {
            if (contact)
                voile::engine::take(
                    harness.solver.add_collider(voile::SphereCollider{.center = {0.1f, 1.7f, -0.3f}, .radius = 0.3f}));
        };
        // 7 and 4 substeps per step, and one, so that each exchange of state buffers is covered.
        const auto run = [](ClothHarness& harness)
        {
            harness.upload();
            for (const uint32_t substeps : {7u, 4u, 1u, 3u})
                harness.step({.duration = 1e-3f * static_cast<float>(substeps), .substeps = substeps}, 2);
        };
        ClothHarness together(options);
        add_collider(together);
        const voile::ClothId ids[] = {voile::engine::take(together.solver.add_cloth(verlet)),
                                      voile::engine::take(together.solver.add_cloth(rk4)),
                                      voile::engine::take(together.solver.add_cloth(ball))};
        run(together);
        CHECK((together.statistics().contacts > 0) == contact);
        for (int alone = 0; alone < 3; ++alone)
        {
            CAPTURE(alone);
            ClothHarness harness(options);
            add_collider(harness);
            const voile::ClothId id = voile::engine::take(alone == 0   ? harness.solver.add_cloth(verlet)
                                                          : alone == 1 ? harness.solver.add_cloth(rk4)
                                                                       : harness.solver.add_cloth(ball));
            run(harness);
            CHECK(state_of(harness, id) == state_of(together, ids[alone]));
        }
    }
}

TEST_CASE("a Verlet cloth with contact stays above the surface")
{
    const glm::vec3 center{0, 0.2f, 0};
    constexpr float k_radius = 0.25f;
    ClothHarness harness;
    std::vector<voile::ClothId> ids;
    for (const bool fast : {false, true})
    {
        voile::GridCloth grid;
        grid.columns = grid.rows = 17;
        grid.transform[3] = {0, fast ? 0.7f : 0.5f, 0, 1};
        grid.velocity = {0, fast ? -20.f : 0, 0}; // 20 m/s: a third of a meter per step
        grid.integrator = voile::Integrator::verlet;
        ids.push_back(voile::engine::take(harness.solver.add_cloth(grid)));
    }
    voile::engine::take(harness.solver.add_collider(voile::SphereCollider{.center = center, .radius = k_radius}));
    harness.upload();
    uint32_t most_contacts = 0;
    for (int i = 0; i < 20; ++i)
    {
        harness.step({});
        const voile::Statistics statistics = harness.statistics();
        most_contacts = std::max(most_contacts, statistics.contacts);
        CHECK(statistics.penetrating_vertices == 0);
        CHECK(statistics.nan_vertices == 0);
        for (const voile::ClothId id : ids)
            for (const glm::vec4& x : harness.positions(id)) // the fabric's thickness is kept, in float
                CHECK(glm::distance(glm::dvec3(x), glm::dvec3(center)) >
                      static_cast<double>(k_radius) + 0.005 - 4 * std::exp2(-24));
    }
    CHECK(most_contacts > 20);
}
