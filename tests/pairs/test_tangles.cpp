// Cloth that intersects when a step starts is pulled apart.
#include "support/pair_harness.hpp"
#include "support/random_cloths.hpp"

#include "shared/pair_layout.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>

namespace
{

using tests::at;
using tests::PairHarness;
using tests::turned;
using voile::engine::take;

constexpr voile::Step k_weightless{.duration = 1.f / 60, .gravity = {0, 0, 0}};

void move_vertices(PairHarness& harness, voile::ClothId cloth, const std::vector<glm::vec4>& positions)
{
    const voile::VertexStreams streams = harness.solver.vertices(cloth);
    harness.write(streams.positions, streams.offset, positions);
}

// A sheet, and another one at a pose that intersects it.
void add_two(PairHarness& harness, const glm::mat4& pose)
{
    voile::GridCloth sheet = tests::pair_sheet(14, 14, 0.023f);
    harness.add(sheet);
    sheet.transform = pose;
    harness.add(sheet);
    harness.upload();
}

struct Pulled
{
    uint64_t before = 0;
    int frames = 0;    // until no pair intersects; -1: never
    float fastest = 0; // m/s
};

// At most so many frames, and two periods after no pair intersects.
Pulled pull_apart(PairHarness& harness, int frames)
{
    constexpr int k_period = 5;
    Pulled result{harness.intersections(), -1, 0};
    for (int i = k_period; i <= frames && (result.frames < 0 || i <= result.frames + 2 * k_period); i += k_period)
    {
        harness.step(k_weightless, k_period);
        for (const voile::ClothId cloth : harness.cloths)
            for (const glm::vec4& v : harness.velocities(cloth))
                result.fastest = std::max(result.fastest, glm::length(glm::vec3(v)));
        const bool apart = harness.intersections() == 0;
        if (!apart)
            result.frames = -1; // again
        else if (result.frames < 0)
            result.frames = i;
    }
    return result;
}

const glm::mat4 k_corner = at({0.01f, 0.16f, 0.003f}) * turned(1.57f, {1, 0, 0}) * turned(0.785f, {0, 1, 0});
const glm::mat4 k_half = at({0.2f, 0, 0.013f}) * turned(0.8f, {1, 0.2f, 0});
const glm::mat4 k_across = at({0.01f, 0, 0.013f}) * turned(0.8f, {1, 0.2f, 0});

// Smooth waves in random directions.
void crumple(PairHarness& harness, voile::ClothId cloth, tests::Draw& draw)
{
    std::vector<glm::vec4> positions = harness.positions(cloth);
    const glm::vec3 f = draw.uniform(0, 40) * draw.direction();
    const glm::vec3 g = draw.uniform(0, 40) * draw.direction();
    const float amount = draw.uniform(0, 0.06f);
    for (glm::vec4& p : positions)
    {
        const glm::vec3 x(p);
        p += amount * glm::vec4(std::sin(dot(f, x)), std::sin(dot(g, x) + 1), std::sin(dot(f + g, x) + 2), 0);
    }
    move_vertices(harness, cloth, positions);
}

} // namespace

TEST_CASE("sheets that start in each other are pulled apart, and gain little speed")
{
    for (const glm::mat4& pose : {k_corner, k_half, k_across})
    {
        PairHarness harness;
        add_two(harness, pose);
        const Pulled pulled = pull_apart(harness, 35);
        CHECK(pulled.before >= 20);
        CHECK(pulled.frames > 0);
        CHECK(pulled.frames <= 30);
        CHECK(pulled.fastest < 1.2f);
        CHECK(harness.statistics().tangled_pairs == 0);
    }
}

TEST_CASE("without untangling, sheets that start in each other stay so, and nothing is counted")
{
    voile::SolverOptions options;
    options.untangling = false;
    PairHarness harness(options);
    add_two(harness, k_half);
    const Pulled pulled = pull_apart(harness, 10);
    CHECK(pulled.before >= 20);
    CHECK(pulled.frames == -1);
    CHECK(harness.statistics().tangled_pairs == 0);
}

TEST_CASE("tangled pairs are counted as they are when the step starts, within a cloth and between cloths")
{
    PairHarness harness;
    add_two(harness, k_half);
    tests::Draw draw(3);
    crumple(harness, harness.cloths[1], draw);
    uint64_t most = 0;
    for (int i = 0; i < 6; ++i)
    {
        const uint64_t exact = harness.intersections();
        most = std::max(most, exact);
        harness.step(k_weightless);
        CHECK(harness.statistics().tangled_pairs == exact);
    }
    CHECK(most > 20);
}

