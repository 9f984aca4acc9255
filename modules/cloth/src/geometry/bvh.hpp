// Bounding volume hierarchies over triangle meshes: building, in the layout that the GPU traverses.
#pragma once

#include "geometry/shared_array.hpp"
#include "shared/bvh_layout.h"

#include <glm/glm.hpp>

#include <span>

namespace voile
{

struct BvhOptions
{
    uint32_t triangles_per_leaf = 2;       // at most, 1..4
    uint32_t threads = 0;                  // at most; 0: one per core
    uint32_t triangles_per_subtree = 4096; // at most, of what one thread builds on its own; >= 1
};

struct Bvh
{
    SharedArray<shared::BvhNode> nodes;         // depth first; node 0 is the root
    SharedArray<shared::BvhTriangle> triangles; // in the order of the leaves
    uint32_t depth = 0;                         // of inner nodes on the longest path, <= VOILE_BVH_MAX_DEPTH
};

// Splits top down by the surface area heuristic, binned (Wald 2007, "On fast construction of SAH-based bounding volume
// hierarchies"): 16 bins of centroids along each axis, the plane with the least sum of area times count. If no plane
// separates the centroids, or the tree is too deep, the triangles are halved in their order along the widest axis.
// Needs at least one triangle, indices in range and finite positions. The result depends on the mesh and the leaves'
// size alone: it is the same to the bit for any number of threads and any division of the work.
Bvh build_bvh(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
              const BvhOptions& options = {});

} // namespace voile
