// Searches for near pairs are due when enough vertices want one. Others wait (Tuning::waiting_vertices).
#include "support/pair_harness.hpp"

#include <doctest/doctest.h>

namespace
{

using tests::at;
using tests::PairHarness;
using tests::turned;
using voile::engine::take;

constexpr uint32_t k_never_enough = 1u << 30;

// Lists of two pairs leave little room, so that vertices often want new ones.
voile::SolverOptions with_waiting(uint32_t vertices)
{
    voile::SolverOptions options;
    options.tuning.pair_capacity = 2;
    options.tuning.waiting_vertices = vertices;
    return options;
}

// Sheets that fall on each other and on the ground.
void add_stack(PairHarness& harness)
{
    (void)take(harness.solver.add_collider(voile::PlaneCollider{}));
    for (int i = 0; i < 4; ++i)
    {
        const auto level = static_cast<float>(i);
        voile::GridCloth sheet = tests::pair_sheet(9, 9, 0.02f);
        sheet.transform = at({0, 0.02f + 0.015f * level, 0}) * turned(0.4f * level, {0.1f, 1, 0.05f});
        harness.add(sheet);
    }
    harness.upload();
}

struct Fall
{
    uint64_t intersections = 0;
    uint64_t searches = 0;
};

Fall fall(uint32_t waiting_vertices)
{
    PairHarness harness(with_waiting(waiting_vertices));
    add_stack(harness);
    Fall result;
    for (int frame = 0; frame < 12; ++frame)
    {
        harness.step({.duration = 1.f / 60});
        result.searches += harness.statistics().pair_searches;
        if (frame % 6 == 5)
            result.intersections += harness.intersections();
    }
    CHECK(harness.statistics().forced_pairs == 0);
    return result;
}

} // namespace

TEST_CASE("sheets whose vertices wait for a search do not intersect, and search less often")
{
    const Fall hasty = fall(1);
    const Fall patient = fall(k_never_enough);
    CHECK(hasty.intersections == 0);
    CHECK(patient.intersections == 0);
    CAPTURE(hasty.searches);
    CAPTURE(patient.searches);
    CHECK(static_cast<double>(patient.searches) < 0.95 * static_cast<double>(hasty.searches)); // 95 and 118
}

TEST_CASE("cloth that a moving collider drives does not wait")
{
    std::vector<glm::vec4> ends[2];
    uint64_t searches[2] = {};
    for (size_t run = 0; run < 2; ++run)
    {
        PairHarness harness(with_waiting(run == 0 ? 1 : k_never_enough));
        const voile::ColliderId ball = take(harness.solver.add_collider(voile::SphereCollider{.radius = 0.05f}));
        for (const float height : {0.06f, 0.075f})
        {
            voile::GridCloth sheet = tests::pair_sheet(9, 9, 0.02f);
            sheet.transform = at({0, height, 0}) * turned(10 * height, {0, 1, 0});
            harness.add(sheet);
        }
        harness.upload();
        for (int frame = 1; frame <= 4; ++frame)
        {
            take(harness.solver.move_collider(ball, at({0, 0.03f * static_cast<float>(frame), 0})));
            harness.step({.duration = 1.f / 60});
            searches[run] += harness.statistics().pair_searches;
        }
        ends[run] = harness.positions(harness.cloths[1]);
    }
    CHECK(searches[0] > 30); // vertices want lists
    CHECK(searches[0] == searches[1]);
    CHECK(ends[0] == ends[1]);
}

TEST_CASE("searches are counted: one if nothing moves or all sleeps, none of disabled cloth or without self_collision")
{
    constexpr voile::Step k_nothing_happens{.duration = 0.1f, .gravity = {0, 0, 0}, .air_density = 0};
    PairHarness harness;
    voile::GridCloth grid = tests::pair_sheet(4, 4, 0.02f);
    grid.sleep_speed = 0.1f;
    const voile::ClothId sheet = harness.add(grid);
    harness.upload();
    harness.step(k_nothing_happens);
    CHECK(harness.statistics().pair_searches == 1);
    harness.step(k_nothing_happens, 7);
    CHECK(harness.statistics().sleeping_cloths == 1);
    CHECK(harness.statistics().pair_searches == 1);
    harness.step({.duration = 0.1f});
    CHECK(harness.statistics().pair_searches > 1);  // it falls until the time of the lists ends
    CHECK(harness.statistics().pair_searches < 34); // one per 3 ms
    take(harness.solver.set_enabled(sheet, false));
    harness.step(k_nothing_happens);
    CHECK(harness.statistics().pair_searches == 0);
    take(harness.solver.remove(sheet));
    grid.self_collision = false;
    harness.add(grid);
    harness.upload();
    harness.step(k_nothing_happens);
    CHECK(harness.statistics().pair_searches == 0);
}

// Their time was 3 ms, so each of these passes, 1.5 and 2.1 ms apart, made them again.
TEST_CASE("lists of pairs serve four passes in a few substeps per frame, and cloth falls as far as a point")
{
    for (const uint32_t substeps : {8u, 11u})
        for (const auto integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
        {
            CAPTURE(substeps);
            PairHarness harness;
            voile::GridCloth sheet = tests::pair_sheet(12, 12, 0.02f);
            sheet.integrator = integrator;
            sheet.velocity = {3, 0, 0};
            harness.add(sheet);
            harness.upload();
            voile::Step step{.duration = 1.f / 60, .air_density = 0};
            step.substeps = substeps;
            const float start = harness.positions(harness.cloths[0])[0].y;
            harness.step(step, 6);
            CHECK(harness.statistics().pair_searches == (substeps + 3) / 4);
            constexpr float k_time = 0.1f;
            CHECK(start - harness.positions(harness.cloths[0])[0].y ==
                  doctest::Approx(0.5f * 9.81f * k_time * k_time).epsilon(1e-5));
        }
}
