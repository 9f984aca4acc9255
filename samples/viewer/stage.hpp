// Stage: a scene file made into entities of the engine.
#pragma once

#include "samples/viewer/cloths.hpp"
#include "samples/viewer/colliders.hpp"
#include "samples/viewer/motions.hpp"

#include "voile/cloth_component.hpp"
#include "voile/engine/app/app.hpp"

namespace viewer
{

struct StageCloth
{
    std::string name;
    voile::ClothId id;
    std::vector<glm::vec3> start; // m, where its vertices are before the first step
    uint32_t layers = 1;
    Faces faces{}; // for files
    std::vector<glm::vec2> texture_coordinates{};
    voile::component::Sheet* sheet = nullptr; // owned by the scene
    float size = 1;                           // m, the longest side of the box around the start
};

struct Stage
{
    voile::component::ClothWorld* world = nullptr; // owned by the scene
    Motions* motions = nullptr;                    // owned by the scene
    std::vector<StageCloth> cloths;
    std::vector<voile::ColliderId> colliders; // one per solid
};

// Adds cloths, solids, ground, camera and light to `app`. Errors name the file and the position in it.
voile::Result<Stage> set_stage(voile::engine::App& app, const SceneFile& scene, const std::vector<Solid>& solids,
                               const Options& options);

} // namespace viewer
