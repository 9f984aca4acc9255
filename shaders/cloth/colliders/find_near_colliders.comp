#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the colliders near each patch of cloth until the next such pass, one bit per collider. One workgroup per patch.
//
// The patch's box has room for twice the speed of its vertices, and at least for the speed step_input.sudden. A bit is
// set if the box of all that the collider sweeps until the end of the step overlaps the patch's box.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/feature_layout.h"
#include "shared/padded_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
const uint COLLIDERS_MOVE = 1;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(positions)) readonly buffer Positions { vec4 positions[]; };
layout(VOILE_BINDING(velocities)) readonly buffer Velocities { vec4 velocities[]; };
layout(VOILE_BINDING(colliders)) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(VOILE_BINDING(collider_motions)) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(VOILE_BINDING(padded_boxes)) readonly buffer PaddedBoxes { PaddedBox padded_boxes[]; };
layout(VOILE_BINDING(feature_sets)) readonly buffer FeatureSets { FeatureSet feature_sets[]; };
layout(VOILE_BINDING(near_colliders)) writeonly buffer NearColliders { uint near_colliders[]; };

layout(push_constant, std430) uniform Push { NearCollidersPush push; };

#include "shared/box.glsl"
#include "shared/patch.glsl"
#include "shared/step_input.glsl"
#include "colliders/collider_pose.glsl"
#include "colliders/swept_box.glsl"

// In thicknesses: room for the lists of candidates and for rounding beyond the thickness.
const float k_near_room = 2.0;
// The largest rate of a rotation along the chord of two quaternions over an even rotation.
const float k_chord_rate = 1.3;

shared Box boxes[gl_WorkGroupSize.x];
shared uint first_word;
shared uint end_word;

// The positions that the patch's vertices can have until the next pass.
Box box_of_patch(PatchVertex self)
{
    const uint thread = gl_LocalInvocationID.x;
    boxes[thread] = Box(vec3(3e38), vec3(-3e38));
    if (self.exists)
    {
        const vec3 x = positions[self.index].xyz;
        const float speed = max(2 * length(velocities[self.index].xyz), step_input.sudden);
        boxes[thread] = grown(Box(x, x), speed * seconds(push.substeps) + k_near_room * cloths[self.cloth].thickness);
    }
    barrier();
    for (uint half_size = gl_WorkGroupSize.x / 2; half_size > 0; half_size /= 2)
    {
        if (thread < half_size)
            boxes[thread] = joined(boxes[thread], boxes[thread + half_size]);
        barrier();
    }
    return boxes[0];
}

// m: contact treats the path of a vertex within a substep as straight in the collider's space. A rotating collider can
// come closer than its radius says to a vertex `distance` away by this.
float turning_margin(ColliderMotion motion, float distance)
{
    const float angle = 2 * acos(clamp(dot(motion.rotation_from, motion.rotation_to), 0, 1));
    return k_chord_rate * angle * push.progress_per_substep * distance;
}

// m: within a substep a collider may carry a vertex aside by half of its own motion (held_box in feature_pieces.glsl).
float carrying_margin(ColliderMotion motion)
{
    return 1.4 * distance(motion.offset_from, motion.offset_to) * push.progress_per_substep * float(push.substeps);
}

// Whether the collider may touch the box until the end of the step.
bool touches(uint c, ColliderRecord collider, Box box)
{
    if (collider.kind == VOILE_COLLIDER_PLANE)
        return true;
    Box around = swept_box(c, collider);
    if (is_moved(collider.flags))
    {
        const vec3 farthest = max(abs(around.max - box.min), abs(box.max - around.min));
        const ColliderMotion motion = collider_motions[c];
        around = grown(around, turning_margin(motion, length(farthest)) + carrying_margin(motion));
    }
    return overlap(around, box);
}

// A box that is not finite overlaps every collider.
uint bits_of(uint word, uint cloth, Box box)
{
    const float farthest = length(max(abs(box.min), abs(box.max)));
    const float margin = 1.01 * cloths[cloth].thickness + k_near_rounding * farthest;
    uint bits = 0;
    const uint end = min(32, push.colliders - 32 * word);
    for (uint bit = 0; bit < end; ++bit)
    {
        const uint c = 32 * word + bit;
        const ColliderRecord collider = colliders[c];
        if ((collider.layers & cloths[cloth].layers) == 0)
            continue;
        const bool has_features = push.features != 0 && feature_sets[c].features > 0;
        const float loose = has_features ? 2 * VOILE_MOST_STRETCH * feature_sets[c].edge : 0;
        bits |= touches(c, collider, grown(box, margin + loose)) ? 1u << bit : 0;
    }
    return bits;
}

void write_corner(uint word, vec3 corner)
{
    for (int axis = 0; axis < 3; ++axis)
        near_colliders[word + axis] = floatBitsToUint(corner[axis]);
}

void main()
{
    const uint thread = gl_LocalInvocationID.x;
    const uint words = (push.colliders + 31) / 32;
    if (thread == 0)
    {
        first_word = words;
        end_word = 0;
    }
    const PatchVertex self = patch_vertex(push.first_patch + gl_WorkGroupID.x);
    const uint header = (push.first_patch + gl_WorkGroupID.x) * push.near_stride;
    if (self.asleep)
    {
        write_corner(header + VOILE_NEAR_MIN, vec3(3e38)); // a list for no position: statistics visit all colliders
        return;
    }
    const Box box = box_of_patch(self);
    for (uint word = thread; word < words; word += gl_WorkGroupSize.x)
    {
        const uint bits = bits_of(word, self.cloth, box);
        near_colliders[header + VOILE_NEAR_WORDS + word] = bits;
        if (bits != 0)
        {
            atomicMin(first_word, word);
            atomicMax(end_word, word + 1);
        }
    }
    barrier();
    if (thread > 0)
        return;
    write_corner(header + VOILE_NEAR_MIN, box.min);
    write_corner(header + VOILE_NEAR_MAX, box.max);
    near_colliders[header + VOILE_NEAR_FIRST] = first_word;
    near_colliders[header + VOILE_NEAR_END] = end_word;
}
