// Stage: a scene file made into entities of the engine.
#pragma once

#include "samples/viewer/cloths.hpp"
#include "samples/viewer/colliders.hpp"

#include "component/cloth_component.hpp"
#include "engine/app/app.hpp"

namespace viewer
{

struct StageCloth
{
    std::string name;
    cloth::ClothId id;
    std::vector<glm::vec3> start; // m, where its vertices are before the first step
};

struct Stage
{
    cloth::component::ClothWorld* world = nullptr; // owned by the scene
    std::vector<StageCloth> cloths;
    std::vector<MovingPin> moving_pins;
};

// Adds cloths, solids, ground, camera and light to `app`. Errors name the file and the place in it.
gpu::Result<Stage> set_stage(engine::App& app, const SceneFile& scene, const std::vector<Solid>& solids,
                             const Options& options);

// Moves pins to where they are at the end of the frame that begins at `time` (s).
void advance(Stage& stage, double time, double duration);

} // namespace viewer
