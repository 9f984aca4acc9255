// How many substeps each cloth takes: what each needs, at the least cost, within a budget.
#include "model/substep_plan.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace
{

using voile::plan_substeps;
using voile::SubstepLimits;
using voile::SubstepNeed;
using voile::SubstepPlan;

SubstepPlan plan_of(std::vector<SubstepNeed> needs, const SubstepLimits& limits)
{
    return plan_substeps(needs, limits);
}

uint32_t used(const SubstepPlan& plan, uint32_t needed)
{
    return plan.substeps_of(plan.level_of(needed));
}

uint64_t vertex_substeps(const SubstepPlan& plan, const std::vector<SubstepNeed>& needs)
{
    uint64_t sum = 0;
    for (const SubstepNeed& need : needs)
        sum += need.vertices * used(plan, need.substeps);
    return sum;
}

// Vertices times substeps, and what the dispatches of each level that is used cost.
uint64_t cost(const SubstepPlan& plan, const std::vector<SubstepNeed>& needs, uint64_t dispatch_vertices)
{
    uint64_t sum = vertex_substeps(plan, needs);
    for (uint32_t level = 0; level < plan.levels; ++level)
        if (std::ranges::any_of(needs, [&](const SubstepNeed& n) { return plan.level_of(n.substeps) == level; }))
            sum += dispatch_vertices * plan.substeps_of(level);
    return sum;
}

std::vector<SubstepNeed> random_needs(std::mt19937& random)
{
    std::vector<SubstepNeed> needs(1 + random() % 12);
    for (SubstepNeed& need : needs)
        need = {static_cast<uint32_t>(1 + random() % (random() % 4 == 0 ? 500 : 40)), 1 + random() % 5000};
    return needs;
}

} // namespace

TEST_CASE("cloths with the same needs take the same substeps")
{
    const SubstepPlan plan = plan_of({{37, 100}, {37, 5}, {37, 1000000}}, {.substeps = 2000});
    CHECK(plan.levels == 1);
    CHECK(plan.substeps == 37);
    CHECK(plan_of({}, {.substeps = 2000}).substeps == 1);
    const SubstepPlan few = plan_of({{37, 100}, {5000, 100}}, {.substeps = 20});
    CHECK(few.substeps == 20);
    CHECK(used(few, 37) == 20);
}

TEST_CASE("every cloth takes what it needs, on levels that halve, for no more than one level would cost")
{
    std::mt19937 random(3);
    uint32_t several = 0;
    for (int round = 0; round < 2000; ++round)
    {
        const std::vector<SubstepNeed> needs = random_needs(random);
        const uint64_t dispatch = random() % 2 == 0 ? 0 : random() % 20000;
        const SubstepLimits limits{.substeps = 2000, .dispatch_vertices = dispatch};
        const SubstepPlan plan = plan_of(needs, limits);
        CAPTURE(round);
        REQUIRE(plan.levels >= 1);
        REQUIRE(plan.levels <= VOILE_SUBSTEP_LEVELS);
        CHECK(plan.substeps % (1u << (plan.levels - 1)) == 0);
        CHECK(plan.fraction == 1);
        for (const SubstepNeed& need : needs)
            CHECK(used(plan, need.substeps) >= need.substeps);
        const uint32_t most = std::ranges::max_element(needs, {}, &SubstepNeed::substeps)->substeps;
        CHECK(cost(plan, needs, dispatch) <= cost(voile::uniform_plan(most), needs, dispatch));
        several += plan.levels > 1 ? 1 : 0;

        // None of all plans in which every cloth has enough is cheaper.
        for (uint32_t levels = 1; levels <= VOILE_SUBSTEP_LEVELS; ++levels)
            for (uint32_t substeps = most; substeps <= most + most / 4 && substeps < most + 64; ++substeps)
                if (substeps % (1u << (levels - 1)) == 0 && substeps < most + 32 * (1u << (levels - 1)))
                    REQUIRE(cost(plan, needs, dispatch) <=
                            cost({.substeps = substeps, .levels = levels}, needs, dispatch));
    }
    CHECK(several > 500);
}

TEST_CASE("a small cloth has a level of its own only where the dispatches cost less than they save")
{
    const std::vector<SubstepNeed> needs{{400, 100}, {100, 5000}};
    CHECK(plan_of(needs, {.substeps = 2000, .dispatch_vertices = 100}).level_of(100) == 2);
    CHECK(plan_of(needs, {.substeps = 2000, .dispatch_vertices = 14000}).level_of(100) == 2); // 100 of 300 saved
    CHECK(plan_of(needs, {.substeps = 2000, .dispatch_vertices = 16000}).level_of(100) == 0);
}

TEST_CASE("a cloth that needs more than the limit takes nothing from the others")
{
    const std::vector<SubstepNeed> needs{{388, 546}, {22231, 108}, {24, 32}, {3194, 156}, {110, 231}};
    const SubstepLimits limits{.substeps = 1473, .dispatch_vertices = 256};
    const SubstepPlan unlimited = plan_of(needs, limits);
    CHECK(used(unlimited, 22231) == 1472);
    CHECK(used(unlimited, 24) <= 184); // levels, though 1473 is odd
    const uint64_t whole = vertex_substeps(unlimited, needs);
    CHECK(whole < 900000);
    SubstepLimits budget = limits;
    budget.vertex_substeps = whole;
    CHECK(plan_of(needs, budget).fraction == 1);
    budget.vertex_substeps = whole / 2;
    const SubstepPlan half = plan_of(needs, budget);
    CHECK(vertex_substeps(half, needs) <= whole / 2);
    CHECK(vertex_substeps(half, needs) > whole / 4);
    CHECK(half.fraction > 0.25);
    CHECK(used(plan_of({{1473, 10}, {5000, 10}}, limits), 1473) == 1473);
}

TEST_CASE("a budget takes the same fraction of every cloth's substeps, and no more than it must")
{
    std::mt19937 random(5);
    for (int round = 0; round < 1000; ++round)
    {
        const std::vector<SubstepNeed> needs = random_needs(random);
        uint64_t vertices = 0;
        for (const SubstepNeed& need : needs)
            vertices += need.vertices;
        const SubstepLimits unlimited{.substeps = 2000, .dispatch_vertices = 256};
        const uint64_t whole = vertex_substeps(plan_of(needs, unlimited), needs);
        SubstepLimits limits = unlimited;
        limits.vertex_substeps = std::max(vertices, random() % (whole + 1));
        const SubstepPlan plan = plan_of(needs, limits);
        CAPTURE(round);
        CHECK(vertex_substeps(plan, needs) <= limits.vertex_substeps);
        for (const SubstepNeed& need : needs)
            CHECK(used(plan, need.substeps) >= plan.fraction * need.substeps - 1e-6);
        if (limits.vertex_substeps >= whole)
            CHECK(plan.fraction == 1);
        // Rounding up to levels costs at most a factor of two beside one substep each.
        CHECK(2 * vertex_substeps(plan, needs) + 2 * vertices >= std::min(limits.vertex_substeps, whole));

        limits.vertex_substeps = 1; // too little even for one substep each
        CHECK(vertex_substeps(plan_of(needs, limits), needs) == vertices);
    }
}
