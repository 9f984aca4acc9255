#include "solver/sleep.hpp"

#include "shared/sleep_layout.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace voile
{

namespace
{

bool has_drag(const ClothModel& cloth)
{
    const shared::ClothRecord& record = cloth.record;
    return record.linear_drag > 0 || record.drag_normal > 0 || record.drag_tangential > 0;
}

bool uses_moved_anchor(const Model& model, const ClothModel& cloth)
{
    const auto moves = [&](const Attachment& attachment)
    {
        const Anchor* anchor = attachment.anchor ? model.anchors.find(*attachment.anchor) : nullptr;
        return anchor != nullptr && anchor->from != anchor->to;
    };
    return std::ranges::any_of(cloth.attachments, moves);
}

bool colliders_move(const Solver::State& solver)
{
    for (const auto [index, collider] : solver.collider_models.colliders)
        if (collider.pose.from != collider.pose.to || (collider.deforming && collider.deforming->due))
            return true;
    return false;
}

shared::SleepPush make_push(const Solver::State& solver, uint32_t patches)
{
    const bool islands = solver.passes.pairs && solver.device->pair_cloths.count > 1;
    return {patches, solver.passes.moving ? solver.passes.colliders : 0, islands ? solver.device->pair_cloths.end : 0};
}

// Kernels take the patches of a batch by their number among those that are awake.
void record_awake_patches(gpu::Recorder& recorder, const Solver::State& solver, const ActiveLists& lists)
{
    shared::AwakePush push{};
    for (uint32_t i = 0; i < VOILE_SUBSTEP_BATCHES; ++i)
        push.first_patch[i] = lists.batches[i].patches.first;
    push.first_patch[VOILE_SUBSTEP_BATCHES] = lists.patch_count();
    const uint32_t group = solver.options.tuning.workgroup_size;
    recorder.dispatch(solver.kernels.list_awake_patches, solver.device->sets.list_awake_patches,
                      VOILE_SUBSTEP_BATCHES * group, group, push);
    publish_dispatch(recorder);
}

} // namespace

void Solver::State::wake(ClothModel& cloth)
{
    ++changes;
    if (cloth.record.sleep_speed > 0)
        cloth.wake_due = edits.woken = true;
}

void Solver::State::wake_near(uint32_t layers)
{
    ++changes;
    for (auto [index, cloth] : model.cloths)
        if ((cloth.record.layers & layers) != 0)
            wake(cloth);
}

void Solver::State::wake_paired()
{
    ++changes;
    for (auto [index, cloth] : model.cloths)
        if (cloth.self_collision)
            wake(cloth);
}

void mark_woken(Solver::State& solver, const Step& step)
{
    const Forces forces{step.gravity, step.wind, step.gust, step.gust_length, step.air_density};
    const Forces before = std::exchange(solver.forces, forces);
    const bool anchors = anchors_move(solver.model);
    if (anchors || colliders_move(solver) || forces != before)
        ++solver.changes;
    const auto wake_edited = [&](uint32_t index)
    {
        if (ClothModel* cloth = solver.model.cloths.at(index))
            solver.wake(*cloth);
    };
    for (const uint32_t index : solver.edits.records)
        wake_edited(index);
    for (const shared::EditPush& edit : solver.edits.state_edits)
        wake_edited(edit.cloth);
    const bool falls_otherwise = forces.gravity != before.gravity;
    const bool other_air = forces.wind != before.wind || forces.gust != before.gust ||
                           forces.gust_length != before.gust_length || forces.air_density != before.air_density;
    for (auto [index, cloth] : solver.model.cloths)
        if ((falls_otherwise && cloth.record.gravity_scale != 0) || (other_air && has_drag(cloth)) || cloth.limit_due ||
            (anchors && uses_moved_anchor(solver.model, cloth)))
            solver.wake(cloth);
}

void record_woken(gpu::Recorder& recorder, Solver::State& solver)
{
    constexpr float k_not_calm = 0;
    if (!std::exchange(solver.edits.woken, false))
        return;
    for (auto [index, cloth] : solver.model.cloths)
        if (cloth.uploaded && std::exchange(cloth.wake_due, false))
            recorder.update((*solver.device)[buffer::sleeps].handle(),
                            index * sizeof(shared::SleepRecord) + offsetof(shared::SleepRecord, calm),
                            std::as_bytes(std::span(&k_not_calm, 1)));
}

void record_wake(gpu::Recorder& recorder, const Solver::State& solver, const ActiveLists& lists)
{
    if (!solver.passes.sleep)
        return;
    const uint32_t patches = lists.patch_count();
    const uint32_t group = solver.options.tuning.workgroup_size;
    const shared::SleepPush push = make_push(solver, patches);
    if (push.cloths > 0)
        recorder.dispatch(solver.kernels.find_reaches, solver.device->sets.find_reaches, patches * group, group,
                          std::span<const std::byte>{});
    recorder.dispatch(solver.kernels.find_restless, solver.device->sets.find_restless, patches, group, push);
    recorder.dispatch(solver.kernels.wake_cloths, solver.device->sets.wake_cloths, patches, group, push);
    record_awake_patches(recorder, solver, lists);
}

void record_sleep(gpu::Recorder& recorder, const Solver::State& solver, uint32_t patches, const SubstepPlan& plan)
{
    if (!solver.passes.sleep)
        return;
    const uint32_t group = solver.options.tuning.workgroup_size;
    const auto& sets = solver.device->sets;
    recorder.dispatch(solver.kernels.find_speeds, sets.find_speeds, patches * group, group,
                      shared::SpeedsPush{static_cast<float>(plan.pairs.period)});
    recorder.dispatch(solver.kernels.decide_sleep, sets.decide_sleep, patches, group, make_push(solver, patches));
    recorder.dispatch(solver.kernels.fall_asleep, sets.fall_asleep, patches * group, group,
                      std::span<const std::byte>{});
}

Result<void> Solver::set_sleep_speed(ClothId cloth, float speed)
{
    State& s = *state_;
    if (auto exists = s.check(cloth); !exists)
        return exists;
    if (auto valid = check_sleep_speed(name(cloth), speed); !valid)
        return valid;
    s.model.cloths.find(cloth)->record.sleep_speed = speed;
    s.edits.records.insert(cloth.index);
    s.wake(*s.model.cloths.find(cloth));
    s.update_patches(); // without a cloth that may sleep no pass says that none does
    return {};
}

Result<void> Solver::wake(ClothId cloth)
{
    if (auto exists = state_->check(cloth); !exists)
        return exists;
    state_->wake(*state_->model.cloths.find(cloth));
    return {};
}

} // namespace voile
