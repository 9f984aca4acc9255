#version 460
#extension GL_GOOGLE_include_directive : require
// Copies the vertices of a cloth into a vertex buffer of the host's. One thread per vertex of that cloth.
#include "shared/bindings.h"
#include "shared/output_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(positions)) readonly buffer Positions { vec4 positions[]; };
layout(VOILE_BINDING(velocities)) readonly buffer Velocities { vec4 velocities[]; };
layout(VOILE_BINDING(normals)) readonly buffer Normals { vec4 normals[]; };
layout(VOILE_BINDING(previous_positions)) readonly buffer PreviousPositions { vec4 previous_positions[]; };
layout(VOILE_BINDING(host_vertices)) writeonly buffer HostVertices { float host_vertices[]; };

layout(push_constant, std430) uniform Push { OutputPush push; };

void write(uint word, vec3 value)
{
    host_vertices[word] = value.x;
    host_vertices[word + 1] = value.y;
    host_vertices[word + 2] = value.z;
}

void main()
{
    const uint local = gl_GlobalInvocationID.x;
    if (local >= push.vertices)
        return;
    const uint i = push.first_vertex + local;
    const uint first = push.first_word + local * push.stride;
    if (push.position != VOILE_NO_ATTRIBUTE)
        write(first + push.position, positions[i].xyz);
    if (push.normal != VOILE_NO_ATTRIBUTE)
        write(first + push.normal, normals[i].xyz);
    if (push.velocity != VOILE_NO_ATTRIBUTE)
        write(first + push.velocity, velocities[i].xyz);
    if (push.previous != VOILE_NO_ATTRIBUTE)
        write(first + push.previous, previous_positions[i].xyz);
}
