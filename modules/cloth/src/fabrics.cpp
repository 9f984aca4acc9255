// The presets and where their values come from.
//
// Stretch. Testers give the strain at a high load: KES-F at 490 N/m (500 gf/cm), while a hanging cloth bears some 5
// N/m. The curve is steep at first where the crimp pulls straight. KES' linearity LT (work over that of a straight
// line) of a curve F ~ strain^n is 2 / (n + 1), so n = 2 / LT - 1, and the secant at 5 N/m is (5 / 490)^(1 - 1/n) of
// that at 490: 0.093 at LT 0.65, 0.120 at 0.70. The secants here round what follows.
//
// Bending. KES gives B without the friction between yarns; a cantilever or a drape sees both, B + HB c with HB half the
// hysteresis and 1/c the curvature, 1.2 to 2 times B. An elastic model needs the latter.
//
// Shear: KES G in gf/(cm degree) times 56.19 is N/m; it is a slope at small angles already.
//
// What is behind a source's name: denim's values and the FAST report were read in tables; Kawabata's means, LT and the
// ranges called typical are recalled from the literature and were not looked up again. Values inside a typical range
// are a choice. The bending of silk and of leather was chosen with their drape coefficients known, so that these do not
// confirm it.
//
// Thickness. Contact keeps single vertices at that distance, so that what spans between them stays out of a curved
// surface: 2 to 5 mm, some times the fabric's own.
#include "cloth/fabrics.hpp"

namespace cloth
{

Fabric silk()
{
    Fabric f;
    f.areal_density = 0.082f;          // 19 momme charmeuse at 4.34 g/m^2 each (trade data); the class has 0.055-0.090
    f.stretch_stiffness = {1400, 740}; // typical KES secants 15 and 8 kN/m, LT 0.65
    f.shear_stiffness = 17;            // typical, G 0.2-0.4 gf/(cm degree)
    f.bending_stiffness = 1.8e-6f; // chosen in 0.8-3e-6, typical; limp cloths of 0.07-0.10 kg/m^2 in the data of Feng
                                   // et al. 2022 (drape tester) have 0.5-2.5e-6
    f.thickness = 0.002f;          // the fabric's own: 0.22 mm
    f.static_friction = 0.3f;      // typical 0.25-0.40; fibres 0.26 (Morton and Hearle)
    f.kinetic_friction = 0.25f;    // typical 0.20-0.35
    f.bending_model = BendingModel::isometric;
    return f;
}

Fabric cotton()
{
    Fabric f;
    f.areal_density = 0.13f;            // typical, 0.10-0.15 (Penava et al. 2014: 0.150 for a plain weave)
    f.stretch_stiffness = {1900, 1100}; // typical KES secants 16 and 9 kN/m, LT 0.70
    f.shear_stiffness = 80;             // typical, G 0.8-2.0 gf/(cm degree)
    f.bending_stiffness = 1.4e-5f;      // typical of cantilevers, 0.8-2.5e-5; KES 0.5-1.2e-5
    f.thickness = 0.003f;               // the fabric's own: 0.32 mm (Penava et al. 2014)
    f.static_friction = 0.6f;           // typical 0.5-0.8
    f.kinetic_friction = 0.5f;          // typical 0.40-0.65; fibres 0.29-0.57 (Morton and Hearle)
    f.bending_model = BendingModel::isometric;
    return f;
}

Fabric wool()
{
    Fabric f;
    f.areal_density = 0.2635f;         // Kawabata 1980, mean of 214 men's winter suitings
    f.stretch_stiffness = {730, 1200}; // a FAST report of a plain worsted: 0.67 and 0.40 % at 4.9 N/m. The mean of the
                                       // suitings, 8.1 kN/m at LT 0.61, gives 620
    f.shear_stiffness = 54;            // Kawabata 1980: G 0.968 gf/(cm degree)
    f.bending_stiffness = 1.9e-5f;     // Kawabata 1980: B 1.33e-5, and HB c = 0.58e-5 for c = 1.9 cm
    f.thickness = 0.004f;              // the fabric's own: 0.75 mm (Kawabata 1980)
    f.static_friction = 0.5f;          // typical 0.4-0.6
    f.kinetic_friction = 0.4f;         // typical 0.3-0.5
    f.bending_model = BendingModel::isometric;
    return f;
}

Fabric denim()
{
    Fabric f;
    f.areal_density = 0.324f;           // Wang, O'Brien and Ramamoorthi 2011, 11 oz; 0.318-0.334 in Fashion and
                                        // Textiles 1:19 (2014)
    f.stretch_stiffness = {1100, 1100}; // J. Textiles 2016, 4614168: mean of six, 9.4 kN/m, LT 0.70; Wang et al. fit
                                        // 205 and 1014 at low loads
    f.shear_stiffness = 89;         // J. Textiles 2016, 4614168: median of six, G 1.58 gf/(cm degree); Wang et al. 53
    f.bending_stiffness = 8.06e-5f; // Wang et al. 2011, mean of warp and weft; 5-9e-5 by bending lengths of washed ones
    f.thickness = 0.005f;           // the fabric's own: 0.85 mm (J. Textiles 2016)
    f.static_friction = 0.6f;       // typical 0.5-0.8
    f.kinetic_friction = 0.5f;      // typical 0.40-0.65; 0.28-0.33 against a smooth probe
    f.bending_model = BendingModel::isometric;
    return f;
}

Fabric leather()
{
    Fabric f;
    f.areal_density = 0.5f;             // typical, 0.6 g/cm^3 at 0.64-0.96 mm
    f.stretch_stiffness = {1900, 1100}; // chosen: 5 along and 3 kN/m across the backbone at 98 N/m, LT 0.8
    f.shear_stiffness = 560;            // no measurement; a felt has no yarns to turn: E / (2 (1 + nu)), nu 0.35
    f.bending_stiffness = 4e-5f;        // chosen, 1-8e-5, to give the drape coefficients of 47 to 70 % that Memon et
                                        // al. 2021 (Materials 14, 4553) measured
    f.thickness = 0.005f;               // the leather's own: 0.80 mm (Memon et al. 2021: 0.64-0.96)
    f.static_friction = 0.6f;           // typical of finished leather, 0.5-0.7
    f.kinetic_friction = 0.5f;          // typical, 0.4-0.6
    f.bending_model = BendingModel::isometric;
    return f;
}

std::optional<Fabric> find_fabric(std::string_view name)
{
    constexpr struct
    {
        std::string_view name;
        Fabric (*make)();
    } k_fabrics[] = {{"silk", silk}, {"cotton", cotton}, {"wool", wool}, {"denim", denim}, {"leather", leather}};
    for (const auto& fabric : k_fabrics)
        if (fabric.name == name)
            return fabric.make();
    return std::nullopt;
}

} // namespace cloth
