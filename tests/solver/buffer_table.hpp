// The tables of docs/buffers.md, from the declarations of buffers, the descriptor sets and the kernels' SPIR-V.
#pragma once

#include "solver/kernels.hpp"

#include <string>

namespace tests
{

std::string buffer_table(const voile::Kernels& kernels);

} // namespace tests
