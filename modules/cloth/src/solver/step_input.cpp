#include "solver/step_input.hpp"

#include "solver/pairs.hpp"

#include <algorithm>
#include <cmath>

namespace voile
{

namespace
{

// The phases of the gusts' waves. The field drifts with the wind (Taylor 1938, "The spectrum of turbulence") and
// changes as it goes, a short wave faster than a long one.
void set_gusts(shared::StepInput& input, const Step& step)
{
    using glm::vec3;
    constexpr vec3 k_waves[4] = {VOILE_GUST_WAVES};
    constexpr double k_change = 0.3; // of the wave's own speed to the wind's
    const auto speed = static_cast<double>(glm::length(step.wind));
    input.gust_speed = step.gust * glm::length(step.wind);
    if (input.gust_speed == 0)
        return;
    input.gust_frequency = 1 / step.gust_length;
    for (int i = 0; i < 4; ++i)
    {
        const glm::dvec3 wave(k_waves[i]);
        const double turns_per_second = (glm::dot(wave, glm::dvec3(step.wind)) + k_change * glm::length(wave) * speed) /
                                        static_cast<double>(step.gust_length);
        input.gust_rates[i] = static_cast<float>(turns_per_second);
        input.gust_phases[i] = static_cast<float>(std::fmod(turns_per_second * step.time, 1.0));
    }
}

} // namespace

shared::StepInput make_step_input(const Solver::State& solver, const StepHistory& history, const Step& step,
                                  const SubstepPlan& plan, uint32_t first_substep)
{
    constexpr float k_sudden = 10; // m/s
    shared::StepInput input{};
    input.gravity = step.gravity;
    input.substep = step.duration / static_cast<float>(plan.substeps);
    input.wind = step.wind;
    input.air_density = step.air_density;
    set_gusts(input, step);
    input.rate = 1 / step.duration;
    // An upper bound for the speed of a vertex that something hits or drags.
    input.sudden = std::max(k_sudden, (solver.passes.features ? solver.farthest_motion : 0) / step.duration);
    input.first_substep = first_substep;
    input.first_pair_pass = history.next_pair_pass;
    input.list_time = time_of_lists(static_cast<float>(plan.pairs.period) * input.substep);
    input.pair_fall = fall_of_pairs(step.gravity, input.list_time);
    input.driven = solver.passes.moving || solver.farthest_motion > 0 ? 1 : 0;
    input.edited = history.depenetration_due ? 1 : 0;
    return input;
}

void record_step_input(gpu::Recorder& recorder, const DeviceState& device, const shared::StepInput& input)
{
    recorder.update(device[buffer::step_inputs].handle(), 0, std::as_bytes(std::span(&input, 1)));
    recorder.barrier(VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR,
                     VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR, VK_ACCESS_2_UNIFORM_READ_BIT_KHR);
}

} // namespace voile
