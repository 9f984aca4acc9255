// Which triangles and edges of a mesh belong to which vertex: to the one with the lowest index.
#pragma once

#include "geometry/shared_array.hpp"
#include "model/mesh_lists.hpp"
#include "shared/cloth_layout.h"

#include <cstdint>

namespace voile
{

// Of one mesh whose vertices collide with each other; where parts begin is counted from the mesh's first entry.
struct MeshFans
{
    SharedArray<shared::MeshFan> vertices;
    SharedArray<shared::MeshWedge>
        wedges;                   // in the order of the triangles, then edges without an own triangle beside them
    SharedArray<uint32_t> owners; // of primitives around a vertex, counted within the mesh; but for itself
};

// `lists`: not interleaved. Runs on several threads.
MeshFans make_mesh_fans(const MeshLists& lists);

} // namespace voile
