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
};

struct Upload::Contents
{
    std::vector<gpu::Buffer> staging;
    std::optional<DeviceState> replaced;
};

} // namespace cloth
