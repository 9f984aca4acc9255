// What a Solver and an Upload hold.
#pragma once

#include "cloth/solver.hpp"

#include "device_state.hpp"

#include <optional>

namespace cloth
{

struct Solver::State
{
    gpu::Context context;
    SolverOptions options;
    Kernels kernels;
    Model model;
    std::optional<DeviceState> device; // none before the first upload
    bool dirty = false;

    // Substeps that a step takes.
    [[nodiscard]] static uint32_t substeps(const Solver& solver, const Step& step)
    {
        return step.substeps > 0 ? step.substeps : solver.stable_substeps(step.duration, step.max_substeps);
    }
};

struct Upload::Contents
{
    std::vector<gpu::Buffer> staging;
    std::optional<DeviceState> replaced;
};

} // namespace cloth
