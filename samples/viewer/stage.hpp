// Stage: a scene file made into entities of the engine.
#pragma once

#include "samples/viewer/cloths.hpp"
#include "samples/viewer/colliders.hpp"
#include "samples/viewer/motions.hpp"

#include "component/cloth_component.hpp"
#include "engine/app/app.hpp"

namespace viewer
{

struct StageCloth
{
    std::string name;
    cloth::ClothId id;
    std::vector<glm::vec3> start; // m, where its vertices are before the first step
    uint32_t layers = 1;
};

struct Stage
{
    cloth::component::ClothWorld* world = nullptr; // owned by the scene
    Motions* motions = nullptr;                    // likewise
    std::vector<StageCloth> cloths;
    std::vector<cloth::ColliderId> colliders; // one a solid
};

// Adds cloths, solids, ground, camera and light to `app`. Errors name the file and the place in it.
gpu::Result<Stage> set_stage(engine::App& app, const SceneFile& scene, const std::vector<Solid>& solids,
                             const Options& options);

} // namespace viewer
