// Fabrics to start from: typical samples of five classes. Some values were measured, some are typical.
#pragma once

#include "voile/material.hpp"

#include <optional>
#include <string_view>

namespace voile
{

// Which values were read in a published measurement ("read"), and which are typical of the class, recalled and not
// looked up ("typical"). fabrics.cpp names each source with its table or file.
//
//           areal density  stretch  shear      bending  friction
//   silk    read           typical  typical    typical  typical
//   cotton  read           typical  typical    read     typical
//   wool    read           read     read       read     typical
//   denim   read           read     read       read     typical
//   leather typical        typical  estimated  chosen   typical
//
// Wool's stretch and shear are those of another plain worsted, of 0.168 kg/m^2. Denim's stretch and shear are those of
// other denims than its density and bending. Leather's bending is chosen to give measured drape coefficients; its shear
// follows from its stretch as in a felt. docs/physics.md holds the drape coefficients against what was measured, as far
// as that is known. Of all five:
// - stretch stiffness is the secant at about 5 N/m, the loads of hanging and draping;
// - bending stiffness is what a cantilever has, the friction between yarns included, in the isometric model;
// - friction is of the fabric on itself; measured values depend on pressure and direction;
// - damping and air drag are Fabric's defaults;
// - thickness is the distance that contact keeps, 2 to 5 mm, and not the fabric's own, which fabrics.cpp names.
Fabric silk();    // light and limp: crepe de chine, charmeuse
Fabric cotton();  // broadcloth, for shirts
Fabric wool();    // tropical worsted, for summer suits
Fabric denim();   // washed, 11 oz
Fabric leather(); // sheep garment leather

// By the function's name; nothing for other names.
std::optional<Fabric> find_fabric(std::string_view name);

} // namespace voile
