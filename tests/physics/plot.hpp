// Plots as SVG files.
#pragma once

#include "physics/cases.hpp"

#include <filesystem>

namespace physics
{

// Writes `folder`/<plot's file>.svg. Returns false on failure.
bool write_svg(const Plot& plot, const std::filesystem::path& folder);

} // namespace physics
