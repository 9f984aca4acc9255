// RK4 on the GPU: against the double-precision reference at awkward sizes, its order, free fall, pinned vertices, many
// cloths, and two runs equal to the bit.
#include "reference/cloth_reference.hpp"
#include "support/close_to.hpp"
#include "support/cloth_harness.hpp"
#include "support/recorded_dispatches.hpp"

#include <algorithm>
#include <cmath>

namespace
{

using tests::ClothHarness;

// Every spring is stretched or compressed, each family differently.
voile::GridCloth uneven_sheet(uint32_t columns, uint32_t rows)
{
    voile::GridCloth grid = tests::stretched_sheet(columns, rows);
    tests::raw(grid).springs.shear = {120, 1};
    tests::raw(grid).springs.bend_weft = {60, 0.5f};
    tests::raw(grid).springs.diagonal_bend = {30, 0.2f};
    tests::raw(grid).air_drag_normal = 1.28f;
    tests::raw(grid).air_drag_tangential = 0.1f;
    tests::raw(grid).border_scale = 0.7f;
    return grid;
}

constexpr float k_step = 1e-3f;

} // namespace

TEST_CASE("one step equals the double-precision reference at awkward sizes")
{
    struct Size
    {
        uint32_t columns;
        uint32_t rows;
    };
    // 4, 63, 64, 65, 1234 and 16384 vertices, and strips of the smallest width.
    const Size sizes[] = {{2, 2}, {9, 7}, {8, 8}, {13, 5}, {617, 2}, {2, 617}, {128, 128}};
    for (const Size& size : sizes)
    {
        CAPTURE(size.columns);
        CAPTURE(size.rows);
        const voile::GridCloth grid = uneven_sheet(size.columns, size.rows);
        ClothHarness harness;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        harness.upload();
        reference::Cloth reference(grid);
        const auto before = reference.state;

        harness.step({.duration = k_step, .substeps = 1, .wind = {1, 0.5f, -2}});
        reference.step(k_step, {.wind = {1, 0.5, -2}});

        // Positions are stored in float: half an ulp of coordinates of size |x| each, twice (upload and result).
        CHECK(tests::relative_error(harness.positions(id), reference.state.x) < 4 * std::exp2(-24));
        // Velocities: a step adds the sum of 16 spring forces. Their elongation l - L loses |x| / (l - L) of its
        // relative accuracy to cancellation: coordinates of 2 m and more against elongations near 5 mm.
        double added = 0;
        double size_of_v = 0;
        for (size_t i = 0; i < before.v.size(); ++i)
        {
            added += glm::dot(reference.state.v[i] - before.v[i], reference.state.v[i] - before.v[i]);
            size_of_v += glm::dot(reference.state.v[i], reference.state.v[i]);
        }
        const double extent = 2 + 0.06 * std::max(size.columns, size.rows);
        const double amplification = extent / 0.005;
        const double bound = std::exp2(-24) * (4 + 4 * amplification * std::sqrt(added / size_of_v));
        CHECK(tests::relative_error(harness.velocities(id), reference.state.v) < bound);
    }
}

TEST_CASE("a short trajectory follows the reference")
{
    voile::GridCloth grid = uneven_sheet(13, 11);
    grid.pins = {0, 12};
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    reference::Cloth reference(grid);
    harness.step({.duration = 0.05f, .substeps = 50}, 2);
    for (int i = 0; i < 100; ++i)
        reference.step(1e-3, {});
    // Rounding of 100 steps at 2^-24 of meters, amplified by the motion's own divergence, which is mild over 0.1 s.
    CHECK(tests::relative_error(harness.positions(id), reference.state.x) < 100 * std::exp2(-24));
    const auto x = harness.positions(id);
    CHECK(x[0].y == tests::close_to(reference.state.x[0].y, 1e-7));
    CHECK(harness.velocities(id)[12] == glm::vec4(0));
}

TEST_CASE("internal damping does not affect free fall")
{
    voile::GridCloth grid;
    grid.columns = 17;
    grid.rows = 9;
    grid.transform[3] = {0, 4, 0, 1};
    grid.material = voile::reference_material();
    tests::raw(grid).linear_drag = 0;
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    harness.step({.duration = 0.5f, .substeps = 330});
    const double t = 0.5;
    const double fallen = 0.5 * 9.81 * t * t;
    for (const glm::vec4& x : harness.positions(id))
        CHECK(double(x.y) == tests::close_to(4 - fallen, 2e-6));
    for (const glm::vec4& v : harness.velocities(id))
        CHECK(double(v.y) == tests::close_to(-9.81 * t, 5e-6));
}

