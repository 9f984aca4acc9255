// Interleaving the lists of a mesh's vertices.
#include "model/mesh_lists.hpp"

#include <algorithm>
#include <span>

namespace voile
{

namespace
{

// Appends the lists of `vertices` as one workgroup's block to `entries`.
template <typename Entry>
void interleave_block(std::span<const shared::MeshVertex> vertices, uint32_t stride,
                      uint32_t shared::MeshVertex::*first, uint32_t shared::MeshVertex::*count,
                      std::span<const Entry> source, std::vector<Entry>& entries)
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
    MeshLists result;
    result.vertices = lists.vertices;
    const std::span<shared::MeshVertex> vertices = result.vertices;
    for (size_t first = 0; first < vertices.size(); first += workgroup_size)
    {
        const auto block = vertices.subspan(first, std::min<size_t>(workgroup_size, vertices.size() - first));
        const auto first_spring = static_cast<uint32_t>(result.springs.size());
        const auto first_corner = static_cast<uint32_t>(result.corners.size());
        interleave_block<shared::MeshSpring>(block, workgroup_size, &shared::MeshVertex::first_spring,
                                             &shared::MeshVertex::springs, lists.springs, result.springs);
        interleave_block<shared::MeshCorner>(block, workgroup_size, &shared::MeshVertex::first_corner,
                                             &shared::MeshVertex::corners, lists.corners, result.corners);
        interleave_block<shared::MembraneCorner>(block, workgroup_size, &shared::MeshVertex::first_corner,
                                                 &shared::MeshVertex::corners, lists.membrane, result.membrane);
        for (uint32_t lane = 0; lane < block.size(); ++lane)
        {
            block[lane].first_spring = first_spring + lane;
            block[lane].first_corner = first_corner + lane;
        }
    }
    return result;
}

} // namespace voile
