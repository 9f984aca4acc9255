// Ranges of what a solver takes, beside those of materials (material.hpp). What lies outside, or is not finite, is
// refused with an error that names it. The corners of the ranges were tried with each other, with anchors that move no
// faster than k_most_speed: none makes a vertex that is not finite (tests/test_ranges.cpp).
#pragma once

#include <cstdint>

namespace voile
{

// Positions, along each axis of the world: vertices of cloths and colliders where they are added, deform or are moved
// to, centers of colliders, origins of anchors. A cloth may leave the range as it moves.
//
// Cloth and contact are computed from finer positions than floats: up to 16 km from the origin a scene does what it
// does there to 0.1 %; at 130 km positions are known to 1e-7 m, enough that nothing falls through and all is finite.
// What is given in floats is where these say: 1 mm apart at 10 km. So give what is far by a transform, or add it near
// the origin and move it: rotations, sizes and the vertices of a mesh stay exact then. What is left of rounding lets
// stiff cloth slip early on an incline: cotton of 5 cm spacing where static friction exceeds the slope by less than 1.3
// % at 8 km and 2.7 % at 16 km, and by more the smaller the spacing is.
constexpr float k_most_coordinate = 1e6f; // m, either way

// A cloth's velocity at its start or as it is set, along each axis.
constexpr float k_most_speed = 1e4f; // m/s, either way

// Of a vertex whose inverse mass is given (GridCloth::inverse_masses).
constexpr float k_most_inverse_mass = 1e9f; // 1/kg

// The sides of a grid.
constexpr float k_least_cloth_size = 1e-4f; // m
constexpr float k_most_cloth_size = 1e5f;   // m

// Radii of spheres and capsules, and the sides of boxes.
constexpr float k_least_collider_size = 1e-4f; // m
constexpr float k_most_collider_size = 2e6f;   // m

constexpr float k_most_friction = 100; // of a fabric and of a collider

// Of an anchor's frame, and of what Solver::teleport does to a cloth: each entry of the matrix but the translation.
constexpr float k_most_scale = 1e3f;
// An anchor's frame also has an inverse: its volume over that of the unit cube.
constexpr float k_least_anchor_volume = 1e-9f;

// Of an attachment: finite stiffness, and damping.
constexpr float k_most_attachment_stiffness = 1e9f; // N/m
constexpr float k_most_attachment_damping = 1e6f;   // N s/m

// Of a Step.
constexpr float k_least_duration = 1e-6f; // s
constexpr float k_most_duration = 10;     // s
constexpr uint32_t k_most_substeps = 1'000'000;
constexpr float k_most_gravity = 1e4f;       // m/s^2 along each axis, either way
constexpr float k_most_wind = 1e3f;          // m/s along each axis, either way
constexpr float k_most_gust = 10;            // of the wind's speed
constexpr float k_least_gust_length = 1e-2f; // m
constexpr float k_most_gust_length = 1e6f;   // m
constexpr double k_most_time = 1e9;          // s, either way
constexpr float k_most_air_density = 1e5f;   // kg/m^3

} // namespace voile
