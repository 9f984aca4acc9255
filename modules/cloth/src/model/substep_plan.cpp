#include "model/substep_plan.hpp"

#include <algorithm>
#include <cmath>

namespace voile
{

namespace
{

// Sorted by needed substeps, each number once; `vertices` is the sum of all entries up to this one.
using Needs = std::span<const SubstepNeed>;

uint32_t reduced(uint32_t needed, double fraction)
{
    return std::max(1u, static_cast<uint32_t>(std::ceil(fraction * needed - 1e-9)));
}

// The most substeps of a cloth. If a cloth needs more than the limit, a number little below it that all levels divide,
// unless that would take substeps from a cloth that needs no more than the limit.
uint32_t most_substeps_of(std::span<const SubstepNeed> cloths, uint32_t limit)
{
    const uint32_t divisible = limit >> (VOILE_SUBSTEP_LEVELS - 1) << (VOILE_SUBSTEP_LEVELS - 1);
    const auto needs_more = [&](const SubstepNeed& need) { return need.substeps > limit; };
    const auto between = [&](const SubstepNeed& need) { return need.substeps > divisible && need.substeps <= limit; };
    const bool rounds = limit - divisible <= limit / 64 && std::ranges::any_of(cloths, needs_more) &&
                        std::ranges::none_of(cloths, between);
    return rounds ? divisible : limit;
}

Needs accumulate(std::span<SubstepNeed> needs, uint32_t most)
{
    for (SubstepNeed& need : needs)
        need.substeps = std::min(need.substeps, most);
    std::ranges::sort(needs, {}, &SubstepNeed::substeps);
    size_t last = 0;
    for (size_t i = 1; i < needs.size(); ++i)
    {
        const uint64_t sum = needs[last].vertices + needs[i].vertices;
        last += needs[i].substeps == needs[last].substeps ? 0 : 1;
        needs[last] = {needs[i].substeps, sum};
    }
    return needs.first(last + 1);
}

struct Work
{
    uint64_t vertex_substeps = 0;
    uint64_t substeps = 0; // of all levels that are used
};

Work work_of(const SubstepPlan& plan, Needs needs)
{
    Work work;
    uint64_t above = 0; // vertices of the levels with fewer substeps
    for (uint32_t level = plan.levels; level-- > 0;)
    {
        const uint32_t substeps = plan.substeps_of(level);
        const auto fits = [&](const SubstepNeed& need) { return reduced(need.substeps, plan.fraction) <= substeps; };
        const auto end = level == 0 ? needs.end() : std::ranges::partition_point(needs, fits);
        const uint64_t below = end == needs.begin() ? 0 : std::prev(end)->vertices;
        if (below == above)
            continue;
        work.vertex_substeps += (below - above) * substeps;
        work.substeps += substeps;
        above = below;
    }
    return work;
}

uint64_t cost_of(const SubstepPlan& plan, Needs needs, const SubstepLimits& limits)
{
    const Work work = work_of(plan, needs);
    return work.vertex_substeps + limits.dispatch_vertices * work.substeps;
}

// The cheapest plan in which each cloth takes `fraction` of the substeps that it needs, or more. With more substeps of
// level 0 than any cloth needs, another cloth may fit a level above.
SubstepPlan cheapest_plan(Needs needs, double fraction, uint32_t most, const SubstepLimits& limits)
{
    constexpr uint32_t k_tries = 32; // per number of levels
    const uint32_t least_substeps = reduced(needs.back().substeps, fraction);
    const uint32_t most_substeps = std::min(least_substeps + least_substeps / 4, most);
    SubstepPlan best{.substeps = least_substeps, .levels = 1, .fraction = fraction, .most = most};
    if (reduced(needs.front().substeps, fraction) > most_substeps / 2)
        return best; // no cloth fits a level above
    uint64_t least = cost_of(best, needs, limits);
    for (uint32_t levels = 2; levels <= limits.levels; ++levels)
    {
        const uint32_t multiple = 1u << (levels - 1);
        const uint32_t first = (least_substeps + multiple - 1) / multiple * multiple;
        const uint32_t last = std::min(most_substeps, first + (k_tries - 1) * multiple);
        for (uint32_t substeps = first; substeps <= last; substeps += multiple)
        {
            const SubstepPlan plan{.substeps = substeps, .levels = levels, .fraction = fraction, .most = most};
            if (const uint64_t cost = cost_of(plan, needs, limits); cost < least)
            {
                best = plan;
                least = cost;
            }
        }
    }
    return best;
}

} // namespace

uint32_t SubstepPlan::level_of(uint32_t needed) const
{
    const uint32_t enough = reduced(std::min(needed, most), fraction);
    uint32_t level = 0;
    while (level + 1 < levels && substeps_of(level + 1) >= enough)
        ++level;
    return level;
}

SubstepPlan plan_substeps(std::span<SubstepNeed> cloths, const SubstepLimits& limits)
{
    if (cloths.empty())
        return uniform_plan(1);
    const uint32_t most = most_substeps_of(cloths, limits.substeps);
    const Needs needs = accumulate(cloths, most);
    const SubstepPlan whole = cheapest_plan(needs, 1, most, limits);
    const auto within = [&](const SubstepPlan& plan)
    { return limits.vertex_substeps == 0 || work_of(plan, needs).vertex_substeps <= limits.vertex_substeps; };
    if (within(whole))
        return whole;
    double low = 0;
    double high = 1;
    SubstepPlan best = cheapest_plan(needs, low, most, limits);
    for (int i = 0; i < 20; ++i)
    {
        const double middle = 0.5 * (low + high);
        const SubstepPlan plan = cheapest_plan(needs, middle, most, limits);
        const bool fits = within(plan);
        (fits ? low : high) = middle;
        best = fits ? plan : best;
    }
    return best;
}

} // namespace voile
