// Cloths and colliders that several cases use.
#pragma once

#include "physics/rig.hpp"

#include <string>

namespace physics
{

// The mesh of a collider.
struct TriangleMesh
{
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
};

// 0.2 kg/m^2, without shear, bending and air, slightly damped.
voile::Fabric plain_fabric(double stretch);

// Hangs in the plane of x and y. Its row 0 is pinned on top at y = 0. Velocity Verlet.
voile::GridCloth hanging_sheet(uint32_t columns, uint32_t rows, double width, double length,
                               const voile::Fabric& fabric);

std::string grid_size(uint32_t columns, uint32_t rows); // "9 x 9"
std::string short_number(double value);                 // "0.5"

} // namespace physics
