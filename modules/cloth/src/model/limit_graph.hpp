// A cloth at rest as a graph: how far neighbors are from each other, and in which direction of the fabric.
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

namespace voile
{

struct ClothModel;

using FabricOffset = std::complex<double>; // m, along warp and weft; of unit length: a turn

// Of a vertex to one near it.
struct LimitGraphLink
{
    uint32_t to = 0;
    FabricOffset offset;  // in the frame of the vertex that has the link
    FabricOffset turn{1}; // takes offsets in the frame of `to` into that frame
    double length = 0;    // m
};

struct LimitGraph
{
    std::vector<uint32_t> vertices; // of the cloth
    std::vector<uint32_t> first;    // link of a vertex; one more entry than vertices
    std::vector<LimitGraphLink> links;
    std::vector<double> masses; // of all that moves with a vertex

    [[nodiscard]] std::span<const LimitGraphLink> links_of(uint32_t i) const
    {
        return std::span(links).subspan(first[i], first[i + 1] - first[i]);
    }
};

// The offset of a link, or of a path, seen from its other end.
inline FabricOffset reversed(const LimitGraphLink& link)
{
    return -std::conj(link.turn) * link.offset;
}

// All vertices of a cloth, with links along the edges of a mesh or the structural and shear springs of a grid.
LimitGraph make_limit_graph(const ClothModel& cloth);

} // namespace voile
