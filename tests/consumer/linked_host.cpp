// A program that links Vulkan, as most do, with the installed module: a sheet falls for a tenth of a second.
#include "linked_host.hpp"

#include <voile/cloth.hpp>

#include <cmath>
#include <cstdio>

int main()
{
    HostDevice host;
    auto made = voile::Solver::create({.instance = host.instance,
                                       .physical_device = host.physical_device,
                                       .device = host.device,
                                       .get_instance_proc_addr = &vkGetInstanceProcAddr},
                                      {.command_reuse = voile::CommandReuse{host.queue_family, 1}});
    if (!made)
        return std::fprintf(stderr, "%s\n", made.error().message.c_str()), 1;
    voile::Solver& solver = made.value();
    const voile::GridCloth grid{.columns = 8, .rows = 8, .material = voile::Material{.vertex_mass = 1.f / 64}};
    if (const auto sheet = solver.add_cloth(grid); !sheet)
        return std::fprintf(stderr, "%s\n", sheet.error().message.c_str()), 1;
    const auto upload = solver.record_upload(host.begin());
    host.submit_and_wait();
    for (int frame = 0; frame < 6; ++frame)
    {
        const VkCommandBuffer cmd = host.begin();
        if (const auto recorded = solver.record(cmd, {.duration = 1.f / 60}); !recorded)
            return std::fprintf(stderr, "%s\n", recorded.error().message.c_str()), 1;
        if (const auto recorded = solver.record_statistics(cmd, 0); !recorded)
            return std::fprintf(stderr, "%s\n", recorded.error().message.c_str()), 1;
        host.submit_and_wait();
    }
    const float expected = 0.5f * 0.981f * 0.981f; // J, of 1 kg
    const float energy = solver.statistics(0).kinetic_energy;
    std::printf("%g J, expected %g J\n", static_cast<double>(energy), static_cast<double>(expected));
    return std::abs(energy - expected) < 1e-3f * expected ? 0 : 1;
}
