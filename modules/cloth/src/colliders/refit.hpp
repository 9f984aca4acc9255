// Refit: recomputes the boxes of a padded tree from its mesh's present vertices.
#pragma once

#include "shared/padded_layout.h"

#include "voile/gpu/recorder.hpp"

namespace voile
{

// Both have the same bindings, so one descriptor set serves both: padded_leaves, deforming_positions, padded_boxes.
struct RefitKernels
{
    gpu::Kernel leaves; // starts from the vertices
    gpu::Kernel levels; // starts from boxes
    uint32_t group = 0;
    uint32_t run = 0; // neighboring subtrees per workgroup
    uint32_t levels_per_dispatch = 0;
};

// `workgroup_size`: a power of two, 2 to the device's limit; more than the device's limit is lowered to it.
Result<RefitKernels> create_refit_kernels(const gpu::Context& context, uint32_t workgroup_size = 256);

// The offsets of a tree in its buffers.
struct RefitTree
{
    uint32_t first_box = 0;
    uint32_t first_leaf = 0;
    uint32_t first_from = 0; // of the mesh's vertices at the start of the step
    uint32_t first_to = 0;   // and at its end; may be the same ones
    uint32_t triangles = 0;  // nothing is recorded for 0
};

// The first index from `first` on at which a tree's boxes can begin so that all of its levels but the top ones begin at
// multiples of 256 bytes: runs of boxes then fill whole cache lines.
constexpr uint32_t aligned_first_box(uint32_t first)
{
    constexpr uint32_t k_line = VOILE_REFIT_RUN;
    return (first + k_line - 2) / k_line * k_line + 1;
}

// Records a refit in the dispatches that it takes, each with its barrier to what follows. Positions
// must have been made visible to compute reads, and earlier reads of the boxes must be done. All boxes of the tree are
// written.
void record_refit(gpu::Recorder& recorder, const RefitKernels& kernels, VkDescriptorSet set, const RefitTree& tree);

// One of the dispatches of a refit.
struct Fold
{
    shared::RefitPush push;
    uint32_t groups = 0;
};

// The next one, which folds the levels above push.bottom, and moves push.bottom up. Done when that is 0.
Fold next_fold(const RefitKernels& kernels, shared::RefitPush& push);

} // namespace voile
