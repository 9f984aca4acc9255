// The parameters of a scene's steps and wind that the panel has as sliders, each with its range (voile/ranges.hpp), and
// how a Step gets them.
#pragma once

#include "samples/viewer/scene_file.hpp"

#include "voile/ranges.hpp"
#include "voile/step.hpp"

#include <array>

namespace viewer
{

constexpr float k_least_rate = 1; // frames per second
constexpr float k_most_rate = 1000;

struct StepParameter
{
    const char* name;
    const char* unit;
    float min;
    float max;
    const char* meaning;
    uint32_t count; // of numbers: 1 or 3
    float* (*value)(SceneFile&);
};

// clang-format off
inline constexpr auto k_step_parameters = std::to_array<StepParameter>({
    {"gravity", "m/s^2", -voile::k_most_gravity, voile::k_most_gravity, "along x, y and z", 3,
     [](SceneFile& scene) { return &scene.gravity.x; }},
    {"wind", "m/s", -voile::k_most_wind, voile::k_most_wind, "along x, y and z", 3,
     [](SceneFile& scene) { return &scene.wind.velocity.x; }},
    {"gust", "", 0, voile::k_most_gust, "root mean square of the gusts as a fraction of the wind's speed", 1,
     [](SceneFile& scene) { return &scene.wind.gust; }},
    {"gust_length", "m", voile::k_least_gust_length, voile::k_most_gust_length, "wavelength of the longest gusts", 1,
     [](SceneFile& scene) { return &scene.wind.gust_length; }},
    {"air_density", "kg/m^3", 0, voile::k_most_air_density, "of the air that drags the cloth", 1,
     [](SceneFile& scene) { return &scene.wind.air_density; }},
    {"rate", "1/s", k_least_rate, k_most_rate, "frames per second of simulated time", 1,
     [](SceneFile& scene) { return &scene.step.rate; }},
});
// clang-format on

// Gravity, wind, substeps and duration as the scene has them.
void apply_step(const SceneFile& scene, voile::Step& step);

} // namespace viewer
