// DeviceState: allocation.
#include "solver/device_state.hpp"

#include "solver/buffer_declarations.hpp"

namespace voile
{

namespace
{

// What the counts in buffers.h may name.
struct BufferCounts
{
    const Model& model;
    const ColliderModels& collider_models;
    const UploadData& data;
    size_t cloths;
    size_t vertices;
    size_t patches;
    size_t colliders;
    size_t deforming_vertices; // of one of the two copies
    size_t near_stride;        // words per patch
    size_t anchors;
    size_t attachments;
    size_t tethers;

    // Entries of each buffer, by name.
    [[nodiscard]] std::array<uint64_t, buffer::k_numbers> entries() const
    {
        std::array<uint64_t, buffer::k_numbers> entries{};
#define VOILE_BUFFER(number, name, entry, count, meaning) entries[number] = (count);
#include "shared/buffers.h"
        return entries;
    }
};

Result<void> create_buffers(const gpu::Context& context, DeviceState& state, const BufferCounts& counts)
{
    constexpr VkBufferUsageFlags k_usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                                           VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                           VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const auto entries = counts.entries();
    for (const BufferDeclaration& declared : buffer_declarations())
    {
        if (declared.kind != BufferKind::uploaded)
            continue;
        const std::string name = std::string("cloth ") + declared.name;
        auto created = gpu::create_buffer(context, name.c_str(), entries[declared.number] * declared.entry_bytes,
                                          k_usage, Memory::device);
        if (!created)
            return created.error();
        state.buffers[declared.number] = std::move(created.value());
    }
    return {};
}

// Words per patch of the lists of near colliders; none for a few colliders, nor where the lists would be too large.
uint32_t near_stride(uint32_t colliders, uint32_t patches, uint64_t max_bytes)
{
    const uint32_t stride = VOILE_NEAR_WORDS + (colliders + 31) / 32;
    const bool fits = uint64_t{patches} * stride * sizeof(uint32_t) <= max_bytes;
    return colliders > VOILE_NEAR_FEW && fits ? stride : 0;
}

} // namespace

Result<DeviceState> create_device_state(const gpu::Context& context, const Kernels& kernels, const Model& model,
                                        const ColliderModels& colliders, const UploadData& data,
                                        const gpu::Buffer& statistics)
{
    DeviceState state;
    state.vertices = model.vertices;
    state.patch_count = static_cast<uint32_t>(data.patches.patches.size());
    state.deforming_vertices = colliders.deforming_positions;
    state.deforming_count = colliders.deforming.size();
    state.rk4_patches = data.patches.rk4;
    state.anchor_capacity = data.anchors;
    state.attachment_capacity = data.attachments;
    state.tether_capacity = data.tethers;
    state.feature_count = static_cast<uint32_t>(data.features);
    state.cloth_count = static_cast<uint32_t>(model.cloths.size());
    state.collider_count = static_cast<uint32_t>(colliders.colliders.size());
    state.near_stride = near_stride(state.collider_count, state.patch_count, model.limits.max_buffer_bytes);
    const BufferCounts counts{.model = model,
                              .collider_models = colliders,
                              .data = data,
                              .cloths = model.cloths.size(),
                              .vertices = state.vertices,
                              .patches = state.patch_count,
                              .colliders = state.collider_count,
                              .deforming_vertices = state.deforming_vertices / 2,
                              .near_stride = state.near_stride,
                              .anchors = data.anchors,
                              .attachments = data.attachments,
                              .tethers = data.tethers};
    if (auto created = create_buffers(context, state, counts); !created)
        return created.error();
    BufferHandles handles{};
    for (size_t i = 0; i < handles.size(); ++i)
        handles[i] = state.buffers[i].handle();
    handles[buffer::statistics] = statistics.handle();
    auto pool = write_sets(state.sets, context, kernels, handles);
    if (!pool)
        return pool.error();
    state.pool = std::move(pool.value());
    return state;
}

} // namespace voile
