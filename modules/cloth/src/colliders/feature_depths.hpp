// How far a mesh goes on behind its features.
#pragma once

#include "geometry/bvh.hpp"
#include "shared/feature_layout.h"

#include <span>

namespace voile
{

// Sets the depths of the features of a closed mesh, at most `longest` (m). Runs on several threads.
void find_depths(const Bvh& hierarchy, float longest, std::span<shared::Feature> features);

} // namespace voile
