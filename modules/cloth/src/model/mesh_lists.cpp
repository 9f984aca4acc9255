// Interleaving the lists of a mesh's vertices.
#include "model/mesh_lists.hpp"

#include "geometry/parallel.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace voile
{

namespace
{

constexpr size_t k_blocks = 32; // per piece of work

using Count = uint32_t shared::MeshVertex::*;

uint32_t longest(std::span<const shared::MeshVertex> vertices, Count count)
{
    uint32_t result = 0;
    for (const shared::MeshVertex& vertex : vertices)
        result = std::max(result, vertex.*count);
    return result;
}

// The lists of `vertices` as one workgroup's block from entries[begin] on, zeros where there is none.
template <typename Entry>
void interleave_block(std::span<const shared::MeshVertex> vertices, uint32_t stride, Count first, Count count,
                      const SharedArray<Entry>& source, size_t begin, UninitializedArray<Entry>& entries)
{
    const uint32_t length = longest(vertices, count);
    for (uint32_t entry = 0; entry < length; ++entry)
        for (size_t lane = 0; lane < stride; ++lane)
        {
            const bool exists = lane < vertices.size() && entry < vertices[lane].*count;
            entries[begin++] = exists ? source[vertices[lane].*first + entry] : Entry{};
        }
}

} // namespace

MeshLists interleave(const MeshLists& lists, uint32_t workgroup_size)
{
    const std::span<const shared::MeshVertex> from = lists.vertices;
    const auto block_of = [&](size_t first)
    { return from.subspan(first, std::min<size_t>(workgroup_size, from.size() - first)); };
    UninitializedArray<shared::MeshVertex> vertices(from.size());
    size_t spring = 0;
    size_t corner = 0;
    for (size_t first = 0; first < from.size(); first += workgroup_size)
    {
        const auto block = block_of(first);
        for (size_t lane = 0; lane < block.size(); ++lane)
        {
            shared::MeshVertex& vertex = vertices[first + lane] = block[lane];
            vertex.first_spring = static_cast<uint32_t>(spring + lane);
            vertex.first_corner = static_cast<uint32_t>(corner + lane);
        }
        spring += size_t{longest(block, &shared::MeshVertex::springs)} * workgroup_size;
        corner += size_t{longest(block, &shared::MeshVertex::corners)} * workgroup_size;
    }
    UninitializedArray<shared::MeshSpring> springs(spring);
    UninitializedArray<shared::MeshCorner> corners(corner);
    UninitializedArray<shared::MembraneCorner> membrane(corner);
    parallel_for(from.size(), workgroup_size * k_blocks,
                 [&](size_t begin, size_t end)
                 {
                     for (size_t first = begin; first < end; first += workgroup_size)
                     {
                         const auto block = block_of(first);
                         const shared::MeshVertex& at = vertices[first];
                         interleave_block(block, workgroup_size, &shared::MeshVertex::first_spring,
                                          &shared::MeshVertex::springs, lists.springs, at.first_spring, springs);
                         interleave_block(block, workgroup_size, &shared::MeshVertex::first_corner,
                                          &shared::MeshVertex::corners, lists.corners, at.first_corner, corners);
                         interleave_block(block, workgroup_size, &shared::MeshVertex::first_corner,
                                          &shared::MeshVertex::corners, lists.membrane, at.first_corner, membrane);
                     }
                 });
    return {std::move(vertices), std::move(springs), std::move(corners), std::move(membrane)};
}

} // namespace voile
