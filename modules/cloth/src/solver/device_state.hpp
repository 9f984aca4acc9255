// DeviceState: the buffers of a solver at its present size, and the descriptor sets that bind them.
#pragma once

#include "colliders/collider_model.hpp"
#include "model/model.hpp"
#include "solver/descriptor_sets.hpp"
#include "solver/state_buffers.hpp"

#include "shared/contact_layout.h"
#include "shared/strain_layout.h"

#include "voile/gpu/buffer.hpp"

#include <array>

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

// Everything is allocated, and every set written, when it is made.
struct DeviceState
{
    std::array<gpu::Buffer, buffer::k_numbers> buffers; // by name; those of uploads (VOILE_BUFFER in buffers.h)
    gpu::BindingPool pool;
    DescriptorSets sets;

    uint32_t vertices = 0;
    size_t deforming_vertices = 0;
    size_t deforming_count = 0; // meshes that deform, the first ones of the model
    uint32_t patch_count = 0;
    uint32_t rk4_patches = 0; // the first ones
    uint32_t cloth_count = 0; // of the model's, the first ones
    uint32_t collider_count = 0;
    uint32_t near_stride = 0; // words per patch of near_colliders; 0: there are few colliders, and no lists
    uint32_t feature_count = 0;
    uint32_t anchor_capacity = 0;
    uint32_t attachment_capacity = 0;
    uint32_t tether_capacity = 0;

    const gpu::Buffer& operator[](buffer::Name name) const { return buffers[name]; }
};

// What an upload puts into the buffers beside the models' own arrays.
struct UploadData
{
    Patches patches;
    size_t springs = 0;                           // of all meshes, as they are uploaded
    size_t corners = 0;                           // likewise
    std::vector<shared::FeatureSet> feature_sets; // of all colliders
    size_t features = 0;
    size_t feature_nodes = 0;
    uint32_t anchors = 0; // room for as many
    uint32_t attachments = 0;
    uint32_t tethers = 0;
};

// `statistics`: where the reduction writes, one record a slot.
Result<DeviceState> create_device_state(const gpu::Context& context, const Kernels& kernels, const Model& model,
                                        const ColliderModels& colliders, const UploadData& data,
                                        const gpu::Buffer& statistics);

} // namespace voile
