// Stage: a scene file made into entities of the engine.
#pragma once

#include "samples/viewer/colliders.hpp"

#include "component/cloth_component.hpp"
#include "engine/app/app.hpp"

namespace viewer
{

struct StageCloth
{
    std::string name;
    cloth::ClothId id;
    cloth::Grid grid; // as it was added
};

struct Stage
{
    cloth::component::ClothWorld* world = nullptr; // owned by the scene
    std::vector<StageCloth> cloths;
    WindEntry wind;
};

// Adds cloths, solids, ground, camera and light to `app`. Errors name the file and the place in it.
gpu::Result<Stage> set_stage(engine::App& app, const SceneFile& scene, const std::vector<Solid>& solids,
                             const Options& options);

// Where a vertex of a grid is before the first step, m.
glm::vec3 grid_point(const cloth::Grid& grid, uint32_t row, uint32_t column);

// The wind at a time (s): its velocity with gusts that swell and fade, always the same at the same time.
glm::vec3 wind_at(const WindEntry& wind, double time);

} // namespace viewer
