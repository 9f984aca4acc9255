// The passes of one batch of cloths, as ARCHITECTURE.md lists them.
#include "solver/substeps.hpp"

#include "solver/pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace voile
{

namespace
{

// Of the labels around substeps.
constexpr std::array<const char*, VOILE_SUBSTEP_LEVELS> k_group_names = {
    "substep", "level 1, substep", "level 2, substep", "level 3, substep", "level 4, substep"};

// Lists last equally long within a step. Near queries read the state in its own buffers, not in stage B, so the number
// is even.
uint32_t substeps_per_list(float substep, uint32_t substeps, uint32_t contact_period)
{
    constexpr float k_time = 4.3e-3f; // s
    constexpr uint32_t k_least = 16;
    const uint32_t multiple = 2 * contact_period;
    const auto lists = static_cast<uint32_t>(std::ceil(static_cast<float>(substeps) * substep / k_time));
    const uint32_t each = std::max(k_least, substeps / std::max(lists, 1u));
    return (each + multiple - 1) / multiple * multiple;
}

// Between contact passes nothing holds what features have pushed. Within two substeps springs hardly respond; within
// more they would carry part of the load, and friction would lose its hold (bench/NOTES.md). Without features more
// would do, but then a cloth would move differently beside one that has features. Passes over pairs need all contact
// of the substeps before.
uint32_t substeps_per_contact(const Solver::State& solver, const PairSchedule& pairs, float substep)
{
    constexpr float k_rounding = 1e-3f;
    const float most = solver.passes.pairs && pairs.period % 2 == 1 ? 1.f : 2.f;
    const float interval = solver.options.tuning.contact_interval;
    return std::max(1u, static_cast<uint32_t>(std::min(interval / substep + k_rounding, most)));
}

// Per vertex, when features are listed. On CPU devices workgroups cost more than threads. Where there are many features
// they save some: the fewer vertices a workgroup has, the fewer features are near (bench/NOTES.md).
uint32_t listing_threads(const Solver::State& solver)
{
    constexpr uint32_t k_many_features = 2048;
    const Tuning& tuning = solver.options.tuning;
    if (tuning.listing_threads > 0)
        return tuning.listing_threads;
    const uint32_t on_cpus = solver.passes.features < k_many_features ? 2 : 4;
    return std::min(is_cpu(solver.context.device_type) ? on_cpus : 8, tuning.workgroup_size);
}

} // namespace

BatchRecorder::BatchRecorder(const StepContext& context, uint32_t batch)
    : context_(context), recorder_(context.recorder), solver_(context.solver), kernels_(solver_.kernels),
      device_(*solver_.device), lists_(context.lists.batches[batch]), batch_(batch), level_(batch_at(batch).level),
      verlet_(batch_at(batch).integrator == Integrator::verlet), group_(solver_.options.tuning.workgroup_size),
      substeps_(context.plan.substeps_of(level_)), h_(context.step.duration / static_cast<float>(substeps_)),
      has_contact_(context.passes.contact),
      // Rays along normals read the proposals of neighbors, which must not change meanwhile.
      swaps_(has_contact_ && solver_.options.tuning.contact_method == ContactMethod::nearest_point),
      contact_period_(swaps_ && verlet_ ? substeps_per_contact(solver_, context.plan.pairs, h_) : 1),
      list_period_(substeps_per_list(h_, substeps_, contact_period_))
{
}

void BatchRecorder::record_substep(uint32_t substep)
{
    const gpu::GroupScope group(recorder_, k_group_names[level_], substep + 1, substeps_);
    if (substep > 0 && substep % list_period_ == 0)
        record_near_colliders(substep);
    if (solver_.passes.features && substep % list_period_ == 0)
        record_near_features(substep);
    if (verlet_)
        record_verlet(make_push(static_cast<float>(substep)), substep);
    else
        record_rk4(substep);
    record_attachments(substep, 1);
    if (!contact_is_due(substep))
        return;
    if (solver_.passes.features)
        record_features(substep);
    record_contact(substep);
}

bool BatchRecorder::contact_is_due(uint32_t substep) const
{
    const uint32_t left = substeps_ - 1 - substep;
    return has_contact_ && (left == 0 || (left == 1 && ends_alone()) || substep % contact_period_ == 0);
}

BatchRecorder::ContactInterval BatchRecorder::contact_interval(uint32_t substep) const
{
    const bool alone = substep == 0 || substep >= substeps_ || (substep + 1 == substeps_ && ends_alone());
    const uint32_t count = alone ? 1 : (substep - 1) % contact_period_ + 1;
    return {substep + 1 - count, count};
}

bool BatchRecorder::keeps_contact_start(uint32_t substep) const
{
    return contact_period_ > 1 && in_stage_b(substep) != in_stage_b(substep + 1);
}

size_t BatchRecorder::proposal(uint32_t substep) const
{
    return (keeps_contact_start(substep) ? 2u : 0u) + (has_contact_ && in_stage_b(substep) ? 1u : 0u);
}

shared::StagePush BatchRecorder::make_push(float substeps) const
{
    shared::StagePush push{};
    push.substeps = of_level_0(1);
    if (context_.step.gust > 0)
    {
        push.gusts = 1;
        push.time = of_level_0(substeps);
    }
    return push;
}

bool BatchRecorder::shares_forces() const
{
    return lists_.meshes && lists_.patches.count * group_ <= solver_.options.tuning.sharing_vertices;
}

const gpu::Kernel& BatchRecorder::verlet_kernel() const
{
    return shares_forces() ? kernels_.verlet_shared : kernels_.verlet;
}

void BatchRecorder::record_rk4(uint32_t substep)
{
    constexpr float k_stage_times[] = {0, 0.5f, 0.5f, 1}; // of the substep
    const auto& sets = device_.sets.stages[has_contact_ && in_stage_b(substep) ? 1 : 0];
    const gpu::Kernel& stage_kernel = shares_forces() ? kernels_.stage_shared : kernels_.stage;
    for (uint32_t stage = 1; stage <= 4; ++stage)
    {
        shared::StagePush push = make_push(static_cast<float>(substep) + k_stage_times[stage - 1]);
        push.stage = stage;
        dispatch_awake(stage_kernel, stage == 4 && !has_contact_ ? device_.sets.last_stage_alone : sets[stage - 1],
                       push);
    }
}

void BatchRecorder::record_verlet(shared::StagePush push, uint32_t substep)
{
    push.planes = contact_period_ > 1 && substep > 0 ? 1 : 0;
    push.kick = of_level_0(substep == 0 ? 0.5f : 1);
    push.drift = of_level_0(1);
    VkDescriptorSet set = in_stage_b(substep) ? device_.sets.verlet_back : device_.sets.verlet_forth;
    if (substep == 0)
        set = device_.sets.verlet_first;
    dispatch_awake(verlet_kernel(), set, push);
}

void BatchRecorder::finish()
{
    if (!verlet_)
        return;
    shared::StagePush push = make_push(static_cast<float>(substeps_));
    push.kick = of_level_0(0.5f);
    dispatch_awake(verlet_kernel(), in_stage_b(substeps_) ? device_.sets.verlet_last_back : device_.sets.verlet_last,
                   push);
}

void BatchRecorder::record_attachments(uint32_t substep, uint32_t lasts)
{
    const size_t from = in_stage_b(substep) ? 1 : 0;
    shared::AttachmentPush push{lists_.attachments.first, lists_.attachments.count, of_level_0(lasts),
                                progress(substep + 1)};
    recorder_.dispatch(kernels_.attachments, device_.sets.proposed_attachments[from], push.count, group_, push);
    push.first = lists_.tethers.first;
    push.count = lists_.tethers.count;
    recorder_.dispatch(kernels_.tethers, device_.sets.proposed_tethers[from], push.count, group_, push);
}

// Passes after the last substep, for the strain limit, see all colliders at the step's end.
float BatchRecorder::progress(uint32_t substeps_done) const
{
    return substeps_done >= substeps_ ? 1 : static_cast<float>(substeps_done) / static_cast<float>(substeps_);
}

void BatchRecorder::record_near_colliders(uint32_t substep)
{
    if (device_.near_stride == 0)
        return;
    const uint32_t next = std::min(substep + list_period_, substeps_);
    shared::NearCollidersPush push{};
    push.substeps = of_level_0(next - substep);
    push.progress_per_substep = 1 / static_cast<float>(substeps_);
    push.colliders = solver_.passes.colliders;
    push.features = solver_.passes.features ? 1 : 0;
    push.near_stride = device_.near_stride;
    dispatch(kernels_.near_colliders, device_.sets.near_colliders, push);
}

BatchRecorder::ItemRange BatchRecorder::feature_items() const
{
    const uint64_t capacity = device_.capacities.feature_items;
    const auto before = [&](uint64_t patch)
    { return static_cast<uint32_t>(capacity * patch / std::max(context_.lists.patch_count(), 1u)); };
    const uint32_t first = before(lists_.patches.first);
    return {first, before(lists_.patches.first + lists_.patches.count) - first};
}

void BatchRecorder::record_near_features(uint32_t substep)
{
    const uint32_t word = batch_ * VOILE_FEATURE_DISPATCH_WORDS;
    // Each patch has that many workgroups.
    uint32_t lanes = listing_threads(solver_);
    while (lanes > 1 && lists_.patches.count > solver_.context.limits.maxComputeWorkGroupCount[0] / lanes)
        lanes /= 2;
    const std::array<uint32_t, VOILE_FEATURE_DISPATCH_WORDS> none{0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0};
    write_dispatches(recorder_, device_[buffer::feature_dispatch].handle(), word * sizeof(uint32_t),
                     std::as_bytes(std::span(none)));
    const uint32_t traversals = batch_ * VOILE_TRAVERSAL_WORDS;
    if (is_cpu(solver_.context.device_type))
    {
        constexpr std::array<uint32_t, VOILE_TRAVERSAL_WORDS> k_none{};
        write_dispatches(recorder_, device_[buffer::feature_traversals].handle(), traversals * sizeof(uint32_t),
                         std::as_bytes(std::span(k_none)));
    }
    const uint32_t next = std::min(substep + list_period_, substeps_);
    const ItemRange items = feature_items();
    shared::NearFeaturesPush push{};
    push.substeps = of_level_0(next - substep);
    push.progress_from = progress(substep);
    push.progress_to = progress(next);
    push.colliders = solver_.passes.colliders;
    push.near_stride = device_.near_stride;
    push.first_patch = lists_.patches.first;
    push.dispatch_word = word;
    push.lanes = lanes;
    push.first_item = items.first;
    push.items = items.count;
    push.query = substep + 1;
    push.traversal_word = traversals;
    feature_passes_ = 0;
    const gpu::Kernel& kernel = solver_.passes.moving ? kernels_.near_features_moving : kernels_.near_features;
    recorder_.dispatch(kernel, device_.sets.near_features, lists_.patches.count * lanes * group_, group_, push);
    publish_dispatch(recorder_);
    push.retries = 1;
    recorder_.dispatch_indirect(kernel, device_.sets.near_features, device_[buffer::feature_dispatch].handle(),
                                (word + VOILE_DISPATCH_RETRY) * sizeof(uint32_t), push);
    publish_dispatch(recorder_);
}

void BatchRecorder::record_features(uint32_t substep)
{
    const uint32_t word = batch_ * VOILE_FEATURE_DISPATCH_WORDS;
    const ContactInterval interval = contact_interval(substep);
    const ItemRange items = feature_items();
    const uint32_t listed = std::min(substep, substeps_ - 1) / list_period_ * list_period_;
    const shared::FeaturePush push{of_level_0(interval.count),
                                   progress(interval.first),
                                   progress(substep + 1),
                                   solver_.passes.colliders,
                                   substep,
                                   device_.near_stride,
                                   lists_.patches.first,
                                   progress(listed),
                                   progress(std::min(listed + list_period_, substeps_)),
                                   items.first,
                                   items.count,
                                   word,
                                   solver_.options.tuning.feature_threads,
                                   interval.count,
                                   feature_passes_++,
                                   batch_ * VOILE_TRAVERSAL_WORDS,
                                   substep == substeps_ ? 1u : 0u};
    const bool moving = solver_.passes.moving;
    const size_t begins = proposal(substep);
    const size_t votes = context_.history.depenetration_step % 2;
    const VkBuffer sizes = device_[buffer::feature_dispatch].handle();
    recorder_.dispatch_indirect(moving ? kernels_.test_features_moving : kernels_.test_features,
                                device_.sets.test_features[begins][votes], sizes, word * sizeof(uint32_t), push);
    recorder_.dispatch_indirect(moving ? kernels_.feature_contact_moving : kernels_.feature_contact,
                                device_.sets.feature_contact[begins][votes], sizes,
                                (word + VOILE_DISPATCH_PATCHES) * sizeof(uint32_t), push);
    if (!is_cpu(solver_.context.device_type))
        return;
    publish_dispatch(recorder_);
    recorder_.dispatch_indirect(moving ? kernels_.traverse_features_moving : kernels_.traverse_features,
                                device_.sets.feature_contact[begins][votes],
                                device_[buffer::feature_traversals].handle(),
                                (push.traversal_word + 3 * (push.pass % 2)) * sizeof(uint32_t), push);
}

void BatchRecorder::record_contact(uint32_t substep)
{
    shared::ContactPush push{};
    const ContactInterval interval = contact_interval(substep);
    push.substeps = of_level_0(interval.count);
    push.kicks = interval.count;
    push.colliders = solver_.passes.colliders;
    push.refresh = substep % list_period_ == 0 ? 1 : 0;
    push.refresh_substeps = of_level_0(list_period_);
    push.listed = substep - substep % list_period_;
    push.progress_next = progress(std::min(push.listed + list_period_, substeps_));
    push.progress_from = progress(interval.first);
    push.progress_to = progress(substep + 1);
    push.progress_before = progress(std::min(interval.first, substeps_ - 1));
    push.progress_per_substep = 1 / static_cast<float>(substeps_);
    push.substep = substep;
    push.vertices = static_cast<uint32_t>(device_.capacities.vertices);
    push.features = solver_.passes.features ? 1 : 0;
    push.depenetrates = solver_.passes.depenetration ? 1 : 0;
    push.near_stride = device_.near_stride;
    push.dispatch_word = depenetration_word(context_.history.depenetration_step);
    push.mesh_extent = solver_.passes.mesh_extent;
    const PairSchedule& pairs = context_.plan.pairs;
    push.pair_ahead = static_cast<float>(pairs.period) / static_cast<float>(interval.count);
    // After the last substep no time passes.
    const bool ended = substep == substeps_;
    push.pair_from =
        of_level_0(ended ? substeps_ - pairs.last(substeps_ - 1) : interval.first - pairs.last(interval.first));
    push.pair_lasts = of_level_0(ended ? 0 : interval.count);
    push.limited_only = substep == substeps_ ? 1 : 0;
    if (keeps_contact_start(substep))
        push.result = VOILE_CONTACT_KEEPS_START;
    else if (swaps_ && in_stage_b(substep) != in_stage_b(substep + 1))
        push.result = VOILE_CONTACT_IN_PLACE;
    else
        push.result = VOILE_CONTACT_INTO_EARLIER;
    dispatch_awake(contact_kernel(), device_.sets.contact[proposal(substep)], push);
}

const gpu::Kernel& BatchRecorder::contact_kernel() const
{
    const bool pairs = solver_.passes.pairs;
    if (device_.near_stride > 0)
        return pairs ? kernels_.contact_pairs_many : kernels_.contact_many;
    if (solver_.passes.moving)
        return pairs ? kernels_.contact_pairs_moving : kernels_.contact_moving;
    if (solver_.passes.convex)
        return pairs ? kernels_.contact_pairs_convex : kernels_.contact_convex;
    return pairs ? kernels_.contact_pairs : kernels_.contact;
}

void BatchRecorder::record_bounds()
{
    record_attachments(substeps_, 0);
    if (solver_.passes.features)
        record_features(substeps_);
    record_contact(substeps_);
}

void BatchRecorder::record_limit_works(std::span<const VkDescriptorSet> sets)
{
    shared::StagePush push{};
    push.substeps = of_level_0(1);
    for (const VkDescriptorSet& set : sets) // each writes a buffer of its own
        dispatch(kernels_.limit_work, set, push,
                 &set == &sets.back() ? gpu::Ordering::ordered : gpu::Ordering::unordered);
}

} // namespace voile
