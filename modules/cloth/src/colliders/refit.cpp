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

namespace
{

// Folds the boxes from level push.bottom on to the root. `first`: of the kernels, for the lowest levels.
void record_levels(gpu::Recorder& recorder, const RefitKernels& kernels, const gpu::Kernel& first, VkDescriptorSet set,
                   shared::RefitPush push)
{
    const gpu::Kernel* kernel = &first;
    do
    {
        push.levels = std::min(push.bottom, kernels.levels_per_dispatch);
        const uint32_t roots = 1u << (push.bottom - push.levels);
        const uint32_t groups = (roots + kernels.run - 1) / kernels.run;
        recorder.dispatch(*kernel, set, groups * kernels.group, kernels.group, push);
        push.bottom -= push.levels;
        kernel = &kernels.levels;
    } while (push.bottom > 0);
}

} // namespace

void record_refit(gpu::Recorder& recorder, const RefitKernels& kernels, VkDescriptorSet set, const RefitTree& tree)
{
    if (tree.triangles > 0)
        record_levels(recorder, kernels, kernels.leaves, set,
                      {tree.first_box, tree.first_leaf, tree.first_from, tree.first_to,
                       padded_levels(tree.triangles), 0});
}

void record_fold(gpu::Recorder& recorder, const RefitKernels& kernels, VkDescriptorSet set, uint32_t leaves)
{
    if (leaves > 1)
        record_levels(recorder, kernels, kernels.levels, set, {0, 0, 0, 0, padded_levels(leaves), 0});
}

} // namespace voile
