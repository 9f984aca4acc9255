// Cloth that is shot at a collider, observed frame by frame, and checked in each.
#pragma once

#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"
#include "support/crossing_checks.hpp"

#include "voile/fabrics.hpp"

#include <optional>
#include <string>

namespace tests
{

constexpr float k_shot_duration = 1.f / 60; // s, per frame

struct ShotScene
{
    std::string name;
    voile::engine::Mesh mesh;                // the collider, in world space
    std::optional<voile::BoxCollider> box{}; // replaces the mesh
    float height = 0;                        // m, initial height of the cloth
    bool ground = false;                     // a plane at y = 0
    bool traced = false;               // read after each substep: a thin collider could be jumped over or passed around
    std::optional<glm::dvec3> focus{}; // of a bowl: all of its inside is visible from here
    std::optional<float> top{};        // m: part of the cloth comes to rest above this

    [[nodiscard]] voile::Collider collider() const
    {
        return box ? voile::Collider(*box) : voile::Collider(tests::collider(mesh));
    }
};

struct Shot
{
    uint32_t vertices = 0; // along each side
    float size = 0;        // m
    float speed = 0;       // m/s, downward
    float thickness = 0;   // m
    uint32_t frames = 0;
    float air_density = 0;   // kg/m^3
    float stiffness = 0.25f; // fraction of cotton's: half its substeps, of 3 cm each at 60 m/s
    uint32_t substeps = 0;   // per frame; 0: as many as needed
    bool until_rest = false; // ends earlier, once the cloth has been at rest for some frames
    float strain_limit = 0;  // 0: none
    voile::Fabric fabric = voile::cotton();
};

// The worst observations of a run.
struct Seen
{
    uint64_t wrong = 0; // vertices that went through or left
    double deepest = 0; // m, of a vertex below a closed surface or the ground
    double speed = 0;   // m/s, root mean square of the displacement over the last frame
    double fastest = 0; // the largest of all frames and of the velocities at their ends
    double highest = 0; // m, at the end
    Crossings at_worst;
    Crossings at_end;
};

// Whether the displacement over the last frame was less than the allowed depth.
[[nodiscard]] bool at_rest(const Seen& seen, const Shot& shot);

// Runs a scene and checks its invariants.
Seen shoot(const ShotScene& scene, const Shot& shot);

// A cube of 0.5 m on its edge, 0.1 m above the ground: a triangle mesh or an analytic box.
ShotScene edge_of_a_box(bool formula);

} // namespace tests
