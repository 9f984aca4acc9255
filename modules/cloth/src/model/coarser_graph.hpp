// The next level of a graph, with about a quarter of its vertices.
#pragma once

#include "model/limit_graph.hpp"
#include "shared/strain_layout.h"

#include <cstdint>
#include <span>
#include <vector>

namespace voile
{

// How a vertex that leaves moves with those that stay.
struct LimitParents
{
    uint32_t vertex = 0;                      // of the level
    std::vector<shared::LimitParent> parents; // of the next one
};

struct CoarserGraph
{
    LimitGraph level;
    std::vector<LimitParents> parents; // of the vertices that it lacks
};

// `pinned`: of each vertex of the cloth, whether it is; such a vertex is on the next level before others, so that all
// levels know what holds the cloth. No links: there is no next level. Runs on several threads.
CoarserGraph coarsen(const LimitGraph& fine, std::span<const uint8_t> pinned);

} // namespace voile
