// The private state of a solver.
#pragma once

#include "solver/solver_state.hpp"

namespace tests
{

// An explicit instantiation may name private members.
template <auto member>
struct Opened
{
    friend const voile::Solver::State& opened(const voile::Solver& solver) { return *(solver.*member); }
};
template struct Opened<&voile::Solver::state_>;
const voile::Solver::State& opened(const voile::Solver& solver);

} // namespace tests
