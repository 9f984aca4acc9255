// DescriptorSets: which buffer each binding of each kernel has.
#pragma once

#include "solver/kernels.hpp"

#include "shared/bindings.h"

#include <array>
#include <vector>

namespace voile
{

// The buffer of a role in one set.
struct RoleBuffer
{
    binding::Name binding;
    buffer::Name buffer;
};

// Buffers of each of a kernel's bindings, in their order: that of the role, or the buffer of the same name. Errors,
// which name the kernel and the binding: a role without a buffer or with two, one that the kernel does not have, a
// binding that buffers.h does not declare, entries of another type or size than declared.
Result<std::vector<buffer::Name>> resolve(const gpu::Kernel& kernel, std::span<const RoleBuffer> roles);

struct DescriptorSets
{
    // Index 0: the substep begins in the state; 1: in stage B, where contact has left the state.
    std::array<std::array<VkDescriptorSet, 4>, 2> stages{};
    VkDescriptorSet last_stage_alone{}; // stage 4 when no contact pass follows: it writes the state itself
    // Velocity Verlet: from the state to stage B, with predictions in the velocities of stages A and C.
    VkDescriptorSet verlet_first{};     // state to stage B: the velocities are those of the positions' time
    VkDescriptorSet verlet_forth{};     // state to stage B
    VkDescriptorSet verlet_back{};      // stage B to state
    VkDescriptorSet verlet_last{};      // velocities of the state alone
    VkDescriptorSet verlet_last_back{}; // stage B to state
    VkDescriptorSet pins{};
    std::array<VkDescriptorSet, 2> proposed_attachments{}; // of stage B, of the state
    std::array<VkDescriptorSet, 2> proposed_tethers{};
    std::array<VkDescriptorSet, 2> limit_coarse{}; // state to stage B, to stage A
    VkDescriptorSet strain_back{};                 // stage B to stage A
    VkDescriptorSet strain_forth{};                // stage A to stage B
    VkDescriptorSet limit_spin{};                  // of stage A, in stage C's positions
    VkDescriptorSet limit_smooth{};                // stage A to stage B
    std::array<VkDescriptorSet, 4> limit_work{};   // each with the forces at one end of the step or of the limit
    VkDescriptorSet limit_scale{};
    VkDescriptorSet limit_guard{};
    VkDescriptorSet edit{};
    // Of what stage B proposes after one substep, of what the state does; then the same after several.
    std::array<VkDescriptorSet, 4> contact{};
    VkDescriptorSet near_colliders{};
    VkDescriptorSet near_features{};
    // As those of contact; with the votes of an even step, of an odd one.
    std::array<std::array<VkDescriptorSet, 2>, 4> test_features{};
    std::array<std::array<VkDescriptorSet, 2>, 4> feature_contact{};
    std::array<VkDescriptorSet, 2> depenetrate{}; // each writes one of the sizes
    VkDescriptorSet deform{};
    VkDescriptorSet face_features{};
    VkDescriptorSet find_tangles{};
    std::array<VkDescriptorSet, 2> pair_means{}; // of the state, of stage B
    std::array<VkDescriptorSet, 2> pair_clear{};
    VkDescriptorSet find_islands{};
    std::array<VkDescriptorSet, 2> pair_sweeps{}; // of the state, of stage B
    VkDescriptorSet pair_boxes{};
    VkDescriptorSet pair_refit{};
    VkDescriptorSet find_candidates{};
    VkDescriptorSet sift_candidates{};
    VkDescriptorSet find_pairs{};
    VkDescriptorSet match_pairs{};
    std::array<VkDescriptorSet, 2> index_pairs{};
    std::array<VkDescriptorSet, 2> meet_pairs{};
    std::array<VkDescriptorSet, 2> respond_to_pairs{};
    VkDescriptorSet refit{}; // of a collider that deforms
    VkDescriptorSet refit_cloths{};
    VkDescriptorSet count_cloth_pairs{}; // with SolverOptions::intersections, as the next one
    VkDescriptorSet count_collider_pairs{};
    VkDescriptorSet find_reaches{};
    VkDescriptorSet find_restless{};
    VkDescriptorSet wake_cloths{};
    VkDescriptorSet list_awake_patches{};
    VkDescriptorSet find_speeds{};
    VkDescriptorSet decide_sleep{};
    VkDescriptorSet fall_asleep{};
    VkDescriptorSet normals{};
    VkDescriptorSet statistics{};
    VkDescriptorSet statistics_reduce{};
};

// A set that is to be written, and its roles.
struct SetDescription
{
    VkDescriptorSet* set;
    const gpu::Kernel* kernel;
    std::vector<RoleBuffer> roles;
};

// All of them, which point into `sets` and `kernels`.
std::vector<SetDescription> describe_sets(DescriptorSets& sets, const Kernels& kernels);

// The set of an output. `keeps_previous`: there are previous positions to bind.
SetDescription describe_output(VkDescriptorSet& set, const Kernels& kernels, bool keeps_previous);

// That every set can be resolved. Errors: see resolve.
Result<void> check_sets(const Kernels& kernels);

using BufferHandles = std::array<VkBuffer, buffer::k_numbers>; // by name

// The buffers of a set. Errors: see resolve.
Result<std::vector<gpu::BufferBinding>> bindings_of(const SetDescription& description, const BufferHandles& buffers);

// Writes all sets, from a pool of their size. Errors: see resolve; out of memory.
Result<gpu::BindingPool> write_sets(DescriptorSets& sets, const gpu::Context& context, const Kernels& kernels,
                                    const BufferHandles& buffers);

} // namespace voile
