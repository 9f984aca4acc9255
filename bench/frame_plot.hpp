// The plot of whole frames: Voile's, the peers' and the goals of the drape scene.
#pragma once

#include "results_file.hpp"

#include <string>

namespace bench
{

// An SVG file with bars on a logarithmic axis, one group per size of the sheet. Errors: a case of the plot
// (drape-128-verlet and so on) is missing, named.
voile::Result<std::string> plot_frames(const std::vector<CaseResult>& results);

} // namespace bench
