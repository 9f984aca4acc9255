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

// Solids are where the stage has moved them to, as it has deformed them; a cloth is held against those of its layers. A
// closed mesh is solid inside, a plane below; a mesh with one side behind its triangles, one with two where a vertex
// did not start. An open mesh whose triangles face one way (a ground) is solid on the side where a cloth's vertices did
// not start; past its border it says nothing. In any other open mesh, inside is where it winds around a point by more
// than a half; a vertex may have come there through an opening.
gpu::Result<Verification> verify(const Stage& stage, const std::vector<Solid>& solids,
                                 const std::vector<FinalCloth>& state);

} // namespace viewer
