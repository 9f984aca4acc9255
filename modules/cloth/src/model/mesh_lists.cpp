// Interleaving the lists of a mesh's vertices.
#include "model/mesh_lists.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace voile
{

namespace
{

// Appends the lists of `vertices` as one workgroup's block to `entries`.
template <typename Entry>
void interleave_block(std::span<const shared::MeshVertex> vertices, uint32_t stride,
                      uint32_t shared::MeshVertex::*first, uint32_t shared::MeshVertex::*count,
                      const SharedArray<Entry>& source, std::vector<Entry>& entries)
{
    uint32_t longest = 0;
    for (const shared::MeshVertex& vertex : vertices)
        longest = std::max(longest, vertex.*count);
    const size_t begin = entries.size();
    entries.resize(begin + size_t{longest} * stride);
    for (size_t lane = 0; lane < vertices.size(); ++lane)
        for (uint32_t entry = 0; entry < vertices[lane].*count; ++entry)
            entries[begin + lane + size_t{entry} * stride] = source[vertices[lane].*first + entry];
}

} // namespace

MeshLists interleave(const MeshLists& lists, uint32_t workgroup_size)
{
    std::vector<shared::MeshVertex> all(lists.vertices.begin(), lists.vertices.end());
    std::vector<shared::MeshSpring> springs;
    std::vector<shared::MeshCorner> corners;
    std::vector<shared::MembraneCorner> membrane;
    const std::span<shared::MeshVertex> vertices = all;
    for (size_t first = 0; first < vertices.size(); first += workgroup_size)
    {
        const auto block = vertices.subspan(first, std::min<size_t>(workgroup_size, vertices.size() - first));
        const auto first_spring = static_cast<uint32_t>(springs.size());
        const auto first_corner = static_cast<uint32_t>(corners.size());
        interleave_block<shared::MeshSpring>(block, workgroup_size, &shared::MeshVertex::first_spring,
                                             &shared::MeshVertex::springs, lists.springs, springs);
        interleave_block<shared::MeshCorner>(block, workgroup_size, &shared::MeshVertex::first_corner,
                                             &shared::MeshVertex::corners, lists.corners, corners);
        interleave_block<shared::MembraneCorner>(block, workgroup_size, &shared::MeshVertex::first_corner,
                                                 &shared::MeshVertex::corners, lists.membrane, membrane);
        for (uint32_t lane = 0; lane < block.size(); ++lane)
        {
            block[lane].first_spring = first_spring + lane;
            block[lane].first_corner = first_corner + lane;
        }
    }
    return {std::move(all), std::move(springs), std::move(corners), std::move(membrane)};
}

} // namespace voile
