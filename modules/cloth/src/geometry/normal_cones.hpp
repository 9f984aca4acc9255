// How far the normals of a mesh spread near each of its triangles, by its hierarchy.
#pragma once

#include "shared/bvh_layout.h"

#include <span>
#include <vector>

namespace voile
{

// Directions within `angle` (rad) of `axis`; an angle below 0: none.
struct Cone
{
    glm::vec3 axis{0, 1, 0};
    float angle = -1;
};

// A cone around both, the smallest but for rounding.
Cone merge(const Cone& a, const Cone& b);

// A hierarchy whose nodes and triangles are counted from 0.
struct MeshTree
{
    std::span<const shared::BvhNode> nodes;
    std::span<const shared::BvhTriangle> triangles;
};

glm::vec3 unit_normal(const shared::BvhTriangle& triangle);

// The mesh around a triangle.
struct Surroundings
{
    float spread = 0;    // rad, half the angle of the cone of the normals nearby; pi at most. Beyond `enough`: some
                         // value beyond it
    bool narrow = false; // the mesh is narrow there: normals spread over a short distance
};

// For each triangle, of a region around it about `width` (m) wide, or as large as the triangle.
std::vector<Surroundings> surroundings(const MeshTree& tree, float width, float enough);

// How far the mesh turns about an edge: rad, half the angle of the fan of the normals across it, of all triangles that
// come nearer to its line than `radius` (m) beside it. What lies beyond its ends, or faces along it, does not count.
// Beyond `enough`: some value beyond it.
float turn_about(const MeshTree& tree, const glm::vec3& a, const glm::vec3& b, float radius, float enough);

} // namespace voile
