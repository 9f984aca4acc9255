#version 460
#extension GL_GOOGLE_include_directive : require
// Transforms the vertices that the host gives for a deforming mesh into the collider's space. One thread per vertex.
// A vertex that is not finite, or outside of the range of positions, keeps its position. Finds the longest displacement.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(deforming_input)) readonly buffer DeformingInput { float words[]; };
layout(VOILE_BINDING(deforming_positions)) buffer DeformingPositions { vec4 deforming_positions[]; };
layout(VOILE_BINDING(deforming_reach)) buffer DeformingReach { uint deforming_reach[]; };

layout(push_constant, std430) uniform Push { DeformPush push; };

shared uint reach_of_group; // floats that are not negative have the order of their bits

// Returns the displacement of the vertex, m.
float move_vertex(uint i)
{
    const uint word = push.first_word + i * push.stride;
    vec3 p = (push.transform * vec4(words[word], words[word + 1], words[word + 2], 1)).xyz;
    const vec3 before = deforming_positions[push.first_from + i].xyz;
    if (any(isnan(p)) || any(greaterThan(abs(p + push.origin), vec3(VOILE_MOST_COORDINATE))))
        p = before;
    deforming_positions[push.first_to + i] = vec4(p, 0);
    return distance(before, p);
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (gl_LocalInvocationID.x == 0)
        reach_of_group = 0;
    barrier();
    if (i < push.vertices)
        atomicMax(reach_of_group, floatBitsToUint(move_vertex(i)));
    barrier();
    if (gl_LocalInvocationID.x == 0)
        atomicMax(deforming_reach[0], reach_of_group);
}
