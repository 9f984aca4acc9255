// What an upload copies of cloths.
#pragma once

#include "voile/output.hpp"

#include "model/model.hpp"
#include "solver/staging.hpp"

namespace voile
{

// Cloths that are not uploaded yet, lists that are new, and the order of all cloths that collide with themselves.
void stage_cloths(Staging& staging, const Model& model, const OutputOptions& output);

} // namespace voile
