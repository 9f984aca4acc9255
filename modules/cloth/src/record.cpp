// The recording of a step: the list of passes, as ARCHITECTURE.md shows it.
#include "solver_state.hpp"

namespace cloth
{

namespace
{

constexpr VkPipelineStageFlags2KHR k_compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR;
constexpr VkAccessFlags2KHR k_storage =
    VK_ACCESS_2_SHADER_STORAGE_READ_BIT_KHR | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR;

// Earlier draws and copies have read the buffers, uploads and earlier steps have written them.
void begin_scope(gpu::Recorder& recorder)
{
    recorder.barrier(VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT_KHR | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR | k_compute,
                     VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR, k_compute,
                     k_storage);
}

void end_scope(gpu::Recorder& recorder)
{
    recorder.barrier(k_compute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR,
                     VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT_KHR | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR | k_compute,
                     VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT_KHR | VK_ACCESS_2_TRANSFER_READ_BIT_KHR | k_storage);
}

} // namespace

void Solver::record(VkCommandBuffer cmd, const Step& step, gpu::Timestamps* timestamps) const
{
    gpu::Recorder recorder(state_->context, cmd, timestamps);
    record(recorder, step);
}

void Solver::record(gpu::Recorder& recorder, const Step& step) const
{
    if (!state_->device || state_->device->chunk_count == 0)
        return;
    const DeviceState& device = *state_->device;
    const Kernels& kernels = state_->kernels;
    const uint32_t group = state_->options.workgroup_size;
    const uint32_t threads = device.chunk_count * group;
    const uint32_t substeps = step.substeps > 0 ? step.substeps : stable_substeps(step.duration);
    const float h = step.duration / static_cast<float>(substeps);
    const shared::StagePush stage_push{step.gravity, h, step.wind, step.air_density};
    const shared::ContactPush contact_push{h, device.collider_count};
    const bool contact = device.collider_count > 0;

    begin_scope(recorder);
    for (uint32_t substep = 0; substep < substeps; ++substep)
    {
        for (size_t stage = 0; stage < 3; ++stage)
            recorder.dispatch(kernels.stages[stage], device.stages[stage], threads, group, stage_push);
        recorder.dispatch(kernels.stages[3], contact ? device.stages[3] : device.last_stage_alone, threads, group,
                          stage_push);
        if (contact)
            recorder.dispatch(kernels.contact, device.contact, threads, group, contact_push);
    }
    recorder.dispatch(kernels.normals, device.normals_set, threads, group, std::span<const std::byte>{});
    end_scope(recorder);
}

void Solver::record_statistics(VkCommandBuffer cmd, uint32_t slot, gpu::Timestamps* timestamps) const
{
    if (!state_->device || slot >= state_->options.statistics_slots)
        return;
    const DeviceState& device = *state_->device;
    const Kernels& kernels = state_->kernels;
    const uint32_t group = state_->options.workgroup_size;
    gpu::Recorder recorder(state_->context, cmd, timestamps);
    begin_scope(recorder);
    recorder.dispatch(kernels.statistics, device.statistics, device.chunk_count * group, group,
                      shared::StatisticsPush{device.collider_count});
    recorder.dispatch(kernels.statistics_reduce, device.statistics_reduce, group, group,
                      shared::StatisticsReducePush{device.chunk_count, slot});
    recorder.barrier(k_compute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR, VK_PIPELINE_STAGE_2_HOST_BIT_KHR,
                     VK_ACCESS_2_HOST_READ_BIT_KHR);
}

uint32_t Solver::dispatches(const Step& step) const
{
    if (!state_->device || state_->device->chunk_count == 0)
        return 0;
    const uint32_t substeps = step.substeps > 0 ? step.substeps : stable_substeps(step.duration);
    return substeps * (state_->device->collider_count > 0 ? 5 : 4) + 1;
}

} // namespace cloth
