// The walking figure of the dressed scene. Generated here instead of shipped.
#pragma once

#include "voile/engine/assets/mesh.hpp"

#include <array>

namespace scenes
{

constexpr uint32_t k_walk_frames = 66; // of a cycle of two steps
constexpr uint32_t k_walk_rate = 60;   // per second

// The figure walks to +z on a circle around the y axis through (-k_walk_radius, 0, 0): that its feet stay where they
// stand, the scene turns it about that axis by k_walk_spin.
constexpr double k_walk_radius = 0.75; // m
constexpr double k_walk_spin = 52;     // degrees per second, clockwise seen from above

// A smooth, closed surface around capsules, 1.72 m tall: one mesh, skinned to 13 bones at a phase (0..1) of the gait.
// The faces are those of every phase. Positions and triangles only.
class Figure
{
public:
    Figure();
    [[nodiscard]] voile::engine::Mesh at(double phase) const;
    [[nodiscard]] const voile::engine::Mesh& at_rest() const { return rest_; } // arms and legs apart

private:
    static constexpr size_t k_weights = 4;
    struct Skin
    {
        std::array<uint32_t, k_weights> bones{};
        std::array<double, k_weights> weights{}; // sum 1
    };
    voile::engine::Mesh rest_;
    std::vector<Skin> skin_; // one per vertex
};

} // namespace scenes
