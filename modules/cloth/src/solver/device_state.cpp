// DeviceState: allocation and growth.
#include "solver/device_state.hpp"

#include "colliders/collider_model.hpp"
#include "model/range_allocator.hpp"

#include "shared/collider_layout.h"
#include "shared/pair_layout.h"
#include "shared/step_layout.h"

#include <algorithm>

namespace voile
{

namespace
{

constexpr uint64_t BufferCounts::*k_counts[] = {
    &BufferCounts::cloths,
    &BufferCounts::vertices,
    &BufferCounts::patches,
    &BufferCounts::mesh_vertices,
    &BufferCounts::springs,
    &BufferCounts::corners,
    &BufferCounts::fans,
    &BufferCounts::wedges,
    &BufferCounts::owners,
    &BufferCounts::limit_vertices,
    &BufferCounts::limit_levels,
    &BufferCounts::limit_links,
    &BufferCounts::limit_parents,
    &BufferCounts::colliders,
    &BufferCounts::nodes,
    &BufferCounts::triangles,
    &BufferCounts::padded_leaves,
    &BufferCounts::padded_boxes,
    &BufferCounts::deforming_vertices,
    &BufferCounts::near_words,
    &BufferCounts::features,
    &BufferCounts::feature_nodes,
    &BufferCounts::feature_sources,
    &BufferCounts::feature_hinges,
    &BufferCounts::feature_slots,
    &BufferCounts::featured_vertices,
    &BufferCounts::feature_items,
    &BufferCounts::anchors,
    &BufferCounts::attachments,
    &BufferCounts::tethers,
    &BufferCounts::previous_vertices,
    &BufferCounts::cloth_triangles,
    &BufferCounts::pair_vertices,
    &BufferCounts::cloth_trees,
    &BufferCounts::cloth_leaves,
    &BufferCounts::cloth_boxes,
    &BufferCounts::bvh_edges,
    &BufferCounts::intersecting_vertices,
};
static_assert(sizeof(BufferCounts) == std::size(k_counts) * sizeof(uint64_t));

bool fits(const BufferCounts& counts, uint64_t max_bytes)
{
    const auto entries = counts.entries();
    return std::ranges::all_of(
        buffer_declarations(), [&](const BufferDeclaration& declared)
        { return declared.number >= entries.size() || entries[declared.number] * declared.entry_bytes <= max_bytes; });
}

// Room for `needed`. A count that must grow grows by at least half, if the device can bind that.
BufferCounts grown(const BufferCounts& present, const BufferCounts& needed, uint64_t max_bytes)
{
    BufferCounts roomy = present;
    BufferCounts exact = present;
    for (uint64_t BufferCounts::*count : k_counts)
    {
        roomy.*count = grown_capacity(present.*count, needed.*count, UINT64_MAX);
        exact.*count = std::max(present.*count, needed.*count);
    }
    return fits(roomy, max_bytes) ? roomy : exact;
}

// Words per patch of the lists of near colliders; 0 for a few colliders, or if the lists would be too large.
uint32_t near_stride(uint64_t colliders, const BufferCounts& capacities, uint64_t max_bytes)
{
    const auto stride = static_cast<uint32_t>(VOILE_NEAR_WORDS + (capacities.colliders + 31) / 32);
    const bool fits = capacities.patches * stride * sizeof(uint32_t) <= max_bytes;
    return colliders > VOILE_NEAR_LISTS_ABOVE && fits ? stride : 0;
}

// What buffers have beside the usages of all: the vertex streams those that the host asks for.
VkBufferUsageFlags usage_of(uint32_t number, VkBufferUsageFlags stream_usage)
{
    switch (number)
    {
    case buffer::indices:
        return stream_usage | VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
    case buffer::positions:
    case buffer::velocities:
    case buffer::normals:
    case buffer::previous_positions:
    case buffer::intersections:
        return stream_usage;
    case buffer::step_inputs:
        return VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
    default:
        return 0;
    }
}

Result<gpu::Buffer> create(const gpu::Context& context, const BufferDeclaration& declared, uint64_t entries,
                           VkBufferUsageFlags usage)
{
    constexpr VkBufferUsageFlags k_usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                                           VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                           VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const std::string name = std::string("cloth ") + declared.name;
    return gpu::create_buffer(context, name.c_str(), entries * declared.entry_bytes, k_usage | usage, Memory::device);
}

// The buffers that must be larger than they are.
Result<void> create_buffers(const gpu::Context& context, const DeviceState* present, VkBufferUsageFlags stream_usage,
                            Growth& growth)
{
    const auto before = present != nullptr ? present->capacities.entries() : BufferCounts{}.entries();
    const auto entries = growth.next.capacities.entries();
    for (const BufferDeclaration& declared : buffer_declarations())
    {
        const uint32_t number = declared.number;
        const bool output = declared.kind == BufferKind::output;
        if (declared.kind != BufferKind::kept && declared.kind != BufferKind::scratch && !output)
            continue;
        if (output && entries[number] == 0)
            continue;
        if (present != nullptr && entries[number] <= before[number])
            continue;
        auto created = create(context, declared, entries[number], usage_of(number, stream_usage));
        if (!created)
            return created.error();
        growth.next.buffers[number] = std::move(created.value());
        growth.any = true;
        if (declared.kind != BufferKind::scratch && before[number] > 0)
            growth.copies.push_back({present->buffers[number].handle(), growth.next.buffers[number].handle(),
                                     before[number] * declared.entry_bytes});
    }
    return {};
}

} // namespace

std::array<uint64_t, buffer::k_numbers> BufferCounts::entries() const
{
    std::array<uint64_t, buffer::k_numbers> entries{};
#define VOILE_BUFFER(number, name, entry, count, meaning) entries[number] = (count);
#include "shared/buffers.h"
    return entries;
}

Result<Growth> grow(const gpu::Context& context, const Kernels& kernels, const DeviceState* present,
                    const BufferCounts& needed, const gpu::Buffer& statistics, VkBufferUsageFlags stream_usage)
{
    const BufferCounts capacities = present != nullptr ? present->capacities : BufferCounts{};
    Growth growth;
    DeviceState& next = growth.next;
    next.capacities = grown(capacities, needed, context.max_buffer_bytes);
    next.vertices = static_cast<uint32_t>(needed.vertices);
    next.collider_count = static_cast<uint32_t>(needed.colliders);
    next.near_stride = near_stride(needed.colliders, next.capacities, context.max_buffer_bytes);
    next.capacities.near_words = std::max(capacities.near_words, next.capacities.patches * uint64_t{next.near_stride});
    if (auto created = create_buffers(context, present, stream_usage, growth); !created)
        return created.error();
    if (!growth.any)
        return growth;
    BufferHandles handles = handles_after(present, next);
    handles[buffer::statistics] = statistics.handle();
    auto pool = write_sets(next.sets, context, kernels, handles);
    if (!pool)
        return pool.error();
    next.pool = std::move(pool.value());
    return growth;
}

BufferHandles handles_after(const DeviceState* present, const DeviceState& next)
{
    BufferHandles handles{};
    for (size_t i = 0; i < handles.size(); ++i)
        handles[i] = next.buffers[i] || present == nullptr ? next.buffers[i].handle() : present->buffers[i].handle();
    return handles;
}

DeviceState replace_grown(DeviceState& device, Growth growth)
{
    DeviceState& next = growth.next;
    device.vertices = next.vertices;
    device.near_stride = next.near_stride;
    device.collider_count = next.collider_count;
    if (!growth.any)
        return {};
    for (size_t i = 0; i < device.buffers.size(); ++i)
        if (next.buffers[i])
            std::swap(device.buffers[i], next.buffers[i]);
    std::swap(device.pool, next.pool);
    device.sets = next.sets;
    device.capacities = next.capacities;
    return std::move(next);
}

} // namespace voile
