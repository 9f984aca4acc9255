#version 460
#extension GL_GOOGLE_include_directive : require
// Holds that give: springs, leashes and backstops, once a substep after integration. One thread a hold.
//
// A spring is taken by backward Euler, v' = v + h w (k (p - x - h (v' - v)) + c (u - v')), with p and u its place and the
// place's velocity, w the inverse mass. What it adds to the velocity moves the vertex for half of the substep after RK4, in
// which it acted throughout, and for all of it with Verlet's velocities between positions: a vertex at rest stays there. A
// leash and a backstop put the vertex back and take the velocity that leads out.
// Reads: holds, anchors, cloths. Writes: proposed state and residuals, predicted
// velocities.
#include "shared/cloth_layout.h"

layout(local_size_x_id = 0) in;

layout(set = 0, binding = 0, std430) readonly buffer Holds { HoldRecord holds[]; };
layout(set = 0, binding = 1, std430) readonly buffer Anchors { AnchorRecord anchors[]; };
layout(set = 0, binding = 2, std430) readonly buffer Cloths { ClothRecord cloths[]; };
layout(set = 0, binding = 3, std430) buffer Positions { vec4 positions[]; };
layout(set = 0, binding = 4, std430) buffer Velocities { vec4 velocities[]; };
layout(set = 0, binding = 5, std430) buffer Predicted { vec4 predicted[]; }; // of cloths that use Verlet
layout(set = 0, binding = 6, std430) buffer Residuals { uvec2 residuals[]; };

layout(push_constant, std430) uniform Push { HoldPush push; };

#include "shared/fine_position.glsl"
#include "integration/integrator.glsl"

// Puts a vertex that is `outside` m beyond a bound back along n, and takes the velocity that leads it out. False: it is not.
bool keep_inside(inout vec3 shift, inout vec3 v, vec3 n, float outside, vec3 place_velocity)
{
    if (outside <= 0)
        return false;
    shift -= outside * n;
    v -= max(dot(v - place_velocity, n), 0) * n;
    return true;
}

void main()
{
    if (gl_GlobalInvocationID.x >= push.count)
        return;
    const HoldRecord hold = holds[push.first + gl_GlobalInvocationID.x];
    const vec4 position = positions[hold.vertex];
    if (position.w == 0)
        return;
    const AnchorRecord anchor = anchors[hold.anchor];
    const vec3 from = (anchor.from * vec4(hold.place, 1)).xyz;
    const vec3 to = (anchor.to * vec4(hold.place, 1)).xyz;
    const vec3 place = mix(from, to, push.progress);
    const float h = push.step;
    const FinePosition here = FinePosition(position.xyz, unpack_residual(residuals[hold.vertex]));
    const vec3 to_vertex = (position.xyz - place) + here.residual;
    vec3 shift = vec3(0); // m, of the vertex
    const vec4 velocity = velocities[hold.vertex];
    vec3 v = velocity.xyz;

    const vec3 place_velocity = (to - from) * push.rate;
    const float stiffness = hold.stiffness;
    const float w = position.w;
    const vec3 pull = stiffness * (h * v - to_vertex) + hold.damping * place_velocity;
    const vec3 spring_velocity = (v + h * w * pull) / (1 + h * w * (hold.damping + h * stiffness));
    const bool verlet = is_verlet(cloths[hold.cloth].flags);
    shift += drift_time(verlet, h) * (spring_velocity - v);
    v = spring_velocity;

    const vec3 offset = to_vertex + shift;
    const float distance = length(offset);
    bool taut = false;
    if (distance > hold.max_distance)
        taut = keep_inside(shift, v, offset / distance, distance - hold.max_distance, place_velocity);
    if ((hold.flags & VOILE_HOLD_BACKSTOP) != 0)
    {
        const vec3 n = normalize(mat3(anchor.to) * hold.normal);
        taut = keep_inside(shift, v, -n, -dot(to_vertex + shift, n) - hold.backstop, place_velocity) || taut;
    }
    const FinePosition next = moved(here, shift);
    positions[hold.vertex].xyz = next.x;
    residuals[hold.vertex] = pack_residual(next);
    // After the strain limit (step 0) Verlet's last half kick is done, and the next step must not make up for it.
    velocities[hold.vertex] = vec4(v, taut && h > 0 ? uint(velocity.w) | VOILE_VERTEX_TAUT : velocity.w);
    if (verlet)
        predicted[hold.vertex].xyz += v - velocity.xyz;
}
