#version 460
#extension GL_GOOGLE_include_directive : require
// One pass over the listed pairs, in two phases. One thread per vertex, which gathers all pairs that it is in from the
// lists of the owners around it (fan.glsl).
//
// Phase 0 predicts velocities, and sums up how many pairs push a vertex. Phase 1 computes impulses, and the guards
// within which no listed pair can meet until the next pass.
//
// Impulses are those of one Jacobi iteration with mass splitting (Tonge et al. 2012, "Mass splitting for jitter-free
// parallel rigid body simulation"): a vertex divides its mass among the pairs that push it. All vertices of a pair
// compute the same impulse, so momentum is kept to rounding.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
layout(constant_id = k_constant_pair_phase) const uint PHASE = 1;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_corners)) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 positions[]; };
layout(VOILE_BINDING(stage_residuals)) readonly buffer StageResiduals { uvec2 residuals[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(pairs)) readonly buffer Pairs { uvec4 pairs[]; };
layout(VOILE_BINDING(pair_distances)) readonly buffer PairDistances { float pair_distances[]; };
layout(VOILE_BINDING(pair_ranges)) readonly buffer PairRanges { vec2 pair_ranges[]; };
layout(VOILE_BINDING(pair_sweeps)) buffer PairSweeps { PairSweep pair_sweeps[]; };
layout(VOILE_BINDING(pair_guards)) writeonly buffer PairGuards { PairGuard pair_guards[]; };
layout(VOILE_BINDING(pair_memories)) buffer PairMemories { PairMemory pair_memories[]; };
layout(VOILE_BINDING(pair_motions)) buffer PairMotions { PairMotion pair_motions[]; };
layout(VOILE_BINDING(pair_impulses)) writeonly buffer PairImpulses { vec4 pair_impulses[]; };

layout(VOILE_BINDING(pair_dispatches)) writeonly buffer PairDispatches { PairDispatch pair_dispatches[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

#include "shared/patch.glsl"
#include "shared/fine_position.glsl"
#include "contact/friction_law.glsl"
#include "pairs/fan.glsl"
#include "pairs/pair.glsl"
#include "pairs/guard.glsl"

// The part of a distance by which each side may approach, per pass or per list. Less than half: both sides do.
const float k_approach = 0.45;
// The part of the thickness that no pair comes closer than, unless it begins closer.
const float k_floor = 0.1;
// A pair that is closer than its thickness parts by this part of what is missing, per pass, but not faster than, m/s:
const float k_part = 0.2;
const float k_lift_speed = 0.25;
// The part of the drift of pairs that stick that is undone in a pass, and the largest drift, as a part of the
// thickness.
const float k_undo_slip = 0.15;
const float k_longest_slip = 0.02;
const float k_keep_slip = 0.999;

// A pair at the start of the pass.
struct Meeting
{
    vec4 weights; // see Nearest
    vec3 apart;
    float distance;
    vec3 n;       // unit, towards the first side
    vec3 approach; // m/s, relative velocity of the first side's point
    float wanted; // m/s, the change of relative velocity along n; not above 0: the pair is not pushed
    float splitting; // 1/kg, the inverse mass of the pair, each vertex with the part of its mass that the pair gets
    vec4 inverse_masses;
    vec3 slip;
    Separation separation;
};

// The velocity in the middle of the coming interval, if what acted since the last pass goes on.
vec3 predicted_velocity(uint i)
{
    const vec3 v = velocities[i].xyz;
    const bool known = positions[i].w > 0 && pair_memories[i].pass + 1 == push.pass;
    return known ? v + 0.5 * (v - pair_memories[i].velocity) : v;
}

vec3 slip_of(uint i) { return pair_memories[i].pass + 1 == push.pass ? pair_memories[i].slip : vec3(0); }

Meeting meeting_of(Pair pair)
{
    Meeting m;
    const FinePosition origin =
        FinePosition(positions[pair.vertices.x].xyz, unpack_residual(residuals[pair.vertices.x]));
    vec3 x[4];
    vec3 v[4];
    vec4 loads = vec4(0);
    vec3 slips[4];
    for (uint k = 0; k < 4; ++k)
    {
        const uint i = pair.vertices[k];
        const vec4 position = positions[i];
        x[k] = displacement(origin, FinePosition(position.xyz, unpack_residual(residuals[i])));
        m.inverse_masses[k] = position.w;
        if (PHASE == 0)
            v[k] = predicted_velocity(i);
        else
        {
            const PairMotion motion = pair_motions[i];
            v[k] = motion.velocity;
            loads[k] = motion.load;
            slips[k] = motion.slip;
        }
    }
    const Nearest nearest = nearest_points(pair.edges, x);
    m.weights = nearest.weights;
    m.apart = nearest.apart;
    m.distance = length(nearest.apart);
    m.n = nearest.apart / max(m.distance, 1e-20);
    m.approach = m.weights.x * v[0] + m.weights.y * v[1] + m.weights.z * v[2] + m.weights.w * v[3];
    const float missing = (pair.thickness - m.distance) / push.interval;
    m.wanted = (missing < 0 ? missing : min(k_part * missing, k_lift_speed)) - dot(m.approach, m.n);
    if (PHASE == 1)
    {
        m.splitting = dot(abs(m.weights) * m.inverse_masses, loads);
        m.slip = m.weights.x * slips[0] + m.weights.y * slips[1] + m.weights.z * slips[2] + m.weights.w * slips[3];
        m.separation = separate(pair.edges, x, m.n);
    }
    return m;
}

vec2 friction_of(uint i) { return unpackHalf2x16(pair_motions[i].friction); }

// The sums of phase 1.
struct Gather
{
    vec3 change; // m/s
    vec3 slip; // m, and the weights of
    float sticking;
    float touching;
};

void push_apart(Pair pair, uint place, Meeting m, inout Gather sum)
{
    if (m.wanted <= 0 || m.splitting <= 0)
        return;
    const float j = m.wanted / m.splitting;
    const vec2 friction = sqrt(friction_of(pair.vertices.x) * friction_of(pair.vertices.w));
    vec3 sliding = m.approach - dot(m.approach, m.n) * m.n;
    const vec3 drift = sliding * push.interval;
    const vec3 slip = m.slip - dot(m.slip, m.n) * m.n;
    sliding += k_undo_slip / push.interval * slip;
    const float speed = length(sliding);
    vec3 impulse = j * m.n;
    const bool sticks = speed <= friction.x * m.wanted;
    const float left = sticks ? 0 : slip_speed(speed, m.wanted, friction.x, friction.y);
    if (speed > 0)
        impulse -= (speed - left) / (speed * m.splitting) * sliding;
    const float weight = m.weights[place];
    sum.change += weight * m.inverse_masses[place] * impulse;
    sum.touching += abs(weight);
    if (sticks)
        sum.slip += weight * drift;
}

// A side of a pair does not cross the plane that its vertices have until the next pass.
void guard_from(Pair pair, uint place, Meeting m, inout PairGuard guard)
{
    const bool first = place < first_side(pair);
    const float slack = max(k_approach * (m.separation.gap - k_floor * pair.thickness), 0);
    add_plane(guard, vec4(first ? m.n : -m.n, m.separation.from_plane[place] + slack));
}

// Calls for every listed pair with the vertex. `reach`: m, from the sweep, for what is not listed.
void gather(PatchVertex self, inout float load, inout Gather sum, inout PairGuard guard, out float reach, out bool listed)
{
    const Fan fan = fan_of(self.cloth, self.index);
    reach = k_unbounded;
    listed = false;
    for (uint k = 0; k < owner_count(fan); ++k)
    {
        uint owner;
        if (!owner_of(fan, k, owner))
            continue;
        const vec2 range = pair_ranges[owner];
        reach = min(reach, range.x);
        const uint count = floatBitsToUint(range.y);
        for (uint e = 0; e < count; ++e)
        {
            const Pair pair = unpacked(pairs[owner * VOILE_PAIRS + e]);
            const uint place = place_in(pair, self.index);
            if (place == 4)
                continue;
            const uvec2 owners = owners_of(pair);
            const float at = pair_distances[owner * VOILE_PAIRS + e];
            const bool both = at <= pair_ranges[owners.x].x && at <= pair_ranges[owners.y].x;
            if (!both)
            {
                reach = min(reach, at);
                continue;
            }
            listed = true;
            const Meeting m = meeting_of(pair);
            if (PHASE == 0)
                load += m.wanted > 0 ? abs(m.weights[place]) : 0;
            else
            {
                push_apart(pair, place, m, sum);
                guard_from(pair, place, m, guard);
            }
        }
    }
    reach *= k_approach;
}

void main()
{
    if (PHASE == 1 && gl_GlobalInvocationID.x < VOILE_PAIR_DISPATCHES)
        pair_dispatches[gl_GlobalInvocationID.x].wanted = 0;
    const PatchVertex self = patch_vertex(push.first_patch + gl_WorkGroupID.x);
    if (!self.exists || (cloths[self.cloth].flags & VOILE_CLOTH_SELF_COLLISION) == 0)
        return;
    const uint i = self.index;
    float load = 0;
    Gather sum = Gather(vec3(0), vec3(0), 0, 0);
    PairGuard guard = no_guard();
    float reach;
    bool listed;
    gather(self, load, sum, guard, reach, listed);
    if (PHASE == 0)
    {
        if (!listed)
            return;
        PairMotion motion;
        motion.velocity = predicted_velocity(i);
        motion.load = load;
        motion.slip = slip_of(i);
        motion.friction = packHalf2x16(vec2(cloths[self.cloth].static_friction, cloths[self.cloth].kinetic_friction));
        pair_motions[i] = motion;
        return;
    }
    pair_sweeps[i].reach = max(reach, 0);
    pair_impulses[i] = vec4(sum.change, listed ? 1 : 0);
    if (!listed)
        return;
    guard.from = positions[i].xyz;
    guard.residual = residuals[i];
    pair_guards[i] = guard;
    PairMemory memory;
    memory.velocity = velocities[i].xyz + sum.change;
    memory.pass = push.pass;
    const vec3 slip = k_keep_slip * slip_of(i) + sum.slip / max(sum.touching, 1e-30);
    const float longest = k_longest_slip * cloths[self.cloth].pair_thickness;
    memory.slip = sum.touching > 0 ? slip * min(1, longest / max(length(slip), 1e-30)) : vec3(0);
    pair_memories[i] = memory;
}