TEST_CASE("a spring pair swings with period 2 pi sqrt(m / 2 k)")
{
    // A 2 x 2 grid with springs only along rows is two pairs. They start 5 % stretched, without gravity.
    voile::GridCloth grid;
    grid.columns = grid.rows = 2;
    grid.transform[0] *= 1.05f;
    grid.material = voile::Material{};
    tests::raw(grid).vertex_mass = 0.2f;
    tests::raw(grid).springs.structural_warp = {50, 0};
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    const double period = 2 * 3.14159265358979 * std::sqrt(0.2 / (2 * 50.0));
    harness.step({.duration = static_cast<float>(period), .substeps = 400, .gravity = {0, 0, 0}}, 4);
    const auto x = harness.positions(id);
    CHECK(double(x[1].x - x[0].x) == tests::close_to(1.05, 2e-7));
    harness.step({.duration = static_cast<float>(period / 2), .substeps = 200, .gravity = {0, 0, 0}});
    const auto half = harness.positions(id);
    CHECK(double(half[1].x - half[0].x) == tests::close_to(0.95, 5e-7));
}

TEST_CASE("the error falls with the fourth power of the step")
{
    // The same pair with a large amplitude, so that truncation errors far exceed float rounding.
    voile::GridCloth grid;
    grid.columns = grid.rows = 2;
    grid.width = 1;
    grid.transform[0] *= 1.5f;
    grid.material = voile::Material{};
    tests::raw(grid).vertex_mass = 1;
    tests::raw(grid).springs.structural_warp = {50, 0};
    const double omega = std::sqrt(2 * 50.0);
    const double t = 1;
    std::vector<double> errors; // in phase space, where errors of amplitude and phase cannot cancel
    for (const uint32_t substeps : {20u, 40u, 80u})
    {
        ClothHarness harness;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        harness.upload();
        harness.step({.duration = static_cast<float>(t), .substeps = substeps, .gravity = {0, 0, 0}});
        const auto x = harness.positions(id);
        const auto v = harness.velocities(id);
        errors.push_back(std::hypot(double(x[1].x - x[0].x) - (1 + 0.5 * std::cos(omega * t)),
                                    double(v[1].x - v[0].x) / omega + 0.5 * std::sin(omega * t)));
    }
    for (size_t i = 1; i < errors.size(); ++i)
    {
        CAPTURE(errors[i]);
        const double slope = std::log2(errors[i - 1] / errors[i]);
        CHECK(std::abs(slope - 4) < 0.1);
    }
}

TEST_CASE("cloths in one solver do not affect each other, and adding one keeps the state of the others")
{
    const voile::GridCloth first = uneven_sheet(13, 5);
    const voile::GridCloth second = uneven_sheet(9, 7);
    const voile::Step step{.duration = 0.01f, .substeps = 10};

    ClothHarness alone;
    const voile::ClothId alone_id = voile::engine::take(alone.solver.add_cloth(first));
    alone.upload();
    alone.step(step, 2);

    ClothHarness together;
    const voile::ClothId first_id = voile::engine::take(together.solver.add_cloth(first));
    together.upload();
    together.step(step);
    const voile::ClothId second_id = voile::engine::take(together.solver.add_cloth(second));
    together.upload();
    together.step(step);

    CHECK(together.positions(first_id) == alone.positions(alone_id));
    CHECK(together.velocities(first_id) == alone.velocities(alone_id));
    reference::Cloth reference(second);
    for (int i = 0; i < 10; ++i)
        reference.step(1e-3, {});
    CHECK(tests::relative_error(together.positions(second_id), reference.state.x) < 10 * std::exp2(-24));
}

TEST_CASE("the workgroup size changes no bit of the result")
{
    std::vector<std::vector<glm::vec4>> results;
    for (const uint32_t size : {32u, 64u, 128u})
    {
        voile::SolverOptions options;
        options.tuning.workgroup_size = size;
        ClothHarness harness(options);
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(uneven_sheet(23, 17)));
        harness.upload();
        harness.step({.duration = 0.02f, .substeps = 20});
        results.push_back(harness.positions(id));
    }
    CHECK(results[0] == results[1]);
    CHECK(results[0] == results[2]);
}

