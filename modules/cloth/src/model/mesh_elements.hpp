// What resists in a mesh as cloth, one by one: its triangles or the springs along its edges, springs across edges, and
// the folds at them.
#pragma once

#include "voile/descriptions.hpp"

#include "geometry/uninitialized_array.hpp"
#include "model/membrane.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace voile
{

struct Edge
{
    uint32_t a; // a < b
    uint32_t b;
};

// From one side of an edge to the other.
struct OppositeSpring
{
    uint32_t a;
    uint32_t b;
    double weight; // 1/m^2
};

// How far two triangles are folded at an edge: sum of factor * x over the corners is the angle times the edge's length,
// along the normal (Bergou et al. 2006, section 3: cotangents of the angles between the edge and its neighbors).
struct Hinge
{
    uint32_t corner[4]; // the edge's ends, the vertices opposite to it in either triangle
    double factor[4];
    uint32_t triangle[2];
    uint32_t edge;
};

struct MeshElements
{
    UninitializedArray<Edge> edges;                 // by a, then by b
    UninitializedArray<OppositeSpring> opposites;   // one per hinge
    UninitializedArray<Hinge> hinges;               // in the order of their edges
    UninitializedArray<MembraneTriangle> triangles; // of a fabric
};

// A mesh's triangles, all of them with an area.
struct SolidTriangles
{
    std::vector<glm::uvec3> corners;
    std::vector<double> areas; // m^2
};

// `fabric`: of the membrane; none: springs along the edges. Counts the report's edges and finds the shortest one. Runs
// on several threads.
MeshElements make_elements(std::span<const glm::dvec3> positions, const SolidTriangles& triangles,
                           const FabricCoordinates* fabric, MeshReport& report);

// Softens slivers. A sliver is a triangle of nearly no height. Its edges connect vertices of nearly no mass or are
// shorter than all others, and its folds turn over when a vertex moves by its height. One of them would set the
// substeps of the whole cloth. An element that is far stiffer, relative to the mass it moves, than nearly all others of
// its kind gets the stiffness of the stiffest other (MeshCloth has the rule). An element is softened as a whole, so
// forces stay equal and opposite, bending energies positive, and bounds of the result valid. Returns the number of
// edges with a softened element.
//
// `areas`: of the vertices. `uniform_masses`: masses are not in proportion to them and springs have no weights, so only
// folds are softened. Runs on several threads.
uint32_t soften_slivers(MeshElements& elements, const SolidTriangles& triangles, std::span<const double> areas,
                        bool uniform_masses);

} // namespace voile
