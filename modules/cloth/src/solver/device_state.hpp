// DeviceState: the buffers of a solver at their present capacity, and the descriptor sets that bind them.
#pragma once

#include "solver/buffer_declarations.hpp"
#include "solver/descriptor_sets.hpp"
#include "solver/state_buffers.hpp"

#include "shared/contact_layout.h"
#include "shared/strain_layout.h"

#include "voile/gpu/buffer.hpp"

#include <array>
#include <optional>
#include <vector>

namespace voile
{

// Of so many cloths, of one step.
constexpr VkDeviceSize votes_bytes(size_t cloths)
{
    return cloths * VOILE_VOTE_WORDS * sizeof(uint32_t);
}

// Of so many cloths.
constexpr VkDeviceSize scales_bytes(size_t cloths)
{
    return cloths * sizeof(shared::LimitScale);
}

// Entries that the solver's arrays need, or have room for. Counts in buffers.h are expressions over these.
struct BufferCounts
{
    uint64_t cloths = 0;
    uint64_t vertices = 0;
    uint64_t patches = 0;
    uint64_t mesh_vertices = 0;
    uint64_t springs = 0;
    uint64_t corners = 0;
    uint64_t colliders = 0;
    uint64_t nodes = 0;
    uint64_t triangles = 0;
    uint64_t deforming_vertices = 0; // of one of the two copies
    uint64_t padded_leaves = 0;
    uint64_t padded_boxes = 0;
    uint64_t near_words = 0; // of all patches
    uint64_t feature_nodes = 0;
    uint64_t features = 0;
    uint64_t anchors = 0;
    uint64_t attachments = 0;
    uint64_t tethers = 0;

    // Entries of each buffer, by name.
    [[nodiscard]] std::array<uint64_t, buffer::k_numbers> entries() const;
};

// Everything is allocated, and every set written, when it is made.
struct DeviceState
{
    std::array<gpu::Buffer, buffer::k_numbers> buffers; // by name; those that uploads allocate
    gpu::BindingPool pool;
    DescriptorSets sets;
    BufferCounts capacities;
    uint32_t vertices = 0;       // that the last upload left in use, with gaps
    uint32_t near_stride = 0;    // words per patch of near_colliders; 0: there are few colliders, and no lists
    uint32_t collider_count = 0; // records that are written; those of removed colliders meet no cloth

    uint32_t patch_count = 0; // that stand in the buffer of patches

    const gpu::Buffer& operator[](buffer::Name name) const { return buffers[name]; }
};

// A copy of a buffer's contents into the larger one that replaces it.
struct GrowthCopy
{
    VkBuffer from;
    VkBuffer to;
    VkDeviceSize bytes;
};

// The buffers that replace those of `present` which are too small, each by half larger at least, and sets that bind
// them. What is not replaced is null here and stays.
struct Growth
{
    DeviceState next;
    std::vector<GrowthCopy> copies;
    bool any = false; // else only the counts of `next` are of use
};

// Nothing changes on an error: out of memory, beyond the device's limits. `statistics`: where the reduction writes.
Result<Growth> grow(const gpu::Context& context, const Kernels& kernels, const DeviceState* present,
                    const BufferCounts& needed, const gpu::Buffer& statistics);

// Takes what grew into `device`, and returns what was replaced.
DeviceState replace_grown(DeviceState& device, Growth growth);

} // namespace voile
