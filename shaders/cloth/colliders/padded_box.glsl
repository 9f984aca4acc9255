// A box of an implicit complete BVH (padded_layout.h).
//
// The including kernel declares `padded_boxes[]` and includes box.glsl before.
#ifndef VOILE_PADDED_BOX_GLSL
#define VOILE_PADDED_BOX_GLSL

Box padded_box(uint index) { return Box(padded_boxes[index].min, padded_boxes[index].max); }

#endif
