// A box of an implicit complete BVH (padded_layout.h).
//
// The including kernel declares `padded_boxes[]` and includes box.glsl before.
#ifndef VOILE_PADDED_BOX_GLSL
#define VOILE_PADDED_BOX_GLSL

Box padded_box(uint index) { return Box(padded_boxes[index].min, padded_boxes[index].max); }

// Leaves that wait until a thread of a traversal has several. Neighboring threads find theirs at different iterations. Taking
// them together keeps the triangle tests out of the loop over nodes.
const uint k_waiting_leaves = 8;

#endif
