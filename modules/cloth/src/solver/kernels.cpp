// Kernels: compilation with the solver's workgroup size.
#include "solver/kernels.hpp"

#include "voile/solver.hpp"

#include "shared/attachment_layout.h"
#include "shared/collider_layout.h"
#include "shared/contact_layout.h"
#include "shared/feature_layout.h"
#include "shared/statistics_layout.h"
#include "shared/step_layout.h"
#include "shared/strain_layout.h"
#include "voile_cloth_shaders.hpp"

namespace voile
{

namespace
{

struct Request
{
    gpu::Kernel* kernel;
    gpu::KernelDescription description;
};

std::vector<Request> requests_of(Kernels& kernels, const SolverOptions& options)
{
    const uint32_t group = options.tuning.workgroup_size;
    const auto method = static_cast<uint32_t>(options.tuning.contact_method);
    const auto layout = static_cast<uint32_t>(options.tuning.mesh_layout);
    constexpr uint32_t k_edit_bytes = sizeof(shared::EditPush);
    constexpr uint32_t k_stage_bytes = sizeof(shared::StagePush);
    std::vector<Request> requests{
        {&kernels.stage, {"cloth rk4 stage", shaders::k_integrate_comp, 17, k_stage_bytes, {group, 0, layout}}},
        {&kernels.verlet, {"cloth verlet", shaders::k_verlet_comp, 14, k_stage_bytes, {group, 0, layout}}},
        {&kernels.pins, {"cloth pins", shaders::k_pin_comp, 5, sizeof(shared::AttachmentPush), {group}}},
        {&kernels.attachments,
         {"cloth holds", shaders::k_attachments_comp, 7, sizeof(shared::AttachmentPush), {group}}},
        {&kernels.tethers, {"cloth tethers", shaders::k_tether_comp, 7, sizeof(shared::AttachmentPush), {group}}},
        {&kernels.limit_strain,
         {"cloth strain limit", shaders::k_limit_strain_comp, 12, sizeof(shared::StrainPush), {group, 0, layout}}},
        {&kernels.limit_work, {"cloth limit work", shaders::k_limit_work_comp, 18, k_stage_bytes, {group, 0, layout}}},
        {&kernels.limit_scale,
         {"cloth limit scale", shaders::k_limit_scale_comp, 6, sizeof(shared::LimitScalePush), {group}}},
        {&kernels.limit_guard, {"cloth limit guard", shaders::k_limit_guard_comp, 9, 0, {group}}},
        {&kernels.edit, {"cloth edit", shaders::k_edit_comp, 6, k_edit_bytes, {group}}},
        {&kernels.contact,
         {"cloth contact", shaders::k_contact_comp, 24, sizeof(shared::ContactPush), {group, method, layout, 0, 0, 0}}},
        {&kernels.contact_convex,
         {"cloth contact", shaders::k_contact_comp, 24, sizeof(shared::ContactPush), {group, method, layout, 0, 1, 0}}},
        {&kernels.contact_moving,
         {"cloth contact", shaders::k_contact_comp, 24, sizeof(shared::ContactPush), {group, method, layout, 1, 1, 0}}},
        {&kernels.contact_many,
         {"cloth contact", shaders::k_contact_comp, 24, sizeof(shared::ContactPush), {group, method, layout, 1, 1, 1}}},
        {&kernels.collider_reach,
         {"cloth collider reach", shaders::k_collider_reach_comp, 9, sizeof(shared::ColliderReachPush), {group}}},
        {&kernels.feature_reach,
         {"cloth feature reach",
          shaders::k_feature_reach_comp,
          11,
          sizeof(shared::FeatureReachPush),
          {group, 0, 0, 0}}},
        {&kernels.feature_reach_moving,
         {"cloth feature reach",
          shaders::k_feature_reach_comp,
          11,
          sizeof(shared::FeatureReachPush),
          {group, 0, 0, 1}}},
        {&kernels.feature_contact,
         {"cloth feature contact",
          shaders::k_feature_contact_comp,
          19,
          sizeof(shared::FeaturePush),
          {group, 0, layout, 0}}},
        {&kernels.feature_contact_moving,
         {"cloth feature contact",
          shaders::k_feature_contact_comp,
          19,
          sizeof(shared::FeaturePush),
          {group, 0, layout, 1}}},
        {&kernels.recover, {"cloth recover", shaders::k_recover_comp, 16, sizeof(shared::RecoverPush), {group, 0}}},
        {&kernels.recover_moving,
         {"cloth recover", shaders::k_recover_comp, 16, sizeof(shared::RecoverPush), {group, 1}}},
        {&kernels.deform, {"cloth deform", shaders::k_deform_comp, 2, sizeof(shared::DeformPush), {group}}},
        {&kernels.normals, {"cloth normals", shaders::k_normals_comp, 7, 0, {group, 0, layout}}},
        {&kernels.statistics,
         {"cloth statistics", shaders::k_statistics_comp, 17, sizeof(shared::StatisticsPush), {group, 0, layout}}},
        {&kernels.statistics_reduce,
         {"cloth statistics reduce",
          shaders::k_statistics_reduce_comp,
          2,
          sizeof(shared::StatisticsReducePush),
          {group}}},
    };
    return requests;
}

} // namespace

gpu::Result<void> check_limits(const VkPhysicalDeviceLimits& limits, const SolverOptions& options)
{
    Kernels none;
    for (const Request& request : requests_of(none, options))
        if (auto within = gpu::check_limits(limits, request.description); !within)
            return within;
    return {};
}

gpu::Result<Kernels> create_kernels(const gpu::Context& context, const SolverOptions& options)
{
    if (auto within = check_limits(context.limits, options); !within) // before any is compiled
        return within.error();
    Kernels kernels;
    for (const Request& request : requests_of(kernels, options))
    {
        auto kernel = gpu::Kernel::create(context, request.description);
        if (!kernel)
            return kernel.error();
        *request.kernel = std::move(kernel.value());
    }
    auto refit = create_refit_kernels(context);
    if (!refit)
        return refit.error();
    kernels.refit = std::move(refit.value());
    return kernels;
}

} // namespace voile
