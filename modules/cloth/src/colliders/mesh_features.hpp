// The corners and edges of a mesh collider that a cloth's vertices may not feel.
#pragma once

#include "colliders/collider_features.hpp"
#include "geometry/bvh.hpp"

namespace voile
{

// See make_features. `flags`: of the collider's record.
std::vector<shared::Feature> mesh_features(const Bvh& hierarchy, uint32_t flags, const FeatureScale& scale);

} // namespace voile
