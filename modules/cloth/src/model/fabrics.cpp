// The presets and where their values come from.
//
// Stretch. Testers give the strain at a high load: KES-F at 490 N/m (500 gf/cm), while a hanging cloth bears some 5
// N/m. The curve is steep at first where the crimp pulls straight. KES' linearity LT (work over that of a straight
// line) of a curve F ~ strain^n is 2 / (n + 1), so n = 2 / LT - 1, and the secant at 5 N/m is (5 / 490)^(1 - 1/n) of
// that at 490: 0.093 at LT 0.65, 0.120 at 0.70. The secants here round what follows.
//
// Bending. KES gives B without the friction between yarns; a cantilever or a drape sees both, B + HB / kappa, with HB
// half the hysteresis 2HB and kappa the curvature. Where a source has 2HB, kappa is 1/cm, between what a drape has at
// its support and at its edge; in KES units that is B + HB. One gf cm^2/cm is 9.807e-5 N m.
//
// Fits of Bridson's hinge (Wang et al. 2011, ARCSim) give a stiffness k whose energy is k l^2 theta^2 / 8 A, for an
// edge of length l between triangles of area A in all. A plate of stiffness B whose hinges lie across the bend has four
// times as much, B l^2 theta^2 / 2 A: B = k / 4.
//
// Shear: KES G in gf/(cm degree) times 56.19 is N/m; it is a slope at small angles already.
//
// Sources. Where a comment names a source with a table or a file, the value was read there; the list below says where.
// "Typical": of that class of fabric, recalled and not looked up, and so are the ranges and the LT of 0.65. A value
// inside a typical range is a choice. fabrics.hpp repeats for users which values are typical.
// - Matsudaira, Masuda, Wada and Yokura 2015, Journal of Textile Engineering 61(6), 69-73, tables 1 and 2: KES and
//   drape coefficients of the same fabrics, as a public program transcribes them (github.com/antonbj3/
//   3fold-motion-engine, src/motion_engine/cloth/r6_setup.py); the paper itself was not opened. The program leaves its
//   shear column out.
// - Wang, O'Brien and Ramamoorthi 2011, "Data-driven elastic models for cloth": the authors' measurements as published
//   for ARCSim, 11oz-black-denim.json, read in github.com/wxhaooo/lyra, materials/. What ARCSim does with them:
//   bending_energy in physics.cpp, read in github.com/DrapeTester/ClothDrapeTester, arcsim/AdaptiveCloth/.
// - Kumari and Khurana 2016, Journal of Textiles, article 4614168, table 5: KES of six denims of cotton and regenerated
//   cellulose, A to F. Its weights (94 to 109 mg/cm^2) cannot be areal densities.
// - Feng et al. 2022, "Learning-based bending stiffness parameter estimation by a drape tester": the authors' data of
//   618 fabrics, github.com/DrapeTester/ClothDrapeTester, dataset/dataset.csv. Plate stiffness, at no curvature.
// - Penava et al. 2014, table 1, row 5, as a public program transcribes it; the paper itself was not opened.
// - Memon et al. 2021, Materials 14, 4553, the abstract: thickness and drape coefficients of four sheep leathers.
// - A FAST report: "Fabric Assurance by Simple Testing", a report of students on a plain worsted of 0.168 kg/m^2,
//   tables V and VI: extensions, a shear rigidity of 26 N/m, bending rigidities of 5.6 and 5.0e-6 N m.
//
// Thickness. Contact keeps single vertices at that distance, so that what spans between them stays out of a curved
// surface: 2 to 5 mm, some times the fabric's own.
#include "voile/fabrics.hpp"

