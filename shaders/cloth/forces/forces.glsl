// The acceleration of a vertex: springs, bending, air and gravity, gathered from its neighbors. Without atomics, so
// that the order of the sum never changes.
//
// The including kernel declares cloths[], stage_positions[], stage_residuals[], stage_velocities[], mesh_vertices[],
// mesh_springs[], mesh_corners[], membrane_corners[] and `push` (StagePush).
#ifndef VOILE_FORCES_GLSL
#define VOILE_FORCES_GLSL

#include "shared/patch.glsl"
#include "shared/fine_position.glsl"
#include "shared/mesh.glsl"
#include "integration/stability.glsl"
#include "forces/wind.glsl"
#include "shared/step_input.glsl"

struct Gather
{
    FinePosition x;    // of the vertex
    vec3 v;            // m/s
    vec3 force;        // N, of the springs
    float energy;      // J, the vertex's part of what the springs store
    vec3 bending;      // N, of the isometric model; while neighbors are added, without damping and stability scale
    vec3 bending_rate; // N/s, what damping acts on
    vec3 gust;         // m/s, at x
    vec3 air;          // N
    float air_rate;    // N s/m, force over relative velocity
    Viscosity viscosity;
};

// Verlet has no damping of its own. Springs that change much within a substep gain energy, because modes near the
// stability limit resonate. Therefore fast springs are viscous, with a coefficient that grows with the speed (von
// Neumann and Richtmyer 1950, "A method for the numerical calculation of hydrodynamic shocks"). If both ends approach
// or part by more than k_viscous_strain of the rest length per substep, the force acts along the spring. If one end
// passes the other by more than k_viscous_shear of it, the force acts in all directions. Slower springs have no
// viscosity. The forces of a pair are equal and opposite. See bench/NOTES.md for the measurements behind the numbers.
const float k_viscous_strain = 0.02;
const float k_viscous_shear = 0.2;

void add_spring(inout Gather g, float stiffness, float damping, float rest_length, vec3 delta, vec3 relative_velocity)
{
    const float length_squared = max(dot(delta, delta), 1e-20); // vertices that coincide have no direction and no force
    const float inverse_length = inversesqrt(length_squared);
    const vec3 direction = delta * inverse_length;
    // (l^2 - L^2) / (l + L), with products that are not rounded before they cancel: a spring at rest has no force.
    const float excess =
        fma(delta.x, delta.x, fma(delta.y, delta.y, fma(delta.z, delta.z, -rest_length * rest_length)));
    const float stretch = excess * (1 / (length_squared * inverse_length + rest_length));
    const float rate = dot(relative_velocity, direction);
    float viscosity = 0;
    if (g.viscosity.is_on)
    {
        // Without branches: among threads that run together some vertex nearly always has a fast spring.
        // Huge for a spring without length, whose stiffness is 0.
        const float per_length = seconds(push.substeps) / max(rest_length, 1e-9);
        const float sharpness = g.viscosity.sharpness;
        const float along = clamp(fma(abs(rate), per_length * sharpness, -k_viscous_strain * sharpness), 0, 1);
        const float across = clamp(fma(dot(relative_velocity, relative_velocity), per_length * per_length * sharpness,
                                       -k_viscous_shear * k_viscous_shear * sharpness), 0, 1);
        // A stretched spring resists in all directions and leaves less of the stability region.
        const float ratio = clamp(rest_length * inverse_length, 0, 1);
        const float scale = ratio * ratio * g.viscosity.scale * stiffness;
        viscosity = scale * along;
        g.force += scale * across * relative_velocity;
    }
    g.force += (stiffness * stretch + (damping + viscosity) * rate) * direction;
    g.energy += 0.25 * stiffness * stretch * stretch;
}

// m/s, at the vertex. Without gusts it takes no registers while springs are gathered.
vec3 wind(Gather g) { return step_input.wind + (push.gusts == 0 ? vec3(0) : g.gust); }

