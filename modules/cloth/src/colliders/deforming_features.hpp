// Features of meshes that deform: every edge and vertex that may become one. face_features.comp decides in each step
// which of them are.
#pragma once

#include "colliders/feature_scale.hpp"

#include "shared/collider_layout.h"
#include "shared/feature_layout.h"

#include <cstdint>
#include <vector>

namespace voile
{

struct DeformingMesh; // collider_model.hpp

// Offsets count from the mesh's own first entries.
struct DeformingFeatures
{
    std::vector<shared::FeatureSource> sources; // in the order of the slots that own them
    std::vector<shared::FeatureHinge> hinges;
    std::vector<uint32_t> slots; // per slot of the mesh's hierarchy, see VOILE_SLOT_FEATURE_BITS
};

// An edge belongs to a triangle that has it, unless it is shorter than half of the spacing as the mesh was added: the
// mesh may stretch. Of the vertices in a cell of that size the sharpest counts, with the hinges around all of them. The
// sharpest in a larger cell stands for the others there, and for edges along it, where features may be that far apart
// (FeatureScale). No cloth that can touch it (scale.edge == 0): none.
DeformingFeatures deforming_features(const DeformingMesh& mesh, const shared::ColliderRecord& record,
                                     const FeatureScale& scale);

} // namespace voile
