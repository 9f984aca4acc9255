// Kernels: the compute pipelines of a solver.
#pragma once

#include "refit.hpp"

#include "gpu/kernel.hpp"

#include <array>

namespace cloth
{

struct SolverOptions;

struct Kernels
{
    std::array<gpu::Kernel, 4> stages; // the four stages of RK4
    gpu::Kernel verlet;
    gpu::Kernel pins;
    gpu::Kernel holds;
    gpu::Kernel tethers;
    gpu::Kernel limit_strain;
    gpu::Kernel edit;
    gpu::Kernel contact;        // with meshes and planes
    gpu::Kernel contact_convex; // with spheres, capsules, boxes beside them
    gpu::Kernel contact_moving; // where colliders move or deform
    gpu::Kernel feature_reach;
    gpu::Kernel feature_reach_moving;
    gpu::Kernel feature_contact;
    gpu::Kernel feature_contact_moving;
    gpu::Kernel recover;        // out of meshes at rest
    gpu::Kernel recover_moving; // where colliders move or deform
    gpu::Kernel deform;
    RefitKernels refit;
    gpu::Kernel normals;
    gpu::Kernel statistics;
    gpu::Kernel statistics_reduce;
};

gpu::Result<Kernels> create_kernels(const gpu::Context& context, const SolverOptions& options);

} // namespace cloth
