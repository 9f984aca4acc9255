// What the hosts do with the module: a sheet falls for a tenth of a second, and its energy is that of the fall.
#pragma once

#include "engine.hpp"

#include <voile/cloth.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

// One by each function of voile/attachments.hpp: a shared library must show them all.
inline std::vector<voile::Attachment> all_attachments(voile::AnchorId hand)
{
    const voile::Vec3 up(0, 1, 0);
    return {voile::pin(0),
            voile::pin(1, hand),
            voile::pin(2, hand, up),
            voile::spring(3, 10).to(hand).at(up),
            voile::max_distance(4, 0.1f),
            voile::backstop(5, up, 0.1f).with_max_distance(0.2f),
            voile::spring(6, 10).with_backstop(up, 0.1f)};
}

// 0, or 1 and a line on stderr.
inline int let_a_sheet_fall(foreign::Engine& engine, const voile::Handles& handles,
                            const voile::SolverOptions& options = {})
{
    const auto fail = [](const voile::Error& error) { return std::fprintf(stderr, "%s\n", error.message.c_str()), 1; };
    auto solver = voile::Solver::create(handles, options);
    if (!solver)
        return fail(solver.error());
    const voile::GridCloth grid{.columns = 8, .rows = 8, .material = voile::Material{.vertex_mass = 1.f / 64}};
    const auto sheet = solver->add_cloth(grid);
    if (!sheet)
        return fail(sheet.error());
    const auto hand = solver->add_anchor(voile::Mat4(1.f));
    if (!hand)
        return fail(hand.error());
    if (const auto attached = solver->set_attachments(*sheet, all_attachments(*hand)); !attached)
        return fail(attached.error());
    if (const auto released = solver->set_attachments(*sheet, {}); !released)
        return fail(released.error());
    voile::Upload upload;
    for (int frame = 0; frame < 6; ++frame)
    {
        const VkCommandBuffer cmd = engine.begin_frame();
        if (frame == 0)
        {
            auto recorded = solver->record_upload(cmd);
            if (!recorded)
                return fail(recorded.error());
            upload = std::move(*recorded);
        }
        if (const auto recorded = solver->record(cmd, {.duration = 1.f / 60}); !recorded)
            return fail(recorded.error());
        if (const auto recorded = solver->record_statistics(cmd, 0); !recorded)
            return fail(recorded.error());
        engine.submit_frame();
    }
    engine.wait_idle();
    const float expected = 0.5f * 0.981f * 0.981f; // J, of 1 kg
    const float energy = solver->statistics(0).kinetic_energy;
    std::printf("%g J, expected %g J\n", static_cast<double>(energy), static_cast<double>(expected));
    return std::abs(energy - expected) < 1e-3f * expected ? 0 : 1;
}

inline voile::Handles handles_of(const foreign::Engine& engine)
{
    return {.instance = engine.instance(),
            .physical_device = engine.physical_device(),
            .device = engine.device(),
            .get_instance_proc_addr = engine.get_instance_proc_addr()};
}