namespace voile
{

Fabric silk()
{
    Fabric f;
    f.areal_density = 0.082f;          // 19 momme; one is 4.340 g/m^2, and charmeuse has 12 to 30 (trade data)
    f.stretch_stiffness = {1400, 740}; // typical KES secants 15 and 8 kN/m, LT 0.65
    f.shear_stiffness = 17;            // typical, G 0.2-0.4 gf/(cm degree)
    f.bending_stiffness = 1.8e-6f;     // typical, 0.8-3e-6. In dataset.csv of Feng et al. 2022 limp fabrics of
                                       // 0.07-0.10 kg/m^2 have 0.6-2.0e-6, the mean of warp and weft
    f.thickness = 0.002f;              // the fabric's own: typical, 0.22 mm
    f.static_friction = 0.3f;          // typical, 0.25-0.40
    f.kinetic_friction = 0.25f;        // typical, 0.20-0.35
    f.bending_model = BendingModel::isometric;
    return f;
}

Fabric cotton()
{
    Fabric f;
    f.areal_density = 0.1238f;          // Matsudaira et al. 2015, "cotton broad": 12.38 mg/cm^2
    f.stretch_stiffness = {1900, 1100}; // typical KES secants 16 and 9 kN/m, LT 0.70
    f.shear_stiffness = 80;             // typical, G 0.8-2.0 gf/(cm degree)
    f.bending_stiffness = 1.77e-5f;     // Matsudaira et al. 2015, the same: B 0.118, 2HB 0.124 in KES units
    f.thickness = 0.003f;               // the fabric's own: 0.497 mm (the same), 0.318 mm (Penava et al. 2014)
    f.static_friction = 0.6f;           // typical, 0.5-0.8
    f.kinetic_friction = 0.5f;          // typical, 0.40-0.65
    f.bending_model = BendingModel::isometric;
    return f;
}

Fabric wool()
{
    Fabric f;
    f.areal_density = 0.1629f;         // Matsudaira et al. 2015, "wool tropical": 16.29 mg/cm^2
    f.stretch_stiffness = {730, 1200}; // the FAST report, tables V and VI: 0.67 and 0.40 % at 4.9 N/m
    f.shear_stiffness = 26;            // the FAST report
    f.bending_stiffness = 6.57e-6f;    // Matsudaira et al. 2015, the same: B 0.067; B + HB is 8.2e-6. The cantilever of
                                       // the FAST report, which has the friction in it, is 5.3e-6, so none is added
    f.thickness = 0.004f;              // the fabric's own: 0.407 mm (Matsudaira et al. 2015, the same)
    f.static_friction = 0.5f;          // typical, 0.4-0.6
    f.kinetic_friction = 0.4f;         // typical, 0.3-0.5
    f.bending_model = BendingModel::isometric;
    return f;
}

Fabric denim()
{
    Fabric f;
    f.areal_density = 0.324f;           // Wang et al. 2011, 11 oz: "density"
    f.stretch_stiffness = {1100, 1100}; // Kumari and Khurana 2016, table 5: means of six, EMT 5.21 % at 490 N/m, which
                                        // is 9.4 kN/m, and LT 0.70. Wang et al. 2011 fit 205 and 1014 at low loads
    f.shear_stiffness = 89;             // Kumari and Khurana 2016, table 5: median of six, G 1.58 gf/(cm degree), of
                                        // 1.50 to 3.40. Wang et al. 2011: 53
    f.bending_stiffness = 2.0e-5f;      // Wang et al. 2011, "bending", first column: a quarter of 6.42e-5 and 9.70e-5,
                                        // along warp and weft, in the mean. Kumari and Khurana 2016, table 5: B 1.4 to
                                        // 2.2e-5, with friction 2.1 to 3.1e-5. Feng et al. 2022, eight fabrics of 0.31
                                        // to 0.34 kg/m^2: 1 to 11e-5
    f.thickness = 0.005f;               // the fabric's own: 0.80 to 1.19 mm (Kumari and Khurana 2016, table 5)
    f.static_friction = 0.6f;           // typical, 0.5-0.8
    f.kinetic_friction = 0.5f;          // typical, 0.40-0.65
    f.bending_model = BendingModel::isometric;
    return f;
}

Fabric leather()
{
    Fabric f;
    f.areal_density = 0.5f;             // typical, 0.6 g/cm^3 at 0.64-0.96 mm
    f.stretch_stiffness = {1900, 1100}; // typical: 5 along and 3 kN/m across the backbone at 98 N/m, LT 0.8
    f.shear_stiffness = 560;            // no measurement; a felt has no yarns to turn: E / (2 (1 + nu)), nu 0.35
    f.bending_stiffness = 2.5e-5f;      // chosen in 1-8e-5, typical, to give the middle of the drape coefficients that
                                        // Memon et al. 2021 measured, 47.35 to 69.9 %; so these do not confirm it
    f.thickness = 0.005f;               // the leather's own: 0.64 to 0.96 mm (Memon et al. 2021)
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

} // namespace voile
