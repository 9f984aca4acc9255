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

// Every pair that has any and whose lower vertex is one of begin .. end - 1, once, there: pair i of
// first[a - begin] .. first[a - begin + 1] is a and others[i], in ascending order.
struct MeshPairs
{
    uint32_t begin = 0;
    uint32_t end = 0;
    std::vector<uint32_t> first; // one per vertex, then the number of pairs
    std::vector<uint32_t> others;
    std::vector<PairSums> sums;

    [[nodiscard]] bool owns(uint32_t low) const { return begin <= low && low < end; }
};

// Consecutive, for all vertices. `isometric`: folds bend by the isometric model. Runs on several threads. Each sum is
// made by one of them in the order of the elements, so its bits do not depend on the number of threads.
std::vector<MeshPairs> make_pairs(const MeshElements& elements, std::span<const glm::dvec3> positions,
                                  const SolidTriangles& triangles, bool isometric);

} // namespace voile
