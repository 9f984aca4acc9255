// Ranges of a solver's input. Those of materials are in material_parameters.hpp. A value outside its range, or one that
// is not finite, is an error that names the value. The ends of the ranges were tested in combination, with anchors that
// move no faster than k_most_speed: none makes a vertex that is not finite, of grids in steps of any duration, of
// meshes in steps of up to 1/60 s (tests/solver/test_ranges.cpp).
#pragma once

#include <cstdint>

namespace voile
{

// Positions along each axis of the world: vertices of cloths and colliders when they are added, deformed or moved,
// centers of colliders and origins of anchors. A cloth may leave the range as it moves.
//
// The simulation uses finer positions than floats. Up to 16 km from the origin, a scene behaves as at the origin, to
// 0.4 %. At 130 km, positions are known to 1e-7 m: no cloth falls through, and all values are finite. Input in floats
// is coarser: 1 mm at 10 km. So place distant objects by a transform, or add them near the origin and move them. This
// keeps rotations, sizes and the vertices of a mesh exact. The remaining rounding lets stiff cloth slip early on an
// incline: cotton of 5 cm spacing slips where static friction exceeds the slope by less than 1.3 % at 8 km and 2.7 % at
// 16 km. Smaller spacing slips earlier.
constexpr float k_most_coordinate = 1e6f; // m, either way

// The velocity of a cloth along each axis, at the start or as set later.
constexpr float k_most_speed = 1e4f; // m/s, either way

// The speed below which a cloth may fall asleep (GridCloth::sleep_speed).
constexpr float k_most_sleep_speed = 10; // m/s

// Inverse mass of a vertex (GridCloth::inverse_masses).
constexpr float k_most_inverse_mass = 1e9f; // 1/kg

// Sides of a grid, and the longest side of each triangle of a mesh cloth that has an area.
constexpr float k_least_cloth_size = 1e-4f; // m
constexpr float k_most_cloth_size = 1e5f;   // m

// Radii of spheres and capsules, sides of boxes.
constexpr float k_least_collider_size = 1e-4f; // m
constexpr float k_most_collider_size = 2e6f;   // m

// Least length of a grid's x and z axes after its transform.
constexpr float k_least_grid_scale = 1e-7f;

constexpr float k_most_friction = 100; // of a cloth and of a collider

// Each entry of an anchor's frame, and of the transform that Solver::teleport takes, except the translation.
constexpr float k_most_scale = 1e3f;
// Least volume of an anchor's frame relative to the unit cube's, so that the frame has an inverse.
constexpr float k_least_anchor_volume = 1e-9f;

// Attachments: finite stiffness, and damping.
constexpr float k_most_attachment_stiffness = 1e9f; // N/m
constexpr float k_most_attachment_damping = 1e6f;   // N s/m

// Members of a Step.
constexpr float k_least_duration = 1e-6f; // s
constexpr float k_most_duration = 10;     // s
constexpr uint32_t k_most_substeps = 1'000'000;
constexpr float k_most_gravity = 1e4f; // m/s^2 along each axis, either way
constexpr float k_most_wind = 1e3f;    // m/s along each axis, either way
constexpr float k_least_strain_limit = 1e-3f;
constexpr float k_most_strain_limit = 10;
constexpr float k_most_gust = 10;            // of the wind's speed
constexpr float k_least_gust_length = 1e-2f; // m
constexpr float k_most_gust_length = 1e6f;   // m
constexpr double k_most_time = 1e9;          // s, either way
constexpr float k_most_air_density = 1e5f;   // kg/m^3

} // namespace voile
