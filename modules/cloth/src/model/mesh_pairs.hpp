// Pairs of vertices of a mesh: the sum of what its elements have between them.
#pragma once

#include "model/mesh_elements.hpp"

#include <cstdint>
#include <vector>

namespace voile
{

// What a pair of vertices has: a spring along an edge or across one, the isometric model's coefficient, or several of
// them.
struct PairSums
{
    double edge = 0;     // weight of the spring along the edge between them; 0: none
    double opposite = 0; // weights of the springs across edges; 0: none
    double bending = 0;
};

// Every pair that has any, once, at its lower vertex a: pair i of first[a] .. first[a + 1] is a and others[i], in
// ascending order.
struct MeshPairs
{
    std::vector<uint32_t> first; // one per vertex, then the number of pairs
    std::vector<uint32_t> others;
    std::vector<PairSums> sums;
};

// `isometric`: folds bend by the isometric model. Each sum is made in the order of the elements, so that its bits do
// not depend on how pairs are found.
MeshPairs make_pairs(const MeshElements& elements, size_t vertices, size_t triangles, bool isometric);

} // namespace voile
