// The passes of one step, as ARCHITECTURE.md lists them.
#include "solver/substeps.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace voile
{

// Looks at what is near find the state in its own buffers.
static_assert(VOILE_NEAR_PERIOD % 2 == 0 && VOILE_FEATURE_PERIOD % 2 == 0);

namespace
{

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

} // namespace

uint32_t limit_passes(uint32_t widest_spacing)
{
    const auto levels = static_cast<uint32_t>(std::bit_width(widest_spacing));
    return (levels * (k_strain_passes + 1) - 1) | 1u;
}

SubstepRecorder::SubstepRecorder(gpu::Recorder& recorder, const Solver::State& solver, const StepHistory& history,
                                 const Step& step, uint32_t substeps, uint32_t first_substep)
    : recorder_(recorder), solver_(solver), history_(history), kernels_(solver.kernels), device_(*solver.device),
      patches_(solver.patches.count()), step_(step), group_(solver.options.tuning.workgroup_size), substeps_(substeps),
      first_substep_(first_substep), h_(step.duration / static_cast<float>(substeps)),
      has_contact_(solver.passes.contact),
      // Rays along normals look at what neighbors propose, which must not change meanwhile.
      swaps_(has_contact_ && solver.options.tuning.contact_method == ContactMethod::nearest_point)
{
}

void SubstepRecorder::record()
{
    if (solver_.passes.strain_spacing > 0)
        keep_state(k_step_start);
    for (uint32_t substep = 0; substep < substeps_; ++substep)
    {
        if (substep > 0 && substep % VOILE_NEAR_PERIOD == 0)
            record_near_colliders(substep);
        if (solver_.passes.features && substep % VOILE_FEATURE_PERIOD == 0)
            record_near_features(substep);
        record_rk4(substep);
        record_verlet(make_push(substep), substep);
        record_attachments(substep, h_);
        if (solver_.passes.features)
            record_features(substep);
        if (has_contact_)
            record_contact(substep);
    }
    finish_verlet(make_push(substeps_));
    if (solver_.passes.strain_spacing > 0)
        record_strain_limit();
}

shared::StagePush SubstepRecorder::make_push(double substeps) const
{
    shared::StagePush push{};
    push.gravity = step_.gravity;
    push.step = h_;
    push.wind = step_.wind;
    push.air_density = step_.air_density;
    push.gust_speed = step_.gust * glm::length(step_.wind);
    if (push.gust_speed > 0)
    {
        push.gust_phases = gust_phases(step_, step_.time + static_cast<double>(h_) * substeps);
        push.gust_frequency = 1 / step_.gust_length;
    }
    return push;
}

void SubstepRecorder::record_rk4(uint32_t substep)
{
    constexpr double k_stage_times[] = {0, 0.5, 0.5, 1}; // of the substep
    const auto& sets = device_.sets.stages[has_contact_ && in_stage_b(substep) ? 1 : 0];
    for (uint32_t stage = 1; stage <= 4; ++stage)
    {
        shared::StagePush push = make_push(substep + k_stage_times[stage - 1]);
        push.stage = stage;
        recorder_.dispatch(kernels_.stage,
                           stage == 4 && !has_contact_ ? device_.sets.last_stage_alone : sets[stage - 1],
                           solver_.patches.rk4 * group_, group_, push);
    }
}

uint32_t SubstepRecorder::verlet_threads() const
{
    return (patches_ - solver_.patches.rk4) * group_;
}

void SubstepRecorder::record_verlet(shared::StagePush push, uint32_t substep)
{
    push.first_patch = solver_.patches.rk4;
    push.kick = substep == 0 ? 0.5f * h_ : h_;
    push.drift = h_;
    VkDescriptorSet set = in_stage_b(substep) ? device_.sets.verlet_back : device_.sets.verlet_forth;
    if (substep == 0)
        set = device_.sets.verlet_first;
    recorder_.dispatch(kernels_.verlet, set, verlet_threads(), group_, push);
}

void SubstepRecorder::finish_verlet(shared::StagePush push)
{
    push.first_patch = solver_.patches.rk4;
    push.kick = 0.5f * h_;
    recorder_.dispatch(kernels_.verlet,
                       in_stage_b(substeps_) ? device_.sets.verlet_last_back : device_.sets.verlet_last,
                       verlet_threads(), group_, push);
}

void SubstepRecorder::record_attachments(uint32_t substep, float duration)
{
    const size_t from = in_stage_b(substep) ? 1 : 0;
    shared::AttachmentPush push{solver_.passes.pins, solver_.passes.attachments, duration, progress(substep + 1),
                                1 / step_.duration};
    recorder_.dispatch(kernels_.attachments, device_.sets.proposed_attachments[from], push.count, group_, push);
    push.first = 0;
    push.count = solver_.passes.tethers;
    recorder_.dispatch(kernels_.tethers, device_.sets.proposed_tethers[from], push.count, group_, push);
}

// What comes after the last substep, for the strain limit, sees all colliders at their end.
float SubstepRecorder::progress(uint32_t substeps_done) const
{
    return substeps_done >= substeps_ ? 1 : static_cast<float>(substeps_done) / static_cast<float>(substeps_);
}

// What something hits or drags becomes no faster than what moves, or than this.
float SubstepRecorder::sudden_speed() const
{
    constexpr float k_sudden = 10; // m/s
    return std::max(k_sudden, solver_.farthest_motion / step_.duration);
}

void SubstepRecorder::record_near_colliders(uint32_t substep)
{
    if (device_.near_stride == 0)
        return;
    const uint32_t next = std::min(substep + VOILE_NEAR_PERIOD, substeps_);
    const shared::NearCollidersPush push{h_ * static_cast<float>(next - substep), sudden_speed(),
                                         1 / static_cast<float>(substeps_),       solver_.passes.colliders,
                                         solver_.passes.features ? 1u : 0u,       device_.near_stride};
    recorder_.dispatch(kernels_.near_colliders, device_.sets.near_colliders, patches_ * group_, group_, push);
}

void SubstepRecorder::record_near_features(uint32_t substep)
{
    clear_dispatch(recorder_, device_[buffer::feature_dispatch].handle(), 0, solver_.options.tuning.feature_threads);
    const uint32_t next = std::min(substep + VOILE_FEATURE_PERIOD, substeps_);
    const shared::NearFeaturesPush push{h_ * static_cast<float>(next - substep),
                                        sudden_speed(),
                                        progress(substep),
                                        progress(next),
                                        solver_.passes.colliders,
                                        device_.near_stride};
    recorder_.dispatch(solver_.passes.moving ? kernels_.near_features_moving : kernels_.near_features,
                       device_.sets.near_features, patches_ * group_, group_, push);
    publish_dispatch(recorder_);
}

void SubstepRecorder::record_features(uint32_t substep)
{
    const shared::FeaturePush push{h_,
                                   progress(substep),
                                   progress(substep + 1),
                                   solver_.passes.colliders,
                                   first_substep_ + substep,
                                   device_.near_stride};
    recorder_.dispatch_indirect(
        solver_.passes.moving ? kernels_.feature_contact_moving : kernels_.feature_contact,
        device_.sets.feature_contact[in_stage_b(substep) ? 1 : 0][history_.depenetration_step % 2],
        device_[buffer::feature_dispatch].handle(), 0, push);
}

void SubstepRecorder::record_contact(uint32_t substep)
{
    shared::ContactPush push{};
    push.step = h_;
    push.colliders = solver_.passes.colliders;
    push.refresh = substep % VOILE_REFRESH_PERIOD == 0 ? 1 : 0;
    push.refresh_time = VOILE_REFRESH_PERIOD * h_;
    push.progress_from = progress(substep);
    push.progress_to = progress(substep + 1);
    push.progress_per_substep = 1 / static_cast<float>(substeps_);
    push.substep = first_substep_ + substep;
    push.first_substep = first_substep_;
    push.vertices = static_cast<uint32_t>(device_.capacities.vertices);
    push.features = solver_.passes.features ? 1 : 0;
    push.depenetrates = solver_.passes.depenetration ? 1 : 0;
    push.near_stride = device_.near_stride;
    push.dispatch_word = depenetration_word(history_.depenetration_step);
    push.mesh_extent = solver_.passes.mesh_extent;
    push.in_place = swaps_ && in_stage_b(substep) != in_stage_b(substep + 1) ? 1 : 0;
    recorder_.dispatch(contact_kernel(), device_.sets.contact[in_stage_b(substep) ? 1 : 0], patches_ * group_, group_,
                       push);
}

const gpu::Kernel& SubstepRecorder::contact_kernel() const
{
    if (device_.near_stride > 0)
        return kernels_.contact_many;
    if (solver_.passes.moving)
        return kernels_.contact_moving;
    return solver_.passes.convex ? kernels_.contact_convex : kernels_.contact;
}

// Attachments and contact have the last word on positions; then the guard measures what all of it has done to the
// energy.
void SubstepRecorder::record_strain_limit()
{
    record_limit_passes();
    keep_state(k_before_limit);
    record_attachments(substeps_, 0);
    record_contact(substeps_);
    record_limit_guard();
}

// The guard of the strain limit compares states of a step.
void SubstepRecorder::keep_state(const StateBuffers& kept)
{
    constexpr VkPipelineStageFlags2KHR k_compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR;
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
    copy(k_state.velocities, kept.velocities, sizeof(glm::vec4));
    recorder_.barrier(k_copy, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR, k_compute,
                      VK_ACCESS_2_SHADER_STORAGE_READ_BIT_KHR | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR);
}

void SubstepRecorder::record_limit_guard()
{
    const uint32_t threads = patches_ * group_;
    shared::StagePush push{};
    push.gravity = step_.gravity;
    push.step = h_;
    for (const VkDescriptorSet set : device_.sets.limit_work)
        recorder_.dispatch(kernels_.limit_work, set, threads, group_, push);
    for (uint32_t measurement = 0; measurement <= VOILE_LIMIT_MEASUREMENTS; ++measurement)
    {
        if (measurement > 0) // at what is left of the limit's changes
            recorder_.dispatch(kernels_.limit_work, device_.sets.limit_work[3], threads, group_, push);
        recorder_.dispatch(kernels_.limit_scale, device_.sets.limit_scale, threads, group_,
                           shared::LimitScalePush{patches_, 1 / step_.duration, measurement});
        recorder_.dispatch(kernels_.limit_guard, device_.sets.limit_guard, threads, group_,
                           std::span<const std::byte>{});
    }
}

// From coarse to fine. The first and the last pass end in stage B, from where the contact pass takes it: an even number
// has one more.
void SubstepRecorder::record_limit_passes()
{
    const uint32_t passes = limit_passes(solver_.passes.strain_spacing);
    uint32_t pass = 0;
    const auto record_pass = [&](uint32_t spacing, bool between, bool first, float acceleration)
    {
        const VkDescriptorSet set = pass == 0       ? device_.sets.strain_first
                                    : pass % 2 == 1 ? device_.sets.strain_back
                                                    : device_.sets.strain_forth;
        ++pass;
        const shared::StrainPush push{spacing, between ? 1u : 0u, acceleration, first ? 1u : 0u,
                                      pass == passes ? 1u : 0u};
        recorder_.dispatch(kernels_.limit_strain, set, patches_ * group_, group_, push);
    };
    for (uint32_t spacing = solver_.passes.strain_spacing; spacing > 0; spacing /= 2)
    {
        if (spacing < solver_.passes.strain_spacing)
            record_pass(spacing, true, false, 1);
        float acceleration = 1;
        for (uint32_t i = 0; i < k_strain_passes; ++i)
        {
            record_pass(spacing, false, i == 0, acceleration);
            // Golub and Varga 1961, after Wang 2015, "A Chebyshev semi-iterative approach for accelerating projective
            // and position-based dynamics".
            if (i > 0)
                acceleration = i == 1 ? 2 / (2 - k_strain_radius * k_strain_radius)
                                      : 4 / (4 - k_strain_radius * k_strain_radius * acceleration);
        }
    }
    if (pass < passes)
        record_pass(1, false, false, 1);
}

} // namespace voile
