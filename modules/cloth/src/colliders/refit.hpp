// Refit: recomputes the boxes of padded trees from the present vertices of their meshes.
#pragma once

#include "geometry/padded_tree.hpp"

#include "voile/gpu/recorder.hpp"

namespace voile
{

// Both have the same bindings, so one descriptor set serves both: cloth_trees, refit_leaves, refit_positions,
// refit_boxes.
struct RefitKernels
{
    gpu::Kernel leaves; // starts from the vertices
    gpu::Kernel levels; // starts from boxes
    uint32_t group = 0;
    uint32_t run = 0; // neighboring subtrees per workgroup
    uint32_t levels_per_dispatch = 0;
};

constexpr uint32_t k_refit_workgroup = 256;

// `workgroup_size`: a power of two, 2 to the device's limit; more than the device's limit is lowered to it. `code`: in
// place of the module's own, unless it is empty.
Result<RefitKernels> create_refit_kernels(const gpu::Context& context, uint32_t workgroup_size = k_refit_workgroup,
                                          std::span<const uint32_t> code = {});

// Records a refit in the dispatches that it takes, each with its barrier to what follows. Positions
// must have been made visible to compute reads, and earlier reads of the boxes must be done. All boxes of the tree are
// written.
void record_refit(gpu::Recorder& recorder, const RefitKernels& kernels, VkDescriptorSet set,
                  const shared::TreeRecord& tree);

// The same for all trees of the table in the buffer of cloth trees: one dispatch per depth in place of one per tree.
void record_refit(gpu::Recorder& recorder, const RefitKernels& kernels, VkDescriptorSet set, const TreeCounts& trees);

// One of the dispatches of a refit.
struct Fold
{
    shared::RefitPush push{};
    uint32_t groups = 0;
};

// The next one, which folds the levels above push.bottom, and moves push.bottom up. Done when that is 0.
Fold next_fold(const RefitKernels& kernels, shared::RefitPush& push);

} // namespace voile
