// What resists in a mesh as cloth, one by one: its triangles or the springs along its edges, springs across edges, and
// the folds at them.
#pragma once

#include "model/membrane.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace voile
{

// A triangle seen from one of its edges.
struct MeshSide
{
    uint32_t a; // a < b, the edge
    uint32_t b;
    uint32_t opposite;
    uint32_t triangle;
    int corner;  // of the triangle, where the side begins
    double area; // m^2

    [[nodiscard]] uint64_t key() const { return uint64_t{a} << 32 | b; }
};

// All sides, those of an edge side by side.
std::vector<MeshSide> sides_of(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles);
double triangle_area(std::span<const glm::dvec3> positions, const glm::uvec3& triangle); // m^2

struct ElementSpring
{
    uint32_t a;
    uint32_t b;
    double weight;
    uint32_t edge; // along which it lies or which it crosses
};

// How far two triangles are folded at an edge: sum of factor * x over the corners is the angle times the edge's length,
// along the normal (Bergou et al. 2006, section 3: cotangents of the angles between the edge and its neighbors).
struct Hinge
{
    uint32_t corner[4]; // the edge's ends, the vertices opposite to it
    double factor[4];
    double areas[2];      // m^2, of the triangles
    glm::dvec3 normal[2]; // unit length, of the edge in the plane of either triangle
    uint32_t triangle[2];
    uint32_t edge;
};

struct MeshElements
{
    std::vector<ElementSpring> edges;     // weight: 1
    std::vector<ElementSpring> opposites; // weight: 1/m^2
    std::vector<Hinge> hinges;
    std::vector<MembraneTriangle> triangles; // of a fabric
};

// The springs and folds of an edge, given all of its sides; it is noted with the triangles, if there are any.
void add_edge(std::span<const glm::dvec3> positions, std::span<const MeshSide> sides, MeshElements& elements);

// Softens slivers. A sliver is a triangle of nearly no height. Its edges connect vertices of nearly no mass or are
// shorter than all others, and its folds turn over when a vertex moves by its height. One of them would set the
// substeps of the whole cloth. An element that is far stiffer, relative to the mass it moves, than nearly all others of
// its kind gets the stiffness of the stiffest other (MeshCloth has the rule). An element is softened as a whole, so
// forces stay equal and opposite, bending energies positive, and bounds of the result valid. Returns the number of
// edges with a softened element.
//
// `areas`: of the vertices. `uniform_masses`: masses are not in proportion to them and springs have no weights, so only
// folds are softened.
uint32_t soften_slivers(MeshElements& elements, std::span<const double> areas, bool uniform_masses);

} // namespace voile
