// A scene's step.
#include "samples/viewer/step_parameters.hpp"

namespace viewer
{

void apply_step(const SceneFile& scene, voile::Step& step)
{
    step.gravity = scene.gravity;
    step.wind = scene.wind.velocity;
    step.gust = scene.wind.gust;
    step.gust_length = scene.wind.gust_length;
    step.air_density = scene.wind.air_density;
    step.max_substeps = scene.step.max_substeps;
    step.substeps = scene.step.substeps.value_or(0);
    step.duration = 1 / scene.step.rate;
}

} // namespace viewer
