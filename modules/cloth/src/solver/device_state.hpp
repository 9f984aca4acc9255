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

// Bytes of the votes of one step.
constexpr VkDeviceSize votes_bytes(size_t cloths)
{
    return cloths * VOILE_VOTE_WORDS * sizeof(uint32_t);
}

// Bytes of the scales of strain limits.
constexpr VkDeviceSize scales_bytes(size_t cloths)
{
    return cloths * sizeof(shared::LimitScale);
}

// Of a cloth whose strain limit has not removed any energy yet.
constexpr shared::LimitScale k_first_scale{1, 1, 0, 1, 0, 0};

// Entries that the solver's arrays need, or have room for. Counts in buffers.h are expressions over these.
struct BufferCounts
{
    uint64_t cloths = 0;
    uint64_t vertices = 0;
    uint64_t patches = 0;
    uint64_t mesh_vertices = 0;
    uint64_t springs = 0;
    uint64_t corners = 0;
    uint64_t fans = 0;
    uint64_t wedges = 0;
    uint64_t owners = 0;
    uint64_t limit_vertices = 0;
    uint64_t limit_levels = 0;
    uint64_t limit_links = 0;
    uint64_t limit_parents = 0;
    uint64_t colliders = 0;
    uint64_t nodes = 0;
    uint64_t triangles = 0;
    uint64_t deforming_vertices = 0; // of one of the two copies
    uint64_t padded_leaves = 0;
    uint64_t padded_boxes = 0;
    uint64_t near_words = 0; // of all patches
    uint64_t feature_nodes = 0;
    uint64_t features = 0;
    uint64_t feature_sources = 0; // of meshes that deform
    uint64_t feature_hinges = 0;
    uint64_t feature_slots = 0;
    uint64_t featured_vertices = 0; // 0 unless a collider has features
    uint64_t feature_items = 0;
    uint64_t anchors = 0;
    uint64_t attachments = 0;
    uint64_t tethers = 0;
    uint64_t previous_vertices = 0; // 0 unless the host asks for previous positions
    uint64_t cloth_triangles = 0;   // 0 unless the host asks for indices
    uint64_t pair_vertices = 0;     // 0 unless a cloth collides with itself
    uint64_t cloth_trees = 0;       // 0 without SolverOptions::intersections unless a cloth collides with itself
    uint64_t cloth_leaves = 0;
    uint64_t cloth_boxes = 0;
    uint64_t bvh_edges = 0; // 0 without SolverOptions::intersections, as the next one
    uint64_t intersecting_vertices = 0;

    // Entries of each buffer, by name.
    [[nodiscard]] std::array<uint64_t, buffer::k_numbers> entries() const;
};

// The cloths that collide with themselves and each other.
struct PairCloths
{
    uint32_t count = 0;
    uint32_t end = 0; // of their indices
};

struct DeviceState
{
    std::array<gpu::Buffer, buffer::k_numbers> buffers; // by name; those that uploads allocate
    gpu::BindingPool pool;
    DescriptorSets sets;
    BufferCounts capacities;
    uint32_t vertices = 0;       // in use since the last upload, with gaps
    uint32_t near_stride = 0;    // words per patch of near_colliders; 0: there are few colliders, and no lists
    uint32_t collider_count = 0; // records that are written; no cloth collides with those of removed colliders

    uint32_t patch_count = 0; // in the buffer of patches
    uint32_t pair_places = 0; // in the order of pairs, those of disabled and removed cloths included
    PairCloths pair_cloths;
    TreeCounts tree_counts{}; // in the buffer of trees

    const gpu::Buffer& operator[](buffer::Name name) const { return buffers[name]; }
};

// A copy of a buffer's contents into the larger one that replaces it.
struct GrowthCopy
{
    VkBuffer from;
    VkBuffer to;
    VkDeviceSize bytes;
};

// The buffers that replace those of `present` that are too small, each at least half larger, and sets that bind them.
// A buffer that stays is null here.
struct Growth
{
    DeviceState next;
    std::vector<GrowthCopy> copies;
    bool any = false; // else `next` has only counts
};

// Nothing changes on an error: out of memory, beyond the device's limits. `statistics`: where the reduction writes.
// `stream_usage`: of the vertex streams, beside what all buffers have.
Result<Growth> grow(const gpu::Context& context, const Kernels& kernels, const DeviceState* present,
                    const BufferCounts& needed, const gpu::Buffer& statistics, VkBufferUsageFlags stream_usage);

// The buffers of `present`, if any, but those of `next` where it has one.
BufferHandles handles_after(const DeviceState* present, const DeviceState& next);

// Moves the new buffers into `device` and returns the replaced ones.
DeviceState replace_grown(DeviceState& device, Growth growth);

} // namespace voile
