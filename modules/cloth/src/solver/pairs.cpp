#include "solver/pairs.hpp"

#include "geometry/padded_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace voile
{

namespace
{

// s: contact between cloths needs no more passes than this has in a step.
constexpr float k_interval = 0.4e-3f;

// A collider pushes a vertex by this part of its reach from one pass to the next at most.
constexpr float k_pushed_part = 0.3f;

// That share the pairs of a vertex. On CPU devices one.
uint32_t threads_per_vertex(const Tuning& tuning)
{
    constexpr uint32_t k_threads = 8;
    return tuning.feature_threads == 1 ? 1 : std::min(k_threads, tuning.workgroup_size);
}

// Below, a search waits for its slowest threads; above, for the work of all, which grows with threads that share it.
constexpr uint32_t k_large = 131072; // vertices

// That share the search of a vertex.
uint32_t lanes_per_search(const Tuning& tuning, uint32_t vertices)
{
    const bool few = tuning.feature_threads == 1 || vertices >= k_large;
    return std::min<uint32_t>(few ? VOILE_PAIR_LANES / 2 : VOILE_PAIR_LANES, tuning.workgroup_size);
}

// That share the search for the candidates of a vertex.
uint32_t candidate_lanes(const Tuning& tuning, uint32_t vertices)
{
    const bool one = tuning.feature_threads == 1 || vertices >= k_large;
    return one ? 1 : std::min<uint32_t>(VOILE_PAIR_LEAF, tuning.workgroup_size);
}

// The most candidates of a vertex that are sifted. A small cloth waits for its slowest thread, so that a pass more
// gains nothing (bench/NOTES.md). On CPU devices threads do not hold up each other.
uint32_t most_sifted(const Tuning& tuning, uint32_t vertices)
{
    constexpr uint32_t k_most = 24;
    constexpr uint32_t k_many = 32768;
    if (tuning.sifting_vertices == 0 && tuning.feature_threads == 1)
        return 0;
    return vertices >= (tuning.sifting_vertices > 0 ? tuning.sifting_vertices : k_many) ? k_most : 0;
}

// Of vertices that want new lists of pairs; fewer wait.
uint32_t enough_vertices(const Tuning& tuning, uint32_t vertices)
{
    constexpr uint32_t k_vertices_of_one = 1024;
    return tuning.waiting_vertices > 0 ? tuning.waiting_vertices : std::max(vertices / k_vertices_of_one, 1u);
}

// Of a pass over pairs whose search may find the first ones.
uint32_t least_groups(const Tuning& tuning)
{
    constexpr uint32_t k_groups = 64; // take as long as one
    return tuning.feature_threads == 1 ? 1 : k_groups;
}

// Even, unless it is 1, so that two substeps can share contact.
uint32_t usual_period(float substeps)
{
    return substeps < 1.5f ? 1 : 2 * std::max<uint32_t>(1, static_cast<uint32_t>(std::lround(0.5f * substeps)));
}

VkDeviceSize offset_of(uint32_t dispatch)
{
    return dispatch * sizeof(shared::PairDispatch);
}

} // namespace

uint32_t substeps_per_pass(const Solver::State& solver, const Step& step, uint32_t substeps, float farthest)
{
    const float substep = step.duration / static_cast<float>(substeps);
    const uint32_t usual = usual_period(k_interval / substep);
    const float pushed = k_pushed_part * solver.passes.pair_reach * static_cast<float>(substeps);
    const uint32_t period =
        pushed < farthest * static_cast<float>(usual) ? static_cast<uint32_t>(pushed / farthest) : usual;
    return std::max(1u, period);
}

float time_of_lists(float interval)
{
    return std::max(VOILE_PAIR_SWEEP_TIME, VOILE_PAIR_LISTED_PASSES * interval);
}

float fall_of_pairs(const Vec3& gravity, float list_time)
{
    return VOILE_PAIR_MOST_FALL * list_time * list_time * glm::length(gravity);
}

PairRecorder::PairRecorder(gpu::Recorder& recorder, const Solver::State& solver, const ActiveLists& lists,
                           const SubstepPlan& plan)
    : recorder_(recorder), solver_(solver), threads_(lists.patch_count() * solver.options.tuning.workgroup_size),
      leaves_((solver.device->pair_places + VOILE_PAIR_LEAF - 1) / VOILE_PAIR_LEAF), substeps_(plan.substeps),
      schedule_(plan.pairs)
{
}

void PairRecorder::record(uint32_t substep, bool in_stage_b)
{
    if (substep == 0)
    {
        write_sizes();
        if (solver_.options.untangling)
            find_tangles();
    }
    publish_dispatch(recorder_);
    const size_t from = in_stage_b ? 1 : 0;
    const auto& sets = solver_.device->sets;
    shared::PairPush push{};
    push.substeps = static_cast<float>(std::min(schedule_.next(substep), substeps_) - substep);
    push.places = solver_.device->pair_places;
    push.leaves = leaves_;
    push.pass = schedule_.passes(substep);
    push.vertices = static_cast<uint32_t>(solver_.device->capacities.pair_vertices);
    push.threads = threads_per_vertex(solver_.options.tuning);
    push.lanes = lanes_per_search(solver_.options.tuning, push.places);
    push.candidate_lanes = candidate_lanes(solver_.options.tuning, push.places);
    push.capacity = solver_.options.tuning.pair_capacity;
    push.cloths = solver_.device->pair_cloths.end;
    push.colliders = solver_.passes.colliders;
    push.sifted = most_sifted(solver_.options.tuning, push.places);
    push.lag = substep > 0 ? 0.5f : 0;
    push.least_groups = least_groups(solver_.options.tuning);
    find(push, from);
    const bool first = push.pass == 0;
    if (first)
        publish_dispatch(recorder_);
    const DeviceState& device = *solver_.device;
    const VkBuffer sizes = device[first ? buffer::pair_passes : buffer::next_pair_pass].handle();
    recorder_.dispatch_indirect(solver_.kernels.meet_pairs, sets.meet_pairs[from], sizes, offset_of(VOILE_PAIR_MEET),
                                push);
    recorder_.dispatch_indirect(solver_.kernels.respond_to_pairs, sets.respond_to_pairs[from], sizes,
                                offset_of(VOILE_PAIR_RESPOND), push);
}

// The first pass of a step wants new lists: the host may have moved anything.
void PairRecorder::write_sizes()
{
    const DeviceState& device = *solver_.device;
    const RefitKernels& refit = solver_.kernels.refit;
    const uint32_t group = solver_.options.tuning.workgroup_size;
    std::array<shared::PairDispatch, VOILE_PAIR_SEARCHES> sizes{};
    shared::RefitPush fold{{}, VOILE_TREE_IN_PUSH, 0, 0};
    fold.bottom = padded_levels(leaves_);
    sizes[VOILE_PAIR_OF_LEAVES] = {((uint32_t{VOILE_PAIR_LEAF} << fold.bottom) + group - 1) / group, 1, 1, 0};
    const uint32_t places = device.pair_places;
    sizes[VOILE_PAIR_OF_PLACES] = {(places + group - 1) / group, 1, 1, 0};
    const uint32_t candidate_threads = places * candidate_lanes(solver_.options.tuning, places);
    sizes[VOILE_PAIR_OF_CANDIDATES] = {(candidate_threads + group - 1) / group, 1, 1, 0};
    sizes[VOILE_PAIR_OF_CLOTHS] = {1, 1, 1, 0};
    const uint32_t search_threads = places * lanes_per_search(solver_.options.tuning, places);
    sizes[VOILE_PAIR_OF_LANES] = {(search_threads + group - 1) / group, 1, 1, 0};
    sizes[VOILE_PAIR_OF_PATCHES] = {threads_ / group, 1, 1, 0};
    for (uint32_t i = VOILE_PAIR_FOLDS; fold.bottom > 0; ++i)
        sizes[i] = {next_fold(refit, fold).groups, 1, 1, 0};
    sizes[VOILE_PAIR_MOST_URGENCY].entries = enough_vertices(solver_.options.tuning, places);
    write_dispatches(recorder_, device[buffer::pair_bounds].handle(), 0,
                     std::as_bytes(std::span(sizes).first(VOILE_PAIR_CROWDED)),
                     std::array{device[buffer::tangles].handle(), device[buffer::pair_islands].handle()});
}

// Where the host, pins or colliders have put cloth into cloth.
void PairRecorder::find_tangles()
{
    const DeviceState& device = *solver_.device;
    record_refit(recorder_, solver_.kernels.refit, device.sets.refit_cloths, device.tree_counts);
    record_over_trees(recorder_, solver_, solver_.kernels.find_tangles, device.sets.find_tangles);
}

void PairRecorder::find(const shared::PairPush& push, size_t from)
{
    const auto& sets = solver_.device->sets;
    const VkBuffer sizes = (*solver_.device)[buffer::pair_bounds].handle();
    recorder_.dispatch_indirect(solver_.kernels.pair_means, sets.pair_means[from], sizes,
                                offset_of(VOILE_PAIR_OF_PATCHES), push);
    recorder_.dispatch_indirect(solver_.kernels.pair_clear, sets.pair_clear[from], sizes,
                                offset_of(VOILE_PAIR_OF_PATCHES), push);
    if (push.cloths > 1 || is_cpu(solver_.context.device_type)) // else pair_clear.comp finds the frame
        recorder_.dispatch_indirect(solver_.kernels.find_islands, sets.find_islands, sizes,
                                    offset_of(VOILE_PAIR_OF_CLOTHS), push);
    recorder_.dispatch_indirect(solver_.kernels.pair_sweeps, sets.pair_sweeps[from], sizes,
                                offset_of(VOILE_PAIR_OF_PLACES), push);
    recorder_.dispatch_indirect(solver_.kernels.pair_boxes, sets.pair_boxes, sizes, offset_of(VOILE_PAIR_OF_LEAVES),
                                push);
    shared::RefitPush fold{{}, VOILE_TREE_IN_PUSH, 0, 0};
    fold.bottom = padded_levels(leaves_);
    for (uint32_t i = VOILE_PAIR_FOLDS; fold.bottom > 0; ++i)
        recorder_.dispatch_indirect(solver_.kernels.refit.levels, sets.pair_refit, sizes, offset_of(i),
                                    next_fold(solver_.kernels.refit, fold).push);
    recorder_.dispatch_indirect(solver_.kernels.find_candidates, sets.find_candidates, sizes,
                                offset_of(VOILE_PAIR_OF_CANDIDATES), push);
    // A small cloth has fewer workgroups than it takes to publish how many vertices search.
    const bool sifts = push.sifted > 0;
    const VkBuffer passes = (*solver_.device)[buffer::pair_passes].handle();
    if (sifts)
    {
        publish_dispatch(recorder_);
        recorder_.dispatch_indirect(solver_.kernels.sift_candidates, sets.sift_candidates, passes,
                                    offset_of(VOILE_PAIR_SIFT), push);
        publish_dispatch(recorder_);
    }
    const VkBuffer searching = sifts ? passes : sizes;
    const VkDeviceSize searches = offset_of(sifts ? VOILE_PAIR_FIND : VOILE_PAIR_OF_LANES);
    recorder_.dispatch_indirect(solver_.kernels.find_pairs, sets.find_pairs, searching, searches, push);
    recorder_.dispatch_indirect(solver_.kernels.match_pairs, sets.match_pairs, searching, searches, push);
    recorder_.dispatch_indirect(solver_.kernels.index_pairs, sets.index_pairs[from], sizes,
                                offset_of(VOILE_PAIR_OF_PATCHES), push);
}

} // namespace voile
