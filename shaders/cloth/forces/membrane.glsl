// Stretch and shear of a fabric on a triangle: four springs along its warp, its weft and both diagonals between them.
//
// The deformation gradient F maps a unit vector d of the fabric to F d, whose length is 1 at rest. Each direction has
// the energy weight * stiffness / 2 * (|F d| - 1)^2, so a mesh has the moduli of a grid, whatever its triangles are.
// The force on a corner is minus the gradient of the energy, F S g: S is the sum of tension * d d^T over the
// directions, and g the gradient of the corner's barycentric coordinate. Each corner computes F and S from the same
// edges in the same order. Therefore the three forces and their torques sum to 0, except for the rounding of F S g
// itself.
// Included by forces.glsl.
#ifndef VOILE_MEMBRANE_GLSL
#define VOILE_MEMBRANE_GLSL

// A symmetric matrix in warp and weft.
struct FabricMatrix
{
    float warp;
    float weft;
    float mixed;
};

// d^T m d.
float along(FabricMatrix m, vec2 d) { return d.x * d.x * m.warp + d.y * d.y * m.weft + 2 * d.x * d.y * m.mixed; }

// The least |F d|. A triangle with less has collapsed.
const float k_least_stretch = 1e-4;
// Of the squares of the stretch along the warp and the weft: less than this along a diagonal between them is rounding.
const float k_rounding = 4e-7;

// The deformation of a triangle.
struct Deformation
{
    FabricMatrix excess; // F^T F - 1
    FabricMatrix rate;   // 1/s, half of the excess' rate
};

// The response of a triangle, summed over directions.
struct FabricStress
{
    FabricMatrix stress; // N/m
    float energy;        // J/m^2
};

// `d`: the direction of the spring, a unit vector of the fabric.
void add_direction(inout FabricStress sum, Deformation deformation, vec2 d, SpringClass spring, Viscosity viscosity)
{
    const float least = max(k_least_stretch * k_least_stretch, k_rounding * (deformation.excess.warp + deformation.excess.weft));
    const float squared_excess = max(along(deformation.excess, d), least - 1);
    const float squared = max(1 + squared_excess, least);
    const float stretch = sqrt(squared);
    const float stretch_rate = along(deformation.rate, d) / squared; // 1/s, of |F d| over itself
    float tension = spring.stiffness * squared_excess / (squared + stretch) + spring.damping * stretch_rate;
    if (viscosity.is_on)
    {
        // As in add_spring, for a rest length of 1. Viscosity along the direction suffices; across it would add spin.
        const float change = abs(stretch_rate) * stretch * seconds(push.substeps);
        const float fraction = clamp((change - k_viscous_strain) * viscosity.sharpness, 0, 1);
        tension += min(1 / squared, 1) * viscosity.scale * fraction * spring.stiffness * stretch_rate;
    }
    const float strain = squared_excess / (1 + stretch); // less rounding than stretch - 1
    sum.energy += 0.5 * spring.stiffness * strain * strain;
    sum.stress.warp += tension * d.x * d.x;
    sum.stress.weft += tension * d.y * d.y;
    sum.stress.mixed += tension * d.x * d.y;
}

// A corner of a triangle.
struct TriangleCorner
{
    FinePosition x;
    vec3 v; // m/s
};

// `b`, `c`: the other two corners, counter-clockwise.
void add_membrane(inout Gather g, SpringClass springs[VOILE_MEMBRANE_SPRINGS], MembraneCorner rest, TriangleCorner b,
                  TriangleCorner c)
{
    const TriangleCorner self = TriangleCorner(g.x, g.v);
    const bool first = rest.corner == 0;
    const bool second = rest.corner == 1;
    const TriangleCorner corner_0 = first ? self : second ? c : b;
    const TriangleCorner corner_1 = first ? b : second ? self : c;
    const TriangleCorner corner_2 = first ? c : second ? b : self;
    const vec3 edge_1 = displacement(corner_0.x, corner_1.x);
    const vec3 edge_2 = displacement(corner_0.x, corner_2.x);
    const vec3 velocity_1 = corner_1.v - corner_0.v;
    const vec3 velocity_2 = corner_2.v - corner_0.v;
    const vec3 warp = rest.gradient_1.x * edge_1 + rest.gradient_2.x * edge_2; // F along the warp
    const vec3 weft = rest.gradient_1.y * edge_1 + rest.gradient_2.y * edge_2;
    const vec3 warp_rate = rest.gradient_1.x * velocity_1 + rest.gradient_2.x * velocity_2;
    const vec3 weft_rate = rest.gradient_1.y * velocity_1 + rest.gradient_2.y * velocity_2;

    const FabricMatrix excess =
        FabricMatrix(fma(warp.x, warp.x, fma(warp.y, warp.y, fma(warp.z, warp.z, -1))),
                     fma(weft.x, weft.x, fma(weft.y, weft.y, fma(weft.z, weft.z, -1))), dot(warp, weft));
    const FabricMatrix rate = FabricMatrix(dot(warp, warp_rate), dot(weft, weft_rate),
                                           0.5 * (dot(warp, weft_rate) + dot(weft, warp_rate)));
    const float k_diagonal = 0.70710678;
    const Deformation deformation = Deformation(excess, rate);
    FabricStress sum = FabricStress(FabricMatrix(0, 0, 0), 0);
    add_direction(sum, deformation, vec2(1, 0), springs[0], g.viscosity);
    add_direction(sum, deformation, vec2(0, 1), springs[1], g.viscosity);
    add_direction(sum, deformation, vec2(k_diagonal, k_diagonal), springs[2], g.viscosity);
    add_direction(sum, deformation, vec2(k_diagonal, -k_diagonal), springs[2], g.viscosity);

    const vec2 own = first    ? -(rest.gradient_1 + rest.gradient_2)
                     : second ? rest.gradient_1
                              : rest.gradient_2;
    g.energy += rest.weight * sum.energy / 3;
    const FabricMatrix stress = sum.stress;
    g.force -= rest.weight * ((stress.warp * own.x + stress.mixed * own.y) * warp +
                              (stress.mixed * own.x + stress.weft * own.y) * weft);
}

#endif
