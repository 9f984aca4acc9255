// Features: edges and corners of colliders that can protrude between the vertices of a cloth.
#pragma once

#include "colliders/deforming_features.hpp"
#include "model/model.hpp"

#include "geometry/shared_array.hpp"
#include "shared/bvh_layout.h"
#include "shared/feature_layout.h"

#include <vector>

namespace voile
{

struct ColliderModel; // collider_model.hpp
struct ColliderModels;

// Of the cloths that share a layer with these, as they were added. edge == 0: there is no such cloth.
FeatureScale feature_scale(const Model& model, uint32_t layers);

// The features of one collider, with a hierarchy over them; offsets in `set` are counted from its own first ones.
struct ColliderFeatures
{
    FeatureScale scale;
    shared::FeatureSet set{};
    std::vector<shared::Feature> features;
    SharedArray<shared::BvhNode> nodes;
    DeformingFeatures deforming{}; // instead, of a mesh that deforms
};

// Of a mesh, where it bends by more than the thickness allows within the length of an edge: its edges, if they are
// longer than twice the thickness or a quarter of that length, and corners that lie as far from each other. Of an
// open or two-sided mesh its border too. Boxes, and spheres and capsules that are thin by the same measure. Meshes that
// deform: deforming_features.hpp.
ColliderFeatures make_features(const ColliderModel& collider, const FeatureScale& scale);

// Whether features that were found for one scale include those that another one needs.
inline bool covers(const FeatureScale& found, const FeatureScale& needed)
{
    return needed.edge == 0 || (found.edge >= needed.edge && found.thickness <= needed.thickness);
}

// Whether the collider's features must be found: there are none yet, its shape changed, a cloth is thinner or has
// longer edges than all before.
bool needs_features(const ColliderModel& collider, const Model& model);

// Finds the features of the colliders that need them. The others keep theirs. Colliders of the same mesh share
// features.
void update_features(ColliderModels& colliders, const Model& model);

} // namespace voile
