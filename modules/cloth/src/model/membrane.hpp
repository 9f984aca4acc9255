// The membrane of a mesh: what a fabric's stretch and shear are on its triangles.
#pragma once

#include "voile/material.hpp"

#include "shared/cloth_layout.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace voile
{

// The directions of a mesh's fabric. Warp is the direction in a triangle along which the first coordinate alone grows;
// weft is at right angles to it.
struct FabricCoordinates
{
    std::span<const glm::vec2> texture;   // one per vertex, or none
    std::span<const glm::vec2> projected; // one per vertex, for triangles where those have no area
    glm::dvec3 view{0, 1, 0};             // unit length, the direction of the projection
};

// A triangle at rest. Its strain is uniform: the deformation gradient F takes a unit vector d of the fabric to
// F d.
struct MembraneTriangle
{
    uint32_t corner[3];     // counter-clockwise from the one with the largest angle
    uint32_t edge[3];       // in no order
    glm::dvec2 position[3]; // m, of the corners along warp and weft
    double area;            // m^2
    double weight;          // m^2, the area; less if softened
};
static_assert(sizeof(MembraneTriangle) == 88); // without padding: it is cooked as it is

// `corners`: vertices, with an area.
MembraneTriangle make_membrane_triangle(std::span<const glm::dvec3> positions, const glm::uvec3& corners,
                                        const FabricCoordinates& fabric);

// As one of its corners reads it.
shared::MembraneCorner make_membrane_corner(const MembraneTriangle& triangle, uint32_t vertex);

// Springs of every triangle along the warp, the weft and both diagonals between them: energy per area
// 1/2 stiffness (|F d| - 1)^2, and damping by the rate of |F d|.
struct MembraneSprings
{
    Spring warp; // N/m, N s/m
    Spring weft;
    Spring diagonal; // each of the two
};

// A fabric's, which resist as its springs do on a grid of square cells. `spacing`: m, typical of the vertices; damping
// depends on it.
MembraneSprings make_membrane_springs(const Fabric& fabric, double spacing);

// Stiffness (N/m) or damping (N s/m) of a membrane's springs.
struct MembraneConstants
{
    double warp = 0;
    double weft = 0;
    double diagonal = 0;
};

// Bounds for the squared frequency of the fastest mode, in any shape, of triangles with the given stiffness and of
// vertices with 1 kg/m^2 of their areas: 1/s^2. Given damping, for the fastest decay: 1/s. One per entry of
// `constants`. Runs on several threads.
std::vector<double> membrane_rates(std::span<const MembraneTriangle> triangles, std::span<const double> areas,
                                   std::span<const MembraneConstants> constants);

} // namespace voile
