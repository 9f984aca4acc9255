// --verify: exact checks of a final state, on the host in double precision.
#pragma once

#include "samples/viewer/colliders.hpp"
#include "samples/viewer/run_statistics.hpp"

namespace viewer
{

struct Verification
{
    uint64_t penetrating_vertices = 0; // of all cloths, under the surface of a solid
    double deepest_penetration = 0;    // m
    uint64_t self_intersections = 0;   // pairs of a cloth's triangles that cut each other
};

// Solids are where the stage has moved them to, as it has deformed them; a cloth is held against those of its layers.
// What is inside a solid is what voile::Statistics says, and where that has no inside, where a vertex started decides:
// of a closed mesh with two sides, the other side of it is solid; of an open mesh whose triangles all face one way (a
// ground), the other side, or with one side the back; past its border that says nothing.
voile::Result<Verification> verify(const Stage& stage, const std::vector<Solid>& solids,
                                   const std::vector<FinalCloth>& state);

} // namespace viewer
