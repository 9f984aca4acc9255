#version 460
#extension GL_GOOGLE_include_directive : require
// For tests: a thread queries an implicit complete BVH with one box and writes the leaves that it visits.
// Reads: boxes, queries. Writes: answers.
#include "shared/padded_layout.h"
#include "visit_padded_layout.h"

layout(local_size_x_id = 0) in;

layout(set = 0, binding = VISIT_BOXES, std430) readonly buffer Boxes { PaddedBox padded_boxes[]; };
layout(set = 0, binding = VISIT_QUERIES, std430) readonly buffer Queries { PaddedBox queries[]; };
layout(set = 0, binding = VISIT_ANSWERS, std430) writeonly buffer Answers { uint answers[]; };

layout(push_constant, std430) uniform Push { VisitPush push; };

#include "shared/box.glsl"

// An answer: the number of leaves, then the leaves as far as they fit.
struct LeafQuery
{
    Box box;
    uint found;
};

bool enters_node(LeafQuery query, Box node) { return overlap(query.box, node); }

void visit_leaf(inout LeafQuery query, uint first, uint count)
{
    for (uint slot = first; slot < first + count; ++slot)
        if (++query.found < push.room)
            answers[gl_GlobalInvocationID.x * push.room + query.found] = slot;
}

#define VOILE_QUERY LeafQuery
#include "colliders/padded.glsl"

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= push.queries)
        return;
    LeafQuery query = LeafQuery(Box(queries[i].min, queries[i].max), 0);
    traverse_padded(query, push.first_box, push.first_leaf, push.triangles);
    answers[i * push.room] = query.found;
}
