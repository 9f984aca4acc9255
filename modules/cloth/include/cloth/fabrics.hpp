// Fabrics to start from: typical samples of five classes, from published measurements where these exist.
#pragma once

#include "cloth/material.hpp"

#include <optional>
#include <string_view>

namespace cloth
{

// Each value's source stands beside it in fabrics.cpp. Of all five:
// - stretch stiffness is the secant at about 5 N/m, the loads of hanging and draping;
// - bending stiffness is what a cantilever has (KES B plus its friction), in the isometric model;
// - friction is of the fabric on itself, typical: measured values depend on pressure and direction;
// - thickness is the distance that contact keeps, some millimetres, and not the fabric's own, which is told beside it.
Fabric silk();    // light and limp: crepe de chine, charmeuse
Fabric cotton();  // shirting
Fabric wool();    // winter suiting
Fabric denim();   // washed, 11 oz
Fabric leather(); // sheep garment leather

// By the function's name, nothing for others.
std::optional<Fabric> find_fabric(std::string_view name);

} // namespace cloth
