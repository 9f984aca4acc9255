// Refit: recomputes the boxes of padded trees from the present vertices of their meshes.
#pragma once

#include "shared/padded_layout.h"

#include "voile/gpu/recorder.hpp"

#include <array>

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

// `workgroup_size`: a power of two, 2 to the device's limit; more than the device's limit is lowered to it.
Result<RefitKernels> create_refit_kernels(const gpu::Context& context, uint32_t workgroup_size = 256);

// The trees of a table, ordered by their levels below the root: how many there are of each depth.
constexpr size_t k_tree_depths = 29;
using TreeCounts = std::array<uint32_t, k_tree_depths>;

// The first index from `first` on at which a tree's boxes can begin so that all of its levels but the top ones begin at
// multiples of 256 bytes: runs of boxes then fill whole cache lines.
constexpr uint32_t aligned_first_box(uint32_t first)
{
    constexpr uint32_t k_line = VOILE_REFIT_RUN;
    return (first + k_line - 2) / k_line * k_line + 1;
}

// The entries that boxes may need before their first one, so that it is aligned.
constexpr uint64_t k_box_alignment = VOILE_REFIT_RUN - 1;

// Records a refit in the dispatches that it takes, each with its barrier to what follows. Positions
// must have been made visible to compute reads, and earlier reads of the boxes must be done. All boxes of the tree are
// written.
void record_refit(gpu::Recorder& recorder, const RefitKernels& kernels, VkDescriptorSet set,
                  const shared::TreeRecord& tree);

// The same for all trees of the table in the buffer of cloth trees: one dispatch per depth in place of one per tree.
void record_refit(gpu::Recorder& recorder, const RefitKernels& kernels, VkDescriptorSet set, const TreeCounts& trees);

} // namespace voile
