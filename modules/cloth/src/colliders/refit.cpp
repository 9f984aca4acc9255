// Refit: how a tree is cut into dispatches.
#include "colliders/refit.hpp"

#include "colliders/specialization.hpp"
#include "geometry/padded_tree.hpp"

#include "voile_cloth_shaders.hpp"

#include <algorithm>
#include <bit>

namespace voile
{

Result<RefitKernels> create_refit_kernels(const gpu::Context& context, uint32_t workgroup_size,
                                          std::span<const uint32_t> code)
{
    const auto& limits = context.limits;
    const uint32_t most = std::min(limits.maxComputeWorkGroupSize[0], limits.maxComputeWorkGroupInvocations);
    RefitKernels kernels;
    kernels.group = std::max(2u, std::bit_floor(std::min(workgroup_size, most)));
    kernels.run = std::min(kernels.group / 2, static_cast<uint32_t>(VOILE_REFIT_RUN)); // two threads a box
    const uint32_t rows = kernels.group / (2 * kernels.run);
    kernels.levels_per_dispatch = static_cast<uint32_t>(std::countr_zero(VOILE_REFIT_ITEMS * rows));
    const auto create = [&](const char* name, uint32_t from_leaves)
    {
        const Specialization specialization{.workgroup_size = kernels.group, .from_leaves = from_leaves};
        return gpu::Kernel::create(context,
                                   {name, code.empty() ? shaders::k_refit_comp : code, specialization.values()});
    };
    auto leaves = create("cloth refit leaves", 1);
    if (!leaves)
        return leaves.error();
    auto levels = create("cloth refit levels", 0);
    if (!levels)
        return levels.error();
    kernels.leaves = std::move(leaves.value());
    kernels.levels = std::move(levels.value());
    return kernels;
}

namespace
{

// The part of a refit that is one dispatch.
struct Round
{
    uint32_t bottom = 0;
    uint32_t levels = 0;
    uint32_t columns = 0; // workgroups per tree

    explicit operator bool() const { return columns > 0; }
};

// The rounds of a tree, from the leaves on: `index` counts them. No columns: there is none.
Round round_of(const RefitKernels& kernels, uint32_t depth, uint32_t index)
{
    const uint32_t folded = index * kernels.levels_per_dispatch;
    if (index > 0 && folded >= depth)
        return {};
    Round round{depth - folded, std::min(depth - folded, kernels.levels_per_dispatch), 0};
    const uint32_t roots = 1u << (round.bottom - round.levels);
    round.columns = (roots + kernels.run - 1) / kernels.run;
    return round;
}

} // namespace

void record_refit(gpu::Recorder& recorder, const RefitKernels& kernels, VkDescriptorSet set,
                  const shared::TreeRecord& tree)
{
    if (tree.triangles == 0)
        return;
    const uint32_t depth = padded_levels(tree.triangles);
    for (uint32_t i = 0; const Round round = round_of(kernels, depth, i); ++i)
    {
        const shared::RefitPush push{tree, VOILE_TREE_IN_PUSH, round.bottom, round.levels};
        recorder.dispatch_grid(i == 0 ? kernels.leaves : kernels.levels, set, round.columns, 1, push);
    }
}

// The trees of a round do not read each other's boxes: the last dispatch has the barrier of all.
void record_refit(gpu::Recorder& recorder, const RefitKernels& kernels, VkDescriptorSet set, const TreeCounts& trees)
{
    const auto deepest = std::ranges::find_if(trees.rbegin(), trees.rend(), [](uint32_t count) { return count > 0; });
    const auto last = static_cast<uint32_t>(trees.rend() - deepest);
    for (uint32_t i = 0; last > 0 && round_of(kernels, last - 1, i); ++i)
    {
        uint32_t first = 0;
        for (uint32_t depth = 0; depth < last; first += trees[depth++])
        {
            const Round round = round_of(kernels, depth, i);
            if (!round || trees[depth] == 0)
                continue;
            const shared::RefitPush push{{}, first, round.bottom, round.levels};
            recorder.dispatch_grid(i == 0 ? kernels.leaves : kernels.levels, set, round.columns, trees[depth], push,
                                   depth + 1 == last ? gpu::Ordering::ordered : gpu::Ordering::unordered);
        }
    }
}

Fold next_fold(const RefitKernels& kernels, shared::RefitPush& push)
{
    push.levels = std::min(push.bottom, kernels.levels_per_dispatch);
    const uint32_t roots = 1u << (push.bottom - push.levels);
    const Fold fold{push, (roots + kernels.run - 1) / kernels.run};
    push.bottom -= push.levels;
    return fold;
}

} // namespace voile