TEST_CASE("what the host changes is searched for tangles in the next step")
{
    const auto enable = [](voile::Solver& solver, voile::ClothId cloth, bool meets)
    { take(solver.set_enabled(cloth, meets)); };
    const auto layer = [](voile::Solver& solver, voile::ClothId cloth, bool meets)
    { take(solver.set_layers(cloth, meets ? 1 : 2)); };
    for (const auto& change : {std::function(enable), std::function(layer)})
    {
        PairHarness harness;
        add_two(harness, k_half);
        change(harness.solver, harness.cloths[1], false);
        harness.step(k_weightless, 3);
        CHECK(harness.statistics().tangled_pairs == 0);
        change(harness.solver, harness.cloths[1], true);
        const uint64_t exact = harness.intersections();
        CHECK(exact > 10);
        harness.step(k_weightless);
        CHECK(harness.statistics().tangled_pairs == exact);
    }
}

TEST_CASE("tangles of which the solver cannot know are found within eight steps")
{
    PairHarness harness;
    add_two(harness, at({0, 1, 0}) * k_half);
    harness.step(k_weightless, 3);
    std::vector<glm::vec4> positions = harness.positions(harness.cloths[1]);
    for (glm::vec4& p : positions)
        p.y -= 1;
    move_vertices(harness, harness.cloths[1], positions);
    uint32_t steps = 0;
    while (harness.statistics().tangled_pairs == 0 && steps++ < VOILE_TANGLE_PARTS)
        harness.step(k_weightless);
    CHECK(harness.statistics().tangled_pairs > 0);
    const uint64_t exact = harness.intersections();
    CHECK(exact > 10);
    harness.step(k_weightless);
    CHECK(harness.statistics().tangled_pairs == exact);
    CHECK(pull_apart(harness, 35).frames > 0);
}

TEST_CASE("cloths of different layers are not pulled apart, nor one that does not collide with itself")
{
    for (const bool layers : {false, true})
    {
        PairHarness harness;
        voile::GridCloth sheet = tests::pair_sheet(8, 8, 0.02f);
        harness.add(sheet);
        sheet.transform = turned(0.8f, {1, 0.2f, 0});
        (layers ? sheet.layers : sheet.columns) = layers ? 2 : 8;
        sheet.self_collision = layers;
        harness.add(sheet);
        harness.upload();
        CHECK(harness.intersections() > 10);
        harness.step(k_weightless, 5);
        CHECK(harness.statistics().tangled_pairs == 0);
        CHECK(harness.statistics().kinetic_energy < 1e-9f);
    }
}

TEST_CASE("a sheet that meets two sheets in each other stays free of intersections")
{
    for (const float speed : {3.f, 0.5f})
    {
        PairHarness harness;
        voile::GridCloth sheet = tests::pair_sheet(12, 12, 0.027f);
        harness.add(sheet);
        sheet.transform = at({0.003f, 0, 0.02f}) * turned(0.2f, {1, 0.2f, 0});
        harness.add(sheet);
        sheet.transform = at({0, speed > 1 ? 0.12f : 0.05f, 0});
        sheet.velocity = {0, -speed, 0};
        harness.add(sheet);
        harness.upload();
        REQUIRE(harness.intersections() > 20);
        uint64_t of_third = 0;
        for (int i = 0; i < 12; ++i)
        {
            harness.step(k_weightless);
            const tests::ExactMesh third = harness.exact(harness.cloths[2]);
            of_third += count_pairs(third, third);
            for (size_t other = 0; other < 2; ++other)
                of_third += count_pairs_both_ways(harness.exact(harness.cloths[other]), third);
        }
        CHECK(of_third == 0);
    }
}

TEST_CASE("random crumples in and through each other come free")
{
    uint64_t before = 0;
    for (uint32_t seed = 0; seed < 2; ++seed)
    {
        tests::Draw draw(seed);
        PairHarness harness;
        for (int i = 0; i < 2; ++i)
        {
            voile::GridCloth sheet = tests::pair_sheet(12, 12, 0.025f);
            sheet.material = i == 0 ? voile::silk() : voile::cotton();
            sheet.transform =
                at(draw.uniform(0, 0.1f) * draw.direction()) * turned(draw.uniform(-1.5f, 1.5f), draw.direction());
            harness.add(sheet);
        }
        harness.upload();
        for (const voile::ClothId cloth : harness.cloths)
            crumple(harness, cloth, draw);
        const Pulled pulled = pull_apart(harness, 60);
        CAPTURE(seed);
        before += pulled.before;
        CHECK(pulled.frames >= 0);
    }
    CHECK(before > 50);
}

TEST_CASE("sheets are pulled apart equally in each run")
{
    const auto run = []
    {
        PairHarness harness;
        add_two(harness, k_across);
        harness.step(k_weightless, 12);
        return harness.positions(harness.cloths[1]);
    };
    CHECK(run() == run());
}
