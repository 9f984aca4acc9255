// The corners and edges of a mesh collider that a cloth's vertices may not feel.
#pragma once

#include "colliders/collider_features.hpp"

namespace voile
{

// See find_features.
std::vector<shared::Feature> mesh_features(const Model& model, const shared::ColliderRecord& collider,
                                           const FeatureScale& scale);

} // namespace voile
