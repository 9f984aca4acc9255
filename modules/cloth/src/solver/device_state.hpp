// DeviceState: the buffers of a solver at its present size, and the descriptor sets that bind them.
#pragma once

#include "colliders/collider_features.hpp"
#include "model/model.hpp"
#include "solver/kernels.hpp"

#include "shared/contact_layout.h"
#include "shared/statistics_layout.h"
#include "shared/strain_layout.h"

#include "voile/gpu/buffer.hpp"

#include <array>

namespace voile
{

struct StateBuffers
{
    gpu::Buffer positions;
    gpu::Buffer residuals; // of the positions, what floats do not hold of them (fine_position.glsl)
    gpu::Buffer velocities;
};

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
    gpu::Buffer cloths;
    gpu::Buffer patches;
    gpu::Buffer mesh_vertices;
    gpu::Buffer mesh_springs;
    gpu::Buffer mesh_corners;
    gpu::Buffer membrane_corners;
    gpu::Buffer colliders;
    gpu::Buffer collider_motions;
    gpu::Buffer deforming_input;     // what the host gives for deforming meshes, as it gives it
    gpu::Buffer deforming_positions; // of deforming meshes, twice each: where the step starts and where it ends
    gpu::Buffer padded_leaves;
    gpu::Buffer padded_boxes;
    gpu::Buffer nodes;
    gpu::Buffer triangles;
    gpu::Buffer feature_sets; // corners and edges of colliders
    gpu::Buffer feature_nodes;
    gpu::Buffer features;
    gpu::Buffer feature_corrections;           // what they change of vertices
    gpu::Buffer feature_patches;               // those that come near features
    gpu::Buffer feature_dispatch;              // and how many they are: workgroups of the pass over them
    std::array<gpu::Buffer, 2> recovery_votes; // of each cloth, of this step and the next
    gpu::Buffer depenetrations; // how vertices inside of colliders come out, after two sizes of the pass over them
    gpu::Buffer near_colliders; // of each patch, if there are many
    gpu::Buffer start;          // places at the start, and what density multiplies
    gpu::Buffer start_residuals;
    gpu::Buffer anchors;
    gpu::Buffer attachments;
    gpu::Buffer tethers;
    StateBuffers state;              // what the cloth is between steps
    StateBuffers stage_a;            // written by stage 1
    StateBuffers stage_b;            // by stages 2 and 4
    StateBuffers stage_c;            // by stage 3
    gpu::Buffer candidate_places;    // where the lists of triangles near each vertex hold
    gpu::Buffer candidate_triangles; // their length, two radii, and the triangles
    gpu::Buffer normals;
    gpu::Buffer partials;                   // statistics, one record a patch
    std::array<gpu::Buffer, 4> limit_works; // of the strain limit, one record per patch: see limit_work.comp
    gpu::Buffer limit_scales;               // per cloth, of what it has changed
    StateBuffers step_start;                // where cloths with a strain limit were when the step began

    gpu::BindingPool pool;
    // What goes on from the state, and from stage B where contact leaves there what it changes.
    std::array<std::array<VkDescriptorSet, 4>, 2> stages{};
    VkDescriptorSet last_stage_alone{}; // stage 4 when no contact pass follows: it writes the state itself
    // Velocity Verlet goes from the state to stage B, with predictions in the velocities of stages A and C.
    VkDescriptorSet verlet_first{};     // state to stage B: the velocities are those of the positions' time
    VkDescriptorSet verlet_forth{};     // state to stage B
    VkDescriptorSet verlet_back{};      // stage B to state
    VkDescriptorSet verlet_last{};      // velocities of the state alone
    VkDescriptorSet verlet_last_back{}; // stage B to state
    VkDescriptorSet pins{};
    std::array<VkDescriptorSet, 2> proposed_attachments{}; // of stage B, of the state
    std::array<VkDescriptorSet, 2> proposed_tethers{};
    VkDescriptorSet strain_first{};              // state to stage B
    VkDescriptorSet strain_back{};               // stage B to stage A
    VkDescriptorSet strain_forth{};              // stage A to stage B
    std::array<VkDescriptorSet, 4> limit_work{}; // each with the forces at one end of the step or of the limit
    VkDescriptorSet limit_scale{};
    VkDescriptorSet limit_guard{};
    VkDescriptorSet edit{};
    std::array<VkDescriptorSet, 2> contact{}; // of what stage B proposes, of what the state does
    VkDescriptorSet collider_reach{};
    VkDescriptorSet feature_reach{};
    // Corrections of stage B, of the state; with the votes of an even step, of an odd one.
    std::array<std::array<VkDescriptorSet, 2>, 2> feature_contact{};
    std::array<VkDescriptorSet, 2> recover{}; // each writes one of the sizes
    VkDescriptorSet deform{};
    VkDescriptorSet refit{};
    VkDescriptorSet normals_set{};
    VkDescriptorSet statistics{};
    VkDescriptorSet statistics_reduce{};

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
};

// What an upload puts into the buffers beside the model's own arrays.
struct UploadData
{
    Patches patches;
    MeshLists lists;
    FeatureLists features;
    uint32_t anchors = 0; // room for as many
    uint32_t attachments = 0;
    uint32_t tethers = 0;
};

// `statistics`: where the reduction writes, one record a slot.
gpu::Result<DeviceState> create_device_state(const gpu::Context& context, const Kernels& kernels, const Model& model,
                                             const UploadData& data, const gpu::Buffer& statistics);

} // namespace voile