TEST_CASE("normals are the normals of a curved sheet")
{
    voile::GridCloth grid;
    grid.columns = 33;
    grid.rows = 17;
    grid.transform = tests::tilted();
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    harness.step({.duration = 1e-4f, .substeps = 1, .gravity = {0, 0, 0}});
    const glm::vec3 expected(tests::tilted() * glm::vec4(0, 1, 0, 0));
    for (const glm::vec4& n : harness.normals(id))
        CHECK(glm::length(glm::vec3(n) - expected) < 1e-5f);
}

TEST_CASE("normals of a folded sheet are the cross products of its central differences")
{
    voile::GridCloth grid = uneven_sheet(23, 17);
    grid.pins = {0, 22};
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    harness.step({.duration = 0.5f, .substeps = 500});
    const auto x = harness.positions(id);
    const auto normals = harness.normals(id);
    const auto at = [&](uint32_t row, uint32_t column) { return glm::dvec3(x[size_t{row} * 23 + column]); };
    double straightest = 1;
    for (uint32_t row = 0; row < 17; ++row)
        for (uint32_t column = 0; column < 23; ++column)
        {
            const glm::dvec3 along_row = at(row, std::min(column + 1, 22u)) - at(row, column == 0 ? 0 : column - 1);
            const glm::dvec3 along_column = at(std::min(row + 1, 16u), column) - at(row == 0 ? 0 : row - 1, column);
            const glm::dvec3 expected = glm::normalize(glm::cross(along_column, along_row));
            const glm::dvec3 found(normals[size_t{row} * 23 + column]);
            // Differences of float coordinates near 2 m over 5 cm or less.
            CHECK(glm::distance(found, expected) < 16 * std::exp2(-24) * 2 / 0.05);
            straightest = std::min(
                straightest, glm::dot(expected, glm::normalize(glm::cross(at(1, 0) - at(0, 0), at(0, 1) - at(0, 0)))));
        }
    CHECK(straightest < 0.9); // the sheet is curved
}

TEST_CASE("counting the dispatches of a step changes nothing")
{
    const voile::Step step{.substeps = 3};
    std::vector<glm::vec4> ends[2];
    for (int asked = 0; asked < 2; ++asked)
    {
        ClothHarness harness;
        const voile::ClothId id =
            voile::engine::take(harness.solver.add_cloth(voile::GridCloth{.columns = 9, .rows = 7}));
        // It is inside at first, so that depenetration counts its steps.
        (void)voile::engine::take(harness.solver.add_collider(voile::SphereCollider{.radius = 0.3f}));
        harness.upload();
        for (int i = 0; i < 12; ++i)
        {
            if (asked == 1)
                CHECK(harness.solver.dispatches(step) > 0);
            harness.step(step);
        }
        ends[asked] = harness.positions(id);
    }
    CHECK(ends[0] == ends[1]);
}

TEST_CASE("a step has the reported dispatches, and as many for ten cloths as for one")
{
    const voile::Step step{.substeps = 20};
    for (const voile::Integrator integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
        for (const bool everything : {false, true})
        {
            ClothHarness harness;
            voile::Fabric fabric;
            fabric.strain_limit = everything ? 0.05f : 0;
            const auto add = [&]
            {
                const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(voile::GridCloth{
                    .columns = 9, .rows = 7, .material = fabric, .integrator = integrator, .pins = {0}}));
                if (!everything)
                    return;
                const std::vector<voile::Attachment> attachments{{.vertex = 0}, {.vertex = 3, .stiffness = 10}};
                voile::engine::take(harness.solver.set_attachments(id, attachments));
                voile::engine::take(harness.solver.set_tethers(id, voile::Tethers{}));
            };
            const auto count = [&]
            {
                harness.upload();
                harness.step(step); // no edits from the second step on
                const uint32_t dispatches = tests::recorded_dispatches(harness, step);
                CHECK(dispatches == harness.solver.dispatches(step));
                return dispatches;
            };
            for (int i = 0; everything && i < 9; ++i) // enough for near lists; they have edges, but far away
                (void)voile::engine::take(
                    harness.solver.add_collider(voile::BoxCollider{.min = {9, 9, 9}, .max = {10, 10, 10}}));
            add();
            const uint32_t of_one = count();
            for (int i = 0; i < 9; ++i)
                add();
            CHECK(count() == of_one);
        }
}
