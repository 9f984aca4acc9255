// Fabrics to start from: typical samples of five classes. Some values were measured, some are typical.
#pragma once

#include "voile/material.hpp"

#include <optional>
#include <string_view>

namespace voile
{

// Where the values come from. "Read": from a published measurement; fabrics.cpp names each source with its table or
// file. "Typical": a typical value of the class of fabric, from memory.
//
//           areal density  stretch  shear      bending  friction
//   silk    read           typical  typical    typical  typical
//   cotton  read           typical  typical    read     typical
//   wool    read           read     read       read     typical
//   denim   read           read     read       read     typical
//   leather typical        typical  estimated  chosen   typical
//
// Wool's stretch and shear are those of another plain worsted, of 0.168 kg/m^2. Denim's stretch and shear come from
// other denims than its density and bending. Leather's bending is chosen to give measured drape coefficients; its shear
// follows from its stretch, as in a felt. docs/physics.md compares the drape coefficients with measured ones, if any.
//
// For all five:
// - Stretch stiffness is the secant at about 5 N/m, the load of hanging and draping.
// - Bending stiffness is that of a cantilever, including the friction between yarns, in the isometric model.
// - Friction is that of the fabric on itself. Measured values depend on pressure and direction.
// - Damping and air drag are Fabric's defaults.
// - Thickness is the distance that contact keeps, 2 to 5 mm. fabrics.cpp names the fabric's own thickness.
VOILE_API Fabric silk();    // light and limp: crepe de chine, charmeuse
VOILE_API Fabric cotton();  // broadcloth, for shirts
VOILE_API Fabric wool();    // tropical worsted, for summer suits
VOILE_API Fabric denim();   // washed, 11 oz
VOILE_API Fabric leather(); // sheep garment leather

// The preset with the function's name. None: no preset has that name.
VOILE_API std::optional<Fabric> find_fabric(std::string_view name);

} // namespace voile
