#version 460
#extension GL_GOOGLE_include_directive : require
// One stage of the classical Runge-Kutta method (Kutta 1901) for all cloths.
//
// A thread evaluates the acceleration of one vertex, from the stage's positions and velocities of the vertex and of its
// spring neighbours (gathered: no atomics, so the sum's order never changes), and writes the next stage's state. STAGE 4
// writes the result of the step. Reads: cloths, chunks, base state, stage state. Writes: next state, running sums.
#include "cloth_layout.h"
#include "grid.glsl"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint STAGE = 1;

layout(set = 0, binding = 0, std430) readonly buffer Cloths { ClothRecord cloths[]; };
layout(set = 0, binding = 1, std430) readonly buffer Chunks { Chunk chunks[]; };
layout(set = 0, binding = 2, std430) readonly buffer BasePositions { vec4 base_positions[]; }; // w: inverse mass, 1/kg
layout(set = 0, binding = 3, std430) readonly buffer BaseVelocities { vec4 base_velocities[]; };
layout(set = 0, binding = 4, std430) readonly buffer StagePositions { vec4 stage_positions[]; };
layout(set = 0, binding = 5, std430) readonly buffer StageVelocities { vec4 stage_velocities[]; };
layout(set = 0, binding = 6, std430) writeonly buffer NextPositions { vec4 next_positions[]; };
layout(set = 0, binding = 7, std430) writeonly buffer NextVelocities { vec4 next_velocities[]; };
layout(set = 0, binding = 8, std430) buffer VelocitySums { vec4 velocity_sums[]; };         // k1 + 2 k2 + 2 k3 of x
layout(set = 0, binding = 9, std430) buffer AccelerationSums { vec4 acceleration_sums[]; }; // k1 + 2 k2 + 2 k3 of v

layout(push_constant, std430) uniform Push { StagePush push; };

// Force of the springs of one class on the vertex, N.
vec3 spring_force(SpringClass spring, vec3 x, vec3 v, vec3 other_x, vec3 other_v)
{
    const vec3 delta = other_x - x;
    const float length_squared = max(dot(delta, delta), 1e-20); // coinciding vertices: no direction, no force
    const float inverse_length = inversesqrt(length_squared);
    const vec3 direction = delta * inverse_length;
    const float stretch = length_squared * inverse_length - spring.rest_length;
    return (spring.stiffness * stretch + spring.damping * dot(other_v - v, direction)) * direction;
}

// Drag of the air on the area that the vertex owns: 1/2 rho A C |u| u along the normal and across it (physics: air).
// `across` is the cross product of the central differences along row and column: four times the area, along the normal.
vec3 air_force(uint cloth, vec3 v, vec3 across)
{
    const float across_length = length(across);
    if (across_length < 1e-12)
        return vec3(0);
    const vec3 n = across / across_length;
    const float area = 0.25 * across_length;
    const vec3 u = push.wind - v;
    const float u_n = dot(u, n);
    const vec3 u_t = u - u_n * n;
    return 0.5 * push.air_density * area *
           (cloths[cloth].drag_normal * abs(u_n) * u_n * n + cloths[cloth].drag_tangential * length(u_t) * u_t);
}

vec3 acceleration(uint cloth, GridVertex self, vec3 x, float inverse_mass, vec3 v)
{
    const uint columns = cloths[cloth].columns;
    const uint rows = cloths[cloth].rows;
    const ivec2 place = ivec2(self.column, self.row);
    vec3 force = cloths[cloth].linear_drag * (push.wind - v);
    vec3 along_row = vec3(0);
    vec3 along_column = vec3(0);
    // Springs along the border stand for half a strip of the fabric where the cloth says so.
    const float border_share = cloths[cloth].border_share;
    const float row_share = self.row == 0 || self.row + 1 == int(rows) ? border_share : 1;
    const float column_share = self.column == 0 || self.column + 1 == int(columns) ? border_share : 1;
    for (int c = 0; c < VOILE_SPRING_CLASSES; ++c)
    {
        SpringClass spring = cloths[cloth].springs[c];
        const float share = c % 4 == 0 ? row_share : c % 4 == 1 ? column_share : 1;
        spring.stiffness *= share;
        spring.damping *= share;
        for (int side = 0; side < 2; ++side)
        {
            const float sign = side == 0 ? 1 : -1;
            const ivec2 offset = side == 0 ? k_spring_offsets[c] : -k_spring_offsets[c];
            if (!in_grid(place + offset, columns, rows))
                continue;
            const uint other = neighbour(self, offset, columns);
            const vec3 other_x = stage_positions[other].xyz;
            force += spring_force(spring, x, v, other_x, stage_velocities[other].xyz);
            if (c == 0)
                along_row += sign * (other_x - x);
            if (c == 1)
                along_column += sign * (other_x - x);
        }
    }
    if (cloths[cloth].drag_normal + cloths[cloth].drag_tangential > 0)
        force += air_force(cloth, v, cross(along_column, along_row));
    return push.gravity + inverse_mass * force;
}

void main()
{
    const Chunk chunk = chunks[gl_WorkGroupID.x];
    const uint cloth = chunk.cloth;
    const GridVertex self = grid_vertex(cloths[cloth].first_vertex, cloths[cloth].columns, cloths[cloth].rows,
                                        chunk.first + gl_LocalInvocationID.x);
    if (!self.exists)
        return;
    const uint i = self.index;
    const vec4 stage_x = stage_positions[i];
    const vec3 stage_v = stage_velocities[i].xyz;
    const float inverse_mass = stage_x.w;
    const vec3 a = inverse_mass > 0 ? acceleration(cloth, self, stage_x.xyz, inverse_mass, stage_v) : vec3(0);

    // Stage 1's state is the base state: one read serves both.
    const vec3 x = STAGE == 1 ? stage_x.xyz : base_positions[i].xyz;
    const vec3 v = STAGE == 1 ? stage_v : base_velocities[i].xyz;
    const float h = push.step;
    if (STAGE == 4)
    {
        next_positions[i] = vec4(x + h / 6 * (velocity_sums[i].xyz + stage_v), inverse_mass);
        next_velocities[i] = vec4(v + h / 6 * (acceleration_sums[i].xyz + a), 0);
        return;
    }
    const float reach = STAGE == 3 ? h : 0.5 * h;
    next_positions[i] = vec4(x + reach * stage_v, inverse_mass);
    next_velocities[i] = vec4(v + reach * a, 0);
    if (STAGE == 1)
    {
        velocity_sums[i] = vec4(stage_v, 0);
        acceleration_sums[i] = vec4(a, 0);
    }
    else
    {
        velocity_sums[i].xyz += 2 * stage_v;
        acceleration_sums[i].xyz += 2 * a;
    }
}
