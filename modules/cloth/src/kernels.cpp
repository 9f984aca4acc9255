// Kernels: compilation with the solver's workgroup size.
#include "kernels.hpp"

#include "cloth/solver.hpp"

#include "cloth_layout.h"
#include "voile_cloth_shaders.hpp"

namespace cloth
{

namespace
{

struct Request
{
    gpu::Kernel* kernel;
    gpu::KernelDescription description;
};

} // namespace

gpu::Result<Kernels> create_kernels(const gpu::Context& context, const SolverOptions& options)
{
    constexpr std::array k_stage_names{"cloth rk4 stage 1", "cloth rk4 stage 2", "cloth rk4 stage 3",
                                       "cloth rk4 stage 4"};
    const uint32_t group = options.workgroup_size;
    const auto method = static_cast<uint32_t>(options.contact_method);
    Kernels kernels;
    std::vector<Request> requests{
        {&kernels.contact, {"cloth contact", shaders::k_contact_comp, 9, sizeof(shared::ContactPush), {group, method}}},
        {&kernels.normals, {"cloth normals", shaders::k_normals_comp, 4, 0, {group}}},
        {&kernels.statistics,
         {"cloth statistics", shaders::k_statistics_comp, 8, sizeof(shared::StatisticsPush), {group}}},
        {&kernels.statistics_reduce,
         {"cloth statistics reduce",
          shaders::k_statistics_reduce_comp,
          2,
          sizeof(shared::StatisticsReducePush),
          {group}}},
    };
    for (uint32_t stage = 0; stage < 4; ++stage)
        requests.push_back(
            {&kernels.stages[stage],
             {k_stage_names[stage], shaders::k_integrate_comp, 10, sizeof(shared::StagePush), {group, stage + 1}}});
    for (const Request& request : requests)
    {
        auto kernel = gpu::Kernel::create(context, request.description);
        if (!kernel)
            return kernel.error();
        *request.kernel = std::move(kernel.value());
    }
    return kernels;
}

} // namespace cloth
