// The whole interface of the cloth module. docs/integration.md is the guide to it.
#pragma once

#include "voile/fabrics.hpp"
#include "voile/material_parameters.hpp"
#include "voile/mesh_checks.hpp"
#include "voile/ranges.hpp"
#include "voile/solver.hpp"
#include "voile/version.hpp"
