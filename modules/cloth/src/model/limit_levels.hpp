// The levels of the strain limit on a cloth without lines: ever fewer of its vertices, with links between those that
// are near each other over the cloth. Corrections between far vertices reach all of it in a few passes.
#pragma once

#include "geometry/shared_array.hpp"
#include "shared/strain_layout.h"

#include <cstdint>
#include <vector>

namespace voile
{

struct ClothModel;

// Of one cloth; where lists begin is counted from its first entry. Level 0 has all vertices.
struct LimitLevels
{
    SharedArray<shared::LimitVertex> vertices;
    SharedArray<shared::LimitVertex> wide; // the entries after them
    SharedArray<shared::LimitLevel> levels;
    SharedArray<shared::LimitLink> links;
    SharedArray<shared::LimitParent> parents;
    uint32_t count = 0;  // of levels
    uint32_t narrow = 0; // of the levels that limit_strain.comp takes; limit_coarse.comp takes the others
};

// Whether the levels of a cloth are to be listed: those of a grid are its lines, unless it has pins between them or
// masses of its own.
bool needs_limit_levels(const ClothModel& cloth);

// Those without an inverse mass, those that are pinned to anchors, and those that a max-distance constraint keeps
// within the length of a spring, in ascending order.
std::vector<uint32_t> pinned_vertices(const ClothModel& cloth);

// Pinned vertices are on a level before others, so that all levels know what holds the cloth. Runs on several threads.
LimitLevels make_limit_levels(const ClothModel& cloth);

} // namespace voile
