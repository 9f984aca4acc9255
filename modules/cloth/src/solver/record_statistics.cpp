// Statistics, and the exact count of intersections.
#include "solver/solver_state.hpp"

#include "shared/statistics_layout.h"

#include <algorithm>
#include <numeric>

namespace voile
{

namespace
{

constexpr VkPipelineStageFlags2KHR k_transfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR;

void record_intersections(gpu::Recorder& recorder, const Solver::State& solver)
{
    const DeviceState& device = *solver.device;
    clear_intersections(recorder, device);
    record_refit(recorder, solver.kernels.refit, device.sets.refit_cloths, device.tree_counts);
    record_over_trees(recorder, solver, solver.kernels.count_cloth_pairs, device.sets.count_cloth_pairs);
    if (solver.passes.colliders > 0)
        record_over_trees(recorder, solver, solver.kernels.count_collider_pairs, device.sets.count_collider_pairs);
}

// Into the result, after the reduction.
void copy_counts(gpu::Recorder& recorder, const Solver::State& solver, uint32_t slot)
{
    recorder.barrier(k_compute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR, k_transfer,
                     VK_ACCESS_2_TRANSFER_READ_BIT_KHR | VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR);
    constexpr VkDeviceSize k_bytes = sizeof(shared::StatisticsResult);
    recorder.copy(
        (*solver.device)[buffer::intersection_counts].handle(), solver.statistics.handle(),
        {0, slot * k_bytes + offsetof(shared::StatisticsResult, intersections), sizeof(shared::IntersectionCounters)});
}

} // namespace

void record_over_trees(gpu::Recorder& recorder, const Solver::State& solver, const gpu::Kernel& kernel,
                       VkDescriptorSet set)
{
    const uint32_t group = solver.options.tuning.workgroup_size;
    const TreeCounts& trees = solver.device->tree_counts;
    shared::IntersectionPush push{std::accumulate(trees.begin(), trees.end(), 0u), 0, 0, solver.passes.colliders};
    for (; push.levels < trees.size(); push.first_tree += trees[push.levels++])
        recorder.dispatch_grid(kernel, set, std::max((1u << push.levels) / group, 1u), trees[push.levels], push);
}

void clear_intersections(gpu::Recorder& recorder, const DeviceState& device)
{
    constexpr shared::IntersectionCounters k_none{0, 0, 0, 1};
    recorder.barrier(k_compute | k_transfer,
                     VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR | VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR, k_transfer,
                     VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR);
    recorder.fill(device[buffer::intersections].handle(), 0);
    recorder.update(device[buffer::intersection_counts].handle(), 0, std::as_bytes(std::span(&k_none, 1)));
    recorder.barrier(k_transfer, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR, k_compute, k_storage);
}

Result<void> Solver::record_statistics(VkCommandBuffer cmd, uint32_t slot, gpu::Timestamps* timestamps) const
{
    return record_statistics(cmd, slot, Intersections::not_counted, timestamps);
}

Result<void> Solver::record_statistics(VkCommandBuffer cmd, uint32_t slot, Intersections intersections,
                                       gpu::Timestamps* timestamps) const
{
    const SolverOptions& options = state_->options;
    const bool counted = intersections == Intersections::counted;
    if (slot >= options.statistics_slots)
        return Error{"statistics: slot " + std::to_string(slot) + " of " + std::to_string(options.statistics_slots) +
                     " does not exist"};
    if (counted && !options.intersections)
        return Error{"statistics: intersections are counted only with SolverOptions::intersections"};
    if (!state_->device)
        return {};
    const DeviceState& device = *state_->device;
    const Kernels& kernels = state_->kernels;
    const uint32_t group = options.tuning.workgroup_size;
    gpu::Recorder recorder(state_->context, cmd, timestamps);
    state_->lifetime.begin(cmd);
    begin_scope(recorder, options);
    if (counted)
        record_intersections(recorder, *state_);
    recorder.dispatch(kernels.statistics, device.sets.statistics, device.patch_count * group, group,
                      shared::StatisticsPush{state_->passes.colliders, device.near_stride,
                                             state_->history.features_listed ? 1u : 0u});
    recorder.dispatch(kernels.statistics_reduce, device.sets.statistics_reduce, group, group,
                      shared::StatisticsReducePush{device.patch_count, slot, state_->history.pairs_met ? 1u : 0u});
    if (counted)
        copy_counts(recorder, *state_, slot);
    recorder.barrier(k_compute | k_transfer,
                     VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR | VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR,
                     VK_PIPELINE_STAGE_2_HOST_BIT_KHR, VK_ACCESS_2_HOST_READ_BIT_KHR);
    if (counted) // the host draws from the vertices' marks
        end_scope(recorder, options);
    state_->lifetime.end(cmd);
    return {};
}

} // namespace voile
