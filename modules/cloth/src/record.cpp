// The recording of a step: the list of passes, as ARCHITECTURE.md shows it.
#include "solver_state.hpp"

#include <cmath>
#include <numbers>

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

// The phases of the gusts' waves at a time. The field drifts with the wind (Taylor 1938, "The spectrum of turbulence")
// and changes as it goes, a short wave faster than a long one.
glm::vec4 gust_phases(const Step& step, double time)
{
    using glm::vec3;
    constexpr vec3 k_waves[4] = {VOILE_GUST_WAVES};
    constexpr double k_change = 0.3; // of the wave's own speed to the wind's
    const double two_pi = 2 * std::numbers::pi;
    const double wavenumber = two_pi / static_cast<double>(step.gust_length);
    const auto speed = static_cast<double>(glm::length(step.wind));
    glm::vec4 phases;
    for (int i = 0; i < 4; ++i)
    {
        const glm::dvec3 wave(k_waves[i]);
        const double rate = wavenumber * (glm::dot(wave, glm::dvec3(step.wind)) + k_change * glm::length(wave) * speed);
        phases[i] = static_cast<float>(std::fmod(rate * time, two_pi));
    }
    return phases;
}

// Records the substeps of one step.
class SubstepRecorder
{
public:
    SubstepRecorder(gpu::Recorder& recorder, const Kernels& kernels, const DeviceState& device, uint32_t group,
                    const Step& step, uint32_t substeps)
        : recorder_(recorder), kernels_(kernels), device_(device), group_(group), step_(step), substeps_(substeps),
          h_(step.duration / static_cast<float>(substeps)), contact_(device.collider_count > 0)
    {
    }

    void record()
    {
        for (uint32_t substep = 0; substep < substeps_; ++substep)
        {
            const shared::StagePush push = make_push(substep);
            record_rk4(push);
            record_verlet(push, substep);
            if (contact_)
                recorder_.dispatch(kernels_.contact, device_.contact, device_.chunk_count * group_, group_,
                                   shared::ContactPush{h_, device_.collider_count});
        }
        finish_verlet(make_push(substeps_));
    }

private:
    [[nodiscard]] shared::StagePush make_push(uint32_t substep) const
    {
        shared::StagePush push{};
        push.gravity = step_.gravity;
        push.step = h_;
        push.wind = step_.wind;
        push.air_density = step_.air_density;
        push.gust_speed = step_.gust * glm::length(step_.wind);
        if (push.gust_speed > 0)
        {
            push.gust_phases = gust_phases(step_, step_.time + static_cast<double>(h_) * substep);
            push.gust_wavenumber = 2 * std::numbers::pi_v<float> / step_.gust_length;
        }
        return push;
    }

    void record_rk4(const shared::StagePush& push)
    {
        const uint32_t threads = device_.rk4_chunks * group_;
        for (size_t stage = 0; stage < 3; ++stage)
            recorder_.dispatch(kernels_.stages[stage], device_.stages[stage], threads, group_, push);
        recorder_.dispatch(kernels_.stages[3], contact_ ? device_.stages[3] : device_.last_stage_alone, threads, group_,
                           push);
    }

    // Where no contact pass leads from stage B to the state, every second substep does.
    [[nodiscard]] bool in_stage_b(uint32_t substep) const { return !contact_ && substep % 2 == 1; }

    void record_verlet(shared::StagePush push, uint32_t substep)
    {
        push.first_chunk = device_.rk4_chunks;
        push.kick = substep == 0 ? 0.5f * h_ : h_;
        push.drift = h_;
        VkDescriptorSet set = in_stage_b(substep) ? device_.verlet_back : device_.verlet_forth;
        if (substep == 0)
            set = device_.verlet_first;
        recorder_.dispatch(kernels_.verlet, set, verlet_threads(), group_, push);
    }

    void finish_verlet(shared::StagePush push)
    {
        push.first_chunk = device_.rk4_chunks;
        push.kick = 0.5f * h_;
        recorder_.dispatch(kernels_.verlet, in_stage_b(substeps_) ? device_.verlet_last_back : device_.verlet_last,
                           verlet_threads(), group_, push);
    }

    [[nodiscard]] uint32_t verlet_threads() const { return (device_.chunk_count - device_.rk4_chunks) * group_; }

    gpu::Recorder& recorder_;
    const Kernels& kernels_;
    const DeviceState& device_;
    uint32_t group_;
    const Step& step_;
    uint32_t substeps_;
    float h_; // s
    bool contact_;
};

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
    const uint32_t group = state_->options.workgroup_size;
    begin_scope(recorder);
    SubstepRecorder(recorder, state_->kernels, device, group, step, State::substeps(*this, step)).record();
    recorder.dispatch(state_->kernels.normals, device.normals_set, device.chunk_count * group, group,
                      std::span<const std::byte>{});
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
    const DeviceState& device = *state_->device;
    const bool rk4 = device.rk4_chunks > 0;
    const bool verlet = device.rk4_chunks < device.chunk_count;
    const uint32_t a_substep = (rk4 ? 4 : 0) + (verlet ? 1 : 0) + (device.collider_count > 0 ? 1 : 0);
    return State::substeps(*this, step) * a_substep + (verlet ? 1 : 0) + 1;
}

} // namespace cloth
