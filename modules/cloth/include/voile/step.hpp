// Step: the input of one call of Solver::record, and Stability: its substeps for one cloth.
#pragma once

#include "voile/export.hpp"
#include "voile/math.hpp"
#include "voile/result.hpp"

#include <cstdint>

namespace voile
{

// One call of record. All values must be finite and in their range, vectors in each component (voile/ranges.hpp).
struct Step
{
    float duration = 1.f / 60; // s, 1e-6..10

    // Substeps of every cloth, 0..1000000. 0: each cloth takes as many as it needs (Solver::stability). A cloth that
    // needs more than it takes is softened. If steps differ in their length, the longest one softens it; its stiffness
    // comes back within about a second. One long step moves cloth, a hem of 1 m by up to 0.3 m in 0.5 s: clamp the
    // duration (docs/performance.md).
    uint32_t substeps = 0;

    // The most substeps that a cloth takes if `substeps` is 0, 1..1000000.
    uint32_t max_substeps = 2000;

    // The strain limit of softened cloth if `substeps` is 0, 0.001..10; 0: none. A cloth that takes fewer substeps than
    // it needs, because of max_substeps or max_vertex_substeps, would sag like rubber. It gets this limit then, unless
    // its material has one. It acts once per step, with fewer passes than a material's (material.hpp). It takes
    // part of the velocity of neighbors relative to each other, less that of a rotation, and adds no energy. With few
    // substeps it slows cloth that spins freely or swings (docs/performance.md). Diagonals, which lengthen as cloth
    // shears, may lengthen by 0.2. Cloth that takes all of its substeps moves as without the limit, bit for bit.
    // - 1 m of cotton of 64 x 64 and 128 x 128 vertices needs 175 and 353 substeps per 1/60 s under Verlet. In 16
    //   substeps, 99 % of its structural springs stay below a stretch of 0.08, both when it hangs from two corners and
    //   when it falls over a mesh of 1 m. For 64 x 64 vertices that hang from two corners, 8 substeps suffice.
    // - A mesh of 40 x 40 vertices of it that hangs from two vertices, anywhere, stays below 0.07 in 16 substeps along
    //   warp and weft, an irregular one with its vertices in no order below 0.14.
    // - Pins count that the cloth has when it is uploaded. With others, set later, 0.14 instead of 0.06.
    float softened_strain_limit = 0.02f;

    // Budget for the sum of vertices times substeps over all enabled cloths, if `substeps` is 0. If they need more, all
    // cloths take at least the same fraction of the substeps that they need (of max_substeps, if they need more than
    // that), and at least one. Solver::stability reports the remaining stiffness. 0: no budget.
    uint64_t max_vertex_substeps = 0;

    Vec3 gravity{0, -9.81f, 0}; // m/s^2, -1e4..1e4
    Vec3 wind{0.f};             // m/s, -1e3..1e3
    float gust = 0;             // root mean square of the gusts as a fraction of the wind's speed, 0..10
    float gust_length = 4;      // m, 0.01..1e6: the wavelength of the longest gusts; the shortest are an eighth of it
    double time = 0;            // s, -1e9..1e9, at the step's start; the gusts depend on it and the position alone
    float air_density = 1.225f; // kg/m^3, 0..1e5
};

// Errors: a member out of its range, with its name and value.
VOILE_API Result<void> validate(const Step& step);

// The substeps of a cloth in a step that simulates it and all enabled cloths that are uploaded. For an id that is not
// valid, all members have their defaults.
struct Stability
{
    uint32_t needed = 0;       // substeps with which it keeps all of its stiffness and damping; 1000000: that or more
    uint32_t used = 0;         // substeps that it takes; fewer than needed only if the step limits them
    float stiffness_scale = 1; // factor of its stiffness in this step, 0..1
    float damping_scale = 1;   // factor of its damping in this step, 0..1
    float load = 0;            // fraction of the integrator's stability limit that the substep takes up, 0..0.95
    // s: softened springs under Verlet get damping of this time times their stiffness, besides their own (Kelvin and
    // Voigt), so that cloth on a budget does not shake. 0 with all substeps, under RK4, and where their own suffices.
    float retardation = 0;
};

} // namespace voile
