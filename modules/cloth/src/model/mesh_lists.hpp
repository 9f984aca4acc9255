// The lists of a mesh's vertices as they are uploaded.
#pragma once

#include "geometry/shared_array.hpp"
#include "shared/cloth_layout.h"

#include <cstdint>

namespace voile
{

// Of one mesh; where lists begin is counted from the mesh's first entry.
struct MeshLists
{
    SharedArray<shared::MeshVertex> vertices;
    SharedArray<shared::MeshSpring> springs;
    SharedArray<shared::MeshCorner> corners;
    SharedArray<shared::MembraneCorner> membrane; // one for each of these
};

// Those of a workgroup's vertices interleaved: their first entries side by side, then their second ones, each list as
// long as the longest of the workgroup. Runs on several threads.
MeshLists interleave(const MeshLists& lists, uint32_t workgroup_size);

} // namespace voile
