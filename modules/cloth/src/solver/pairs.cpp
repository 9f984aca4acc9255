#include "solver/pairs.hpp"

#include "geometry/padded_tree.hpp"

#include "shared/pair_layout.h"

#include <algorithm>
#include <cmath>

namespace voile
{

namespace
{

// s: contact between cloths needs no more passes than this has in a step.
constexpr float k_interval = 0.23e-3f;

// Lists expect vertices to move along their velocities by at most this part of the range of pairs: a sheet in motion
// would list neighbors otherwise.
constexpr float k_sweep_part = 0.6f;

uint32_t substeps_per_pass(float substep)
{
    return std::max(1u, static_cast<uint32_t>(std::lround(k_interval / substep)));
}

} // namespace

PairRecorder::PairRecorder(gpu::Recorder& recorder, const Solver::State& solver, const ActiveLists& lists,
                           const Step& step, uint32_t substeps)
    : recorder_(recorder), solver_(solver), threads_(lists.patch_count() * solver.options.tuning.workgroup_size),
      substeps_(substeps), period_(substeps_per_pass(step.duration / static_cast<float>(substeps))),
      h_(step.duration / static_cast<float>(substeps))
{
}

void PairRecorder::record(uint32_t substep, bool in_stage_b)
{
    const size_t from = in_stage_b ? 1 : 0;
    const auto& sets = solver_.device->sets;
    const uint32_t group = solver_.options.tuning.workgroup_size;
    shared::PairPush push{};
    push.interval = h_ * static_cast<float>(std::min(period_, substeps_ - substep));
    push.sweep_time = push.interval;
    push.longest_sweep = k_sweep_part * solver_.passes.pair_range;
    push.slots = solver_.device->pair_slots;
    find(push, from);
    recorder_.dispatch(solver_.kernels.pair_motions, sets.pair_motions[from], threads_, group, push);
    recorder_.dispatch(solver_.kernels.pair_responses, sets.pair_responses[from], threads_, group, push);
}

void PairRecorder::find(const shared::PairPush& push, size_t from)
{
    const auto& sets = solver_.device->sets;
    const uint32_t group = solver_.options.tuning.workgroup_size;
    const uint32_t slots = 1u << padded_levels(push.slots);
    recorder_.dispatch(solver_.kernels.pair_boxes, sets.pair_boxes[from], slots, group, push);
    record_fold(recorder_, solver_.kernels.refit, sets.pair_refit, push.slots);
    recorder_.dispatch(solver_.kernels.find_pairs, sets.find_pairs[from], threads_, group, push);
}

} // namespace voile
