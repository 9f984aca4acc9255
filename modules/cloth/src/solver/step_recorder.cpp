// The passes of one step: those of all batches in the order of time, then the strain limit.
#include "solver/substeps.hpp"

#include "solver/pairs.hpp"

#include <bit>

namespace voile
{

StepRecorder::StepRecorder(const StepContext& context)
    : context_(context), recorder_(context.recorder), solver_(context.solver), kernels_(solver_.kernels),
      device_(*solver_.device), threads_(context.lists.patch_count() * solver_.options.tuning.workgroup_size),
      group_(solver_.options.tuning.workgroup_size)
{
    for (uint32_t i = 0; i < VOILE_SUBSTEP_BATCHES; ++i)
        if (context.lists.batches[i].patches.count > 0)
            batches_[i].emplace(context, i);
}

template <typename Use>
void StepRecorder::for_each_batch(const Use& use)
{
    for (std::optional<BatchRecorder>& batch : batches_)
        if (batch)
            use(*batch);
}

bool StepRecorder::in_stage_b(uint32_t substep) const
{
    const std::optional<BatchRecorder>& any = batches_[0] ? batches_[0] : batches_[1];
    return any->in_stage_b(substep);
}

void StepRecorder::record_near_colliders()
{
    for_each_batch([](BatchRecorder& batch) { batch.record_near_colliders(0); });
}

// The first contact pass of a batch starts from the state, which Verlet overwrites if there is more than one substep
// before that pass.
void StepRecorder::keep_contact_start()
{
    bool keeps = false;
    for_each_batch([&](const BatchRecorder& batch) { keeps |= batch.contact_period() > 1; });
    if (keeps)
        keep_state(k_contact_start, false);
}

// A batch takes its substep at the beginning of the time that the substep covers.
void StepRecorder::record()
{
    const bool limits = context_.passes.strain_spacing > 0;
    if (limits || context_.passes.sleep)
        keep_state(k_step_start, limits);
    if (context_.passes.sleep && context_.passes.pairs)
        keep_state(k_stage_b); // passes over pairs read it of cloths that sleep, which no other pass writes
    keep_contact_start();
    PairRecorder pairs(recorder_, solver_, context_.lists, context_.plan);
    for (uint32_t substep = 0; substep < context_.plan.substeps; ++substep)
    {
        if (context_.passes.pairs && context_.plan.pairs.begins(substep))
            pairs.record(substep, in_stage_b(substep));
        for (uint32_t i = 0; i < VOILE_SUBSTEP_BATCHES; ++i)
            if (const uint32_t level = batch_at(i).level; batches_[i] && substep % (1u << level) == 0)
                batches_[i]->record_substep(substep >> level);
    }
    for_each_batch([](BatchRecorder& batch) { batch.finish(); });
    if (context_.passes.strain_spacing > 0)
        record_strain_limit();
}

// Attachments and contact correct the positions last. Then the guard measures the change of energy by all of this.
void StepRecorder::record_strain_limit()
{
    record_limit_passes();
    keep_state(k_before_limit);
    for_each_batch([](BatchRecorder& batch) { batch.record_bounds(); });
    record_limit_guard();
}

void StepRecorder::keep_state(const StateBuffers& kept, bool velocities)
{
    constexpr VkPipelineStageFlags2KHR k_copy = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR;
    const auto copy = [&](buffer::Name from, buffer::Name to, VkDeviceSize bytes_per_vertex)
    {
        const VkBufferCopy region{0, 0, device_.vertices * bytes_per_vertex};
        recorder_.copy(device_[from].handle(), device_[to].handle(), region);
    };
    recorder_.barrier(k_compute, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR, k_copy,
                      VK_ACCESS_2_TRANSFER_READ_BIT_KHR | VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR);
    copy(k_state.positions, kept.positions, sizeof(glm::vec4));
    copy(k_state.residuals, kept.residuals, sizeof(glm::uvec2));
    if (velocities)
        copy(k_state.velocities, kept.velocities, sizeof(glm::vec4));
    recorder_.barrier(k_copy, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR, k_compute, k_storage);
}

void StepRecorder::record_limit_guard()
{
    const std::span works(device_.sets.limit_work);
    for_each_batch([&](BatchRecorder& batch) { batch.record_limit_works(works); });
    for (uint32_t measurement = 0; measurement <= VOILE_LIMIT_MEASUREMENTS; ++measurement)
    {
        if (measurement > 0) // of what remains of the limit's changes
            for_each_batch([&](BatchRecorder& batch) { batch.record_limit_works(works.last(1)); });
        recorder_.dispatch(kernels_.limit_scale, device_.sets.limit_scale, threads_, group_,
                           shared::LimitScalePush{context_.lists.patch_count(), measurement});
        recorder_.dispatch(kernels_.limit_guard, device_.sets.limit_guard, threads_, group_,
                           std::span<const std::byte>{});
    }
}

// From coarse to fine, between stages B and A. Each level begins with a pass between the lines of the level before. The
// last pass ends in stage B, from where the contact pass takes it.
void StepRecorder::record_limit_passes()
{
    const uint32_t widest = context_.passes.strain_spacing;
    const uint32_t on_level = context_.passes.strain_passes;
    const uint32_t end = context_.passes.smooths ? 1 : 0; // smoothing, from stage A to stage B
    uint32_t left = static_cast<uint32_t>(std::bit_width(widest)) * (on_level + 1) + end;
    const uint32_t parts = threads_per_vertex(solver_.options);
    recorder_.dispatch(kernels_.limit_coarse, device_.sets.limit_coarse[left % 2], threads_ * parts, group_ * parts,
                       std::span<const std::byte>{});
    const auto record_pass = [&](const shared::StrainPush& push)
    {
        const VkDescriptorSet set = left % 2 == 0 ? device_.sets.strain_back : device_.sets.strain_forth;
        --left;
        shared::StrainPush numbered = push;
        numbered.last = left == end ? 1 : 0;
        recorder_.dispatch(kernels_.limit_strain, set, threads_, group_, numbered);
    };
    for (uint32_t spacing = widest; spacing > 0; spacing /= 2)
    {
        record_pass({spacing, 1, 1, 0, 0});
        float acceleration = 1;
        for (uint32_t i = 0; i < on_level; ++i)
        {
            acceleration = shared::strain_acceleration(i, acceleration);
            record_pass({spacing, 0, acceleration, i, 0});
        }
    }
    if (!context_.passes.smooths)
        return;
    recorder_.dispatch(kernels_.limit_spin, device_.sets.limit_spin, threads_, group_, std::span<const std::byte>{});
    recorder_.dispatch(kernels_.limit_smooth, device_.sets.limit_smooth, threads_, group_,
                       std::span<const std::byte>{});
}

} // namespace voile
