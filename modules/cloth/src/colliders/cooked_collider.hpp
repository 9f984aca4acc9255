// What a CookedCollider holds.
#pragma once

#include "voile/cooked.hpp"

#include "geometry/bvh.hpp"

#include <glm/glm.hpp>

namespace voile
{

struct CookedCollider::State
{
    glm::mat4 transform{1.f}; // that gives the shape
    glm::vec3 origin{0.f};    // m, in the world with that transform; the hierarchy is relative to it
    bool closed = false;
    std::shared_ptr<const Bvh> hierarchy;
};

// Whether every reference of a hierarchy leads to a node or to triangles that come next, depth first, in the order of
// the leaves: a traversal visits each node once at most, and none deeper than VOILE_BVH_MAX_DEPTH.
bool is_depth_first(const Bvh& bvh);

} // namespace voile
