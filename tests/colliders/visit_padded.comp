#version 460
#extension GL_GOOGLE_include_directive : require
// For tests: a thread asks a padded tree with one box and writes down what it is handed.
// Reads: boxes, queries. Writes: answers.
#include "shared/padded_layout.h"
#include "visit_padded_layout.h"

layout(local_size_x_id = 0) in;

layout(set = 0, binding = 0, std430) readonly buffer Boxes { PaddedBox padded_boxes[]; };
layout(set = 0, binding = 1, std430) readonly buffer Queries { PaddedBox queries[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Answers { uint answers[]; };

layout(push_constant, std430) uniform Push { VisitPush push; };

uint found = 0;

bool boxes_overlap(vec3 a_min, vec3 a_max, vec3 b_min, vec3 b_max)
{
    return all(lessThanEqual(a_min, b_max)) && all(lessThanEqual(b_min, a_max));
}

void take_leaf(uint first, uint count)
{
    for (uint slot = first; slot < first + count; ++slot)
        if (++found < push.room)
            answers[gl_GlobalInvocationID.x * push.room + found] = slot;
}

#include "colliders/padded.glsl"

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= push.queries)
        return;
    visit_padded(push.first_box, push.first_leaf, push.triangles, queries[i].min, queries[i].max);
    answers[i * push.room] = found;
}
