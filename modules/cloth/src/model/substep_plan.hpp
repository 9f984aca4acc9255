// SubstepPlan: how many substeps each cloth takes in a step.
//
// Cloths are grouped by level. A cloth of level k takes one substep where one of level 0 takes 2^k, so all
// levels end each of the longest substeps at the same time. The number of substeps and the levels are those with the
// least work.
#pragma once

#include "shared/step_layout.h"

#include <array>
#include <cstdint>
#include <span>

namespace voile
{

// Of one active cloth.
struct SubstepNeed
{
    uint32_t substeps = 1; // with which it keeps all of its stiffness
    uint64_t vertices = 0;
};

struct SubstepLimits
{
    uint32_t substeps = 0;        // of each cloth, at most
    uint64_t vertex_substeps = 0; // sum of vertices times substeps, at most; 0: no limit
    uint64_t dispatch_vertices =
        0; // vertices whose substep takes as long as the dispatches of a substep without vertices
    uint32_t levels = VOILE_SUBSTEP_LEVELS; // at most
};

// The passes over pairs of near primitives of cloths: before the first substep of level 0, and then every `period`
// substeps. If that is even, they come after odd numbers of substeps, where contact that two substeps share has ended.
struct PairSchedule
{
    uint32_t period = 1;

    [[nodiscard]] uint32_t second() const { return period % 2 == 0 ? 1 : period; }
    [[nodiscard]] bool begins(uint32_t substep) const
    {
        return substep == 0 || (substep >= second() && (substep - second()) % period == 0);
    }
    // The substep before which the last pass was. A pass before this one counts.
    [[nodiscard]] uint32_t last(uint32_t substep) const
    {
        return substep < second() ? 0 : substep - (substep - second()) % period;
    }
    [[nodiscard]] uint32_t next(uint32_t substep) const
    {
        return substep < second() ? second() : last(substep) + period;
    }
    // Passes before that substep.
    [[nodiscard]] uint32_t passes(uint32_t substep) const
    {
        if (substep == 0)
            return 0;
        return substep <= second() ? 1 : (substep - second() - 1) / period + 2;
    }
};

struct SubstepPlan
{
    uint32_t substeps = 1; // of level 0
    PairSchedule pairs{};
    uint32_t levels = 1;        // that may be used
    double fraction = 1;        // of the needed substeps that the budget leaves, 0..1
    uint32_t most = UINT32_MAX; // of a cloth: a need above it counts as this

    // The level of a cloth that needs so many substeps.
    [[nodiscard]] uint32_t level_of(uint32_t needed) const;
    [[nodiscard]] uint32_t substeps_of(uint32_t level) const { return substeps >> level; }
};

// All cloths take the same number of substeps.
inline SubstepPlan uniform_plan(uint32_t substeps)
{
    return {.substeps = substeps};
}

// Overwrites `cloths`; does not allocate. A budget that is too small for one substep per cloth is exceeded.
SubstepPlan plan_substeps(std::span<SubstepNeed> cloths, const SubstepLimits& limits);

} // namespace voile
