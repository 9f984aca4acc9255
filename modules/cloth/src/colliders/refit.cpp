// Refit: how a tree is cut into dispatches.
#include "colliders/refit.hpp"

#include "colliders/specialization.hpp"
#include "geometry/padded_tree.hpp"

#include "voile_cloth_shaders.hpp"

#include <algorithm>
#include <bit>

namespace voile
{

Result<RefitKernels> create_refit_kernels(const gpu::Context& context, uint32_t workgroup_size)
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
        return gpu::Kernel::create(context, {name, shaders::k_refit_comp, specialization.values()});
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

Fold next_fold(const RefitKernels& kernels, shared::RefitPush& push)
{
    push.levels = std::min(push.bottom, kernels.levels_per_dispatch);
    const uint32_t roots = 1u << (push.bottom - push.levels);
    const Fold fold{push, (roots + kernels.run - 1) / kernels.run};
    push.bottom -= push.levels;
    return fold;
}

void record_refit(gpu::Recorder& recorder, const RefitKernels& kernels, VkDescriptorSet set, const RefitTree& tree)
{
    if (tree.triangles == 0)
        return;
    shared::RefitPush push{tree.first_box, tree.first_leaf, tree.first_from, tree.first_to, 0, 0};
    push.bottom = padded_levels(tree.triangles);
    const gpu::Kernel* kernel = &kernels.leaves;
    do
    {
        const Fold fold = next_fold(kernels, push);
        recorder.dispatch(*kernel, set, fold.groups * kernels.group, kernels.group, fold.push);
        kernel = &kernels.levels;
    } while (push.bottom > 0);
}

} // namespace voile
