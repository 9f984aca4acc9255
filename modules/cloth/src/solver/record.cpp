// Records a step: the passes that ARCHITECTURE.md lists.
#include "model/stability.hpp"
#include "solver/pairs.hpp"
#include "solver/sleep.hpp"
#include "solver/solver_state.hpp"
#include "solver/step_input.hpp"
#include "solver/substeps.hpp"

#include <bit>
#include <utility>

namespace voile
{

namespace
{

// The number of a step's first substep. Before a number repeats, everything that stores numbers of substeps is cleared.
uint32_t count_substeps(gpu::Recorder& recorder, const Solver::State& solver, StepHistory& history, uint32_t substeps)
{
    const uint32_t taken = substeps + 1; // the strain limit has one of its own
    if (history.next_substep >= k_substeps_counted - taken)
    {
        history.next_substep = 0;
        forget_candidates(recorder, *solver.device);
    }
    return std::exchange(history.next_substep, history.next_substep + taken);
}

void record_normals(gpu::Recorder& recorder, const Solver::State& solver)
{
    const uint32_t group = solver.options.tuning.workgroup_size;
    recorder.dispatch(solver.kernels.normals, solver.device->sets.normals, solver.lists.patch_count() * group, group,
                      std::span<const std::byte>{});
}

// Finds the exits of vertices inside colliders. Records nothing if no collider has an inside.
//
// Contact keeps vertices out of colliders at rest. So all vertices are checked only if something else may have moved
// them inside, and every few steps because of rounding. Otherwise an indirect dispatch runs as long as the step before
// has found a vertex inside.
void record_depenetration(gpu::Recorder& recorder, const Solver::State& solver, StepHistory& history, const Step& step)
{
    if (!solver.passes.depenetration)
        return;
    if (std::exchange(history.normals_due, false))
        record_normals(recorder, solver);
    const DeviceState& device = *solver.device;
    const uint32_t group = solver.options.tuning.workgroup_size;
    const gpu::Kernel& kernel = solver.passes.moving ? solver.kernels.depenetrate_moving : solver.kernels.depenetrate;
    const bool periodic = history.depenetration_step % k_depenetration_period == 0;
    const bool all = std::exchange(history.depenetration_due, false) || solver.passes.moving || periodic;
    const size_t now = history.depenetration_step++ % 2;
    const size_t next = history.depenetration_step % 2;
    const shared::DepenetrationPush push{step.duration, solver.passes.colliders, device.near_stride,
                                         depenetration_word(next)};
    const VkBuffer depenetrations = device[buffer::depenetrations].handle();
    clear_dispatch(recorder, depenetrations, depenetration_word(next),
                   std::array{device[k_depenetration_votes[next]].handle()});
    if (all)
        recorder.dispatch(kernel, device.sets.depenetrate[next], solver.lists.patch_count() * group, group, push);
    else
        recorder.dispatch_indirect(kernel, device.sets.depenetrate[next], depenetrations,
                                   depenetration_word(now) * sizeof(uint32_t), push);
    publish_dispatch(recorder);
}

// Null: the passes are recorded one by one.
StepCommands* reusable_commands(const gpu::Recorder& recorder, const Solver::State& solver)
{
    const bool lists = !recorder.is_dry() && !recorder.is_split() && recorder.timestamps() == nullptr;
    return lists ? solver.commands.get() : nullptr;
}

// Everything of a step but edits. Changes only `history`, so a dry recorder can count the dispatches of the next step.
void record_passes(gpu::Recorder& recorder, const Solver::State& solver, const ActiveLists& lists, StepHistory& history,
                   const Step& step, const SubstepPlan& plan, const Passes& with_limits)
{
    const uint32_t first_substep = count_substeps(recorder, solver, history, plan.substeps);
    record_step_input(recorder, *solver.device, make_step_input(solver, history, step, plan, first_substep));
    const StepContext context{recorder, solver, lists, history, step, plan, with_limits};
    record_wake(recorder, solver, lists);
    StepRecorder passes(context);
    passes.record_near_colliders();
    record_depenetration(recorder, solver, history, step);
    StepCommands* const commands = reusable_commands(recorder, solver);
    if (commands != nullptr)
        commands->begin(recorder);
    passes.record();
    record_sleep(recorder, solver, lists.patch_count(), plan);
    record_normals(recorder, solver);
    if (commands != nullptr)
        commands->end(recorder);
    history.pairs_met = solver.passes.pairs;
    history.features_listed = solver.passes.features > 0;
    if (solver.passes.pairs)
        history.next_pair_pass += plan.pairs.passes(plan.substeps);
}

} // namespace

HostScopes host_scopes(const SolverOptions& options)
{
    constexpr VkPipelineStageFlags2KHR k_input = VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT_KHR;
    constexpr HostScopes k_default{{k_input, 0}, {k_input, VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT_KHR}};
    return options.host_scopes.value_or(k_default);
}

// Earlier draws and copies have read the buffers, uploads and earlier steps have written them. The host may have bound
// anything since the recorder's last dispatch.
void begin_scope(gpu::Recorder& recorder, const SolverOptions& options)
{
    recorder.forget_bindings();
    const Scope before = host_scopes(options).before;
    recorder.barrier(before.stages | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR | k_compute,
                     before.accesses | VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR,
                     k_compute | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR,
                     k_storage | VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR);
}

// Previous positions are written by copies.
void end_scope(gpu::Recorder& recorder, const SolverOptions& options)
{
    const Scope after = host_scopes(options).after;
    const Scope copies = options.output.previous_positions
                             ? Scope{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR}
                             : Scope{};
    recorder.barrier(k_compute | copies.stages, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR | copies.accesses,
                     after.stages | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR | k_compute,
                     after.accesses | VK_ACCESS_2_TRANSFER_READ_BIT_KHR | k_storage);
}

void write_dispatches(gpu::Recorder& recorder, VkBuffer sizes, VkDeviceSize offset, std::span<const std::byte> bytes,
                      std::span<const VkBuffer> counts)
{
    constexpr VkPipelineStageFlags2KHR k_transfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR;
    recorder.barrier(k_compute | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT_KHR, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR,
                     k_transfer, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR);
    recorder.update(sizes, offset, bytes);
    for (const VkBuffer buffer : counts)
        recorder.fill(buffer, 0);
    recorder.barrier(k_transfer, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR,
                     k_compute | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT_KHR,
                     k_storage | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT_KHR);
}

void clear_dispatch(gpu::Recorder& recorder, VkBuffer size, uint32_t word, std::span<const VkBuffer> counts)
{
    const VkDispatchIndirectCommand none{0, 1, 1};
    write_dispatches(recorder, size, word * sizeof(uint32_t), std::as_bytes(std::span(&none, 1)), counts);
}

void publish_dispatch(gpu::Recorder& recorder)
{
    recorder.barrier(k_compute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR, VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT_KHR,
                     VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT_KHR);
}

void forget_candidates(gpu::Recorder& recorder, const DeviceState& device)
{
    constexpr float k_none = -1; // see contact_candidates.glsl
    const auto fill = [&](buffer::Name name, uint32_t word) { recorder.fill(device[name].handle(), word); };
    recorder.barrier(k_compute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR,
                     VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR);
    fill(buffer::candidate_centers, std::bit_cast<uint32_t>(k_none));
    fill(buffer::candidate_triangles, 0);
    fill(buffer::feature_corrections, VOILE_NO_SUBSTEP);
    fill(buffer::depenetrations, 0);
    constexpr uint32_t k_not_a_number = 0xffffffff; // no position is in a box of these
    fill(buffer::near_colliders, k_not_a_number);
    recorder.barrier(VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR, k_compute,
                     k_storage);
}

Result<void> Solver::record(VkCommandBuffer cmd, const Step& step, gpu::Timestamps* timestamps)
{
    gpu::Recorder recorder(state_->context, cmd, timestamps);
    return record(recorder, step);
}

Result<void> Solver::record(gpu::Recorder& recorder, const Step& step)
{
    state_->report = {};
    if (auto valid = validate(step); !valid)
        return valid;
    if (!state_->device)
        return {};
    StepCommands* const commands = reusable_commands(recorder, *state_);
    if (commands != nullptr)
        if (auto free = commands->next_is_free(); !free)
            return free;
    const uint32_t commands_before = recorder.commands();
    state_->lifetime.begin(recorder.cmd());
    record_previous_positions(recorder, *state_);
    begin_scope(recorder, state_->options);
    state_->history.depenetration_due |= state_->changes_due();
    SubstepPlan plan = state_->plan(step, state_->needs, nullptr);
    state_->farthest_motion = farthest_motion(*state_);
    plan.pairs.period = substeps_per_pass(*state_, step, plan.substeps, state_->farthest_motion);
    state_->assign_levels(plan, step);
    mark_woken(*state_, step);
    record_edits(recorder, *state_, step);
    record_passes(recorder, *state_, state_->lists, state_->history, step, plan, state_->passes);
    record_jumps(recorder, *state_);
    end_scope(recorder, state_->options);
    state_->lifetime.end(recorder.cmd());
    state_->report.commands = recorder.commands() - commands_before;
    if (commands != nullptr)
    {
        state_->report.commands += commands->commands();
        state_->report.reused = commands->reused();
    }
    return {};
}

uint32_t Solver::dispatches(const Step& step) const
{
    if (!state_->device || !validate(step))
        return 0;
    gpu::Recorder dry(state_->context);
    StepHistory history = state_->history;
    history.normals_due = false; // passes after an upload are not counted
    std::vector<SubstepNeed> needs;
    SubstepPlan plan = state_->plan(step, needs, nullptr);
    plan.pairs.period = substeps_per_pass(*state_, step, plan.substeps, farthest_motion(*state_));
    const LevelOf level_of = [&](const ClothModel& cloth)
    { return plan.level_of(voile::stable_substeps(cloth.record, static_cast<double>(step.duration))); };
    ActiveLists lists;
    list_patches(state_->model, level_of, state_->options.tuning.workgroup_size, lists);
    list_attachments(state_->model, level_of, lists);
    const Passes passes = state_->passes_with([&](const ClothModel& cloth)
                                              { return strain_limit(cloth, step, softening_of(cloth, step, plan)); });
    record_passes(dry, *state_, lists, history, step, plan, passes);
    return dry.dispatches();
}

} // namespace voile
