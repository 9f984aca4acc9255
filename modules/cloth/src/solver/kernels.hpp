// Kernels: the compute pipelines of a solver.
#pragma once

#include "colliders/refit.hpp"

#include "voile/gpu/kernel.hpp"

namespace voile
{

struct SolverOptions;

struct Kernels
{
    gpu::Kernel stage; // of RK4, any of the four
    gpu::Kernel verlet;
    gpu::Kernel stage_shared; // the same for few vertices: several threads share the forces of one
    gpu::Kernel verlet_shared;
    gpu::Kernel pins;
    gpu::Kernel attachments;
    gpu::Kernel tethers;
    gpu::Kernel limit_coarse;
    gpu::Kernel limit_strain;
    gpu::Kernel limit_spin;
    gpu::Kernel limit_smooth;
    gpu::Kernel limit_work;
    gpu::Kernel limit_scale;
    gpu::Kernel limit_guard;
    gpu::Kernel edit;
    gpu::Kernel contact;        // with meshes and planes
    gpu::Kernel contact_convex; // with spheres, capsules, boxes beside them
    gpu::Kernel contact_moving; // where colliders move or deform
    gpu::Kernel contact_many;   // where patches have lists of the colliders near them
    gpu::Kernel contact_pairs;  // where cloths collide with themselves
    gpu::Kernel contact_pairs_convex;
    gpu::Kernel contact_pairs_moving;
    gpu::Kernel contact_pairs_many;
    gpu::Kernel find_tangles;
    gpu::Kernel pair_means;
    gpu::Kernel pair_clear;
    gpu::Kernel find_islands;
    gpu::Kernel pair_sweeps;
    gpu::Kernel pair_boxes;
    gpu::Kernel find_candidates;
    gpu::Kernel sift_candidates;
    gpu::Kernel find_pairs;
    gpu::Kernel match_pairs;
    gpu::Kernel index_pairs;
    gpu::Kernel meet_pairs;
    gpu::Kernel respond_to_pairs;
    gpu::Kernel near_colliders;
    gpu::Kernel near_features;
    gpu::Kernel near_features_moving;
    gpu::Kernel test_features;
    gpu::Kernel test_features_moving;
    gpu::Kernel feature_contact;
    gpu::Kernel feature_contact_moving;
    gpu::Kernel traverse_features; // only on CPU devices (VOILE_FEATURES_TRAVERSED)
    gpu::Kernel traverse_features_moving;
    gpu::Kernel depenetrate;        // out of meshes at rest
    gpu::Kernel depenetrate_moving; // where colliders move or deform
    gpu::Kernel deform;
    gpu::Kernel face_features;
    RefitKernels refit;
    gpu::Kernel find_reaches;
    gpu::Kernel find_restless;
    gpu::Kernel wake_cloths;
    gpu::Kernel list_awake_patches;
    gpu::Kernel find_speeds;
    gpu::Kernel decide_sleep;
    gpu::Kernel fall_asleep;
    gpu::Kernel normals;
    gpu::Kernel output;
    gpu::Kernel count_cloth_pairs;    // only with SolverOptions::intersections
    gpu::Kernel count_collider_pairs; // the same
    gpu::Kernel statistics;
    gpu::Kernel statistics_reduce;
};

// Mesa's CPU device executes both sides of each branch, and each loop once at least (bench/NOTES.md).
inline bool is_cpu(VkPhysicalDeviceType device)
{
    return device == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

// That any kernel binds.
uint32_t most_storage_buffers();

// In kernels with more threads than a patch has vertices: forces of few vertices, wide levels of the strain limit.
uint32_t threads_per_vertex(const SolverOptions& options);

// Whether a device with these limits can run the kernels. Errors: see gpu::check_limits. Those of the refit take what
// they find (create_refit_kernels).
Result<void> check_limits(const VkPhysicalDeviceLimits& limits, const SolverOptions& options);

// Errors: those of check_limits, a driver that refuses a shader.
Result<Kernels> create_kernels(const gpu::Context& context, const SolverOptions& options);

} // namespace voile