// Drag of the air on a `fraction` of the triangle that the edges to two neighbors span, with the vertex's velocity:
// 1/2 rho A C |u| u along the normal and across it. The parts along and across the wind are drag and lift.
void add_air(inout Gather g, uint cloth, vec3 to_b, vec3 to_c, float fraction)
{
    const vec3 across = cross(to_b, to_c); // twice the area, along the normal
    const float across_length = length(across);
    if (across_length < 1e-20)
        return;
    const vec3 n = across / across_length;
    // Beyond these bounds of speed and area the force in the densest air would overflow.
    const vec3 u = clamp(wind(g) - g.v, vec3(-VOILE_MOST_AIR_SPEED), vec3(VOILE_MOST_AIR_SPEED));
    const float u_n = dot(u, n);
    const vec3 u_t = u - u_n * n;
    const float c = 0.25 * step_input.air_density * fraction * min(across_length, VOILE_MOST_AIR_AREA);
    const float normal = c * cloths[cloth].drag_normal * abs(u_n);
    const float tangential = c * cloths[cloth].drag_tangential * length(u_t);
    g.air += normal * u_n * n + tangential * u_t;
    g.air_rate += normal + tangential;
}

bool feels_air(uint cloth) { return cloths[cloth].drag_normal + cloths[cloth].drag_tangential > 0; }
bool bends_isometrically(uint cloth) { return (cloths[cloth].flags & VOILE_CLOTH_ISOMETRIC) != 0; }

FinePosition position_of(uint vertex)
{
    const vec3 x = stage_positions[vertex].xyz;
    return FinePosition(x, unpack_residual(stage_residuals[vertex]));
}

// m, from the vertex to another.
vec3 delta_to(Gather g, uint other) { return displacement(g.x, position_of(other)); }

// Another vertex as one sees it.
struct Neighbor
{
    vec3 delta;    // m
    vec3 velocity; // m/s, relative
};

// `weight`: of the neighbor in the bending energy.
void add_bending(inout Gather g, Neighbor other, float weight)
{
    g.bending += weight * other.delta;
    g.bending_rate += weight * other.velocity;
}

// `weight`: of the spring, in its family.
SpringClass scaled(SpringClass spring, float weight, StabilityScales scales)
{
    spring.stiffness *= weight * scales.stiffness;
    spring.damping = weight * scales.damping * spring.damping + scales.retardation * spring.stiffness;
    return spring;
}

bool has_springs(SpringClass spring) { return spring.stiffness + spring.damping > 0; }

// The force of bending, N, from what neighbors have added to it and to its rate.
void end_bending(inout Gather g, uint cloth, StabilityScales scales)
{
    // Precise, so that compilers do not merge it with the sum of parts.
    precise const vec3 force =
        scales.stiffness * g.bending + scales.damping * cloths[cloth].bending_time * g.bending_rate;
    g.bending = force;
}

#include "forces/mesh_forces.glsl"
#include "forces/grid_forces.glsl"

// All forces on a vertex except gravity and linear drag. Where threads share those of a mesh, all of a patch call it, and
// the first ones of its vertices get them.
Gather gather(PatchVertex self, FinePosition x, vec3 v, vec3 gust, Viscosity viscosity, StabilityScales scales)
{
    Gather g;
    g.x = x;
    g.v = v;
    g.force = g.bending = g.bending_rate = g.air = vec3(0);
    g.energy = g.air_rate = 0;
    g.gust = gust;
    g.viscosity = viscosity;
    if (self.columns == 0)
    {
        gather_mesh(g, self.cloth, self.local, scales);
        return g;
    }
    gather_grid(g, self.cloth, self, scales);
    end_bending(g, self.cloth, scales);
    return g;
}

// The acceleration of a vertex, m/s^2.
vec3 acceleration(bool verlet, PatchVertex self, FinePosition x, float inverse_mass, vec3 v)
{
    const uint cloth = self.cloth;
    const float h = seconds(push.substeps);
    const StabilityScales scales = scales_of(verlet, cloth, h);
    Viscosity viscosity = k_no_viscosity;
    if (verlet)
        viscosity = viscosity_of(scales, cloths[cloth].flat_omega_squared, cloths[cloth].decay, h);
    const Gather g = gather(self, x, v, gust_at(x), viscosity, scales);
    const float drag = scales.damping * cloths[cloth].linear_drag; // N s/m
    const float air = air_scale(verlet, inverse_mass * g.air_rate, h);
    precise const vec3 gravity = cloths[cloth].gravity_scale * step_input.gravity; // with a scale of 1 it changes no bit
    return gravity + inverse_mass * (g.force + g.bending + drag * (wind(g) - v) + air * g.air);
}

#endif
