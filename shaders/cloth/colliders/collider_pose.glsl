// The pose of a collider within the step. A collider's own space is the world at the time when it was added, relative
// to its origin. Neither shape nor hierarchy changes when it moves: queries are transformed into that space and results
// back.
//
// The including kernel declares colliders[], collider_motions[] and a constant COLLIDERS_MOVE. 0: no collider moves,
// and the code for moving ones is left out.
#ifndef VOILE_COLLIDER_POSE_GLSL
#define VOILE_COLLIDER_POSE_GLSL

#include "shared/fine_position.glsl"

bool is_moved(uint flags) { return COLLIDERS_MOVE != 0 && (flags & VOILE_COLLIDER_MOVED) != 0; }
bool is_deforming(uint flags) { return COLLIDERS_MOVE != 0 && (flags & VOILE_COLLIDER_DEFORMS) != 0; }

struct Pose
{
    vec4 rotation; // unit quaternion, world from the collider's space
    vec3 position; // m, of the origin, from ColliderMotion::origin
};

vec3 rotate(vec4 q, vec3 v) { return v + 2 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
vec3 rotate_back(vec4 q, vec3 v) { return rotate(vec4(-q.xyz, q.w), v); }

// Of the origin, as in a pose. `progress`: of the step, 0..1. It moves along a straight line. mix() would round
// differently from step to step and shake a collider at rest.
vec3 origin_at(uint collider, float progress)
{
    const vec3 from = collider_motions[collider].offset_from;
    return from + progress * (collider_motions[collider].offset_to - from);
}

// The rotation moves along the chord of both quaternions.
Pose pose_at(uint collider, float progress)
{
    const vec4 from = collider_motions[collider].rotation_from;
    Pose pose;
    pose.rotation = normalize(from + progress * (collider_motions[collider].rotation_to - from));
    pose.position = origin_at(collider, progress);
    return pose;
}

// The change of a pose from one progress of the step to another. A difference of two poses would have the rounding of
// both, and would shake cloth on a collider that moves evenly by more than its weight.
struct PoseChange
{
    vec4 rotation;
    vec3 position; // m
};

PoseChange pose_change(uint collider, float from, float to)
{
    const ColliderMotion motion = collider_motions[collider];
    const float part = to - from;
    const vec4 turn = motion.rotation_to - motion.rotation_from;
    const vec4 chord_from = motion.rotation_from + from * turn;
    const float length_from = length(chord_from);
    const float length_to = length(motion.rotation_from + to * turn);
    // Of unit quaternions, |q + s turn|^2 = 1 - s (1 - s) |turn|^2.
    const float shortened = part * (1 - from - to) * dot(turn, turn) / (length_from + length_to); // length_from - length_to
    PoseChange change;
    change.rotation = (part * turn + shortened / length_from * chord_from) / length_to;
    change.position = part * (motion.offset_to - motion.offset_from);
    return change;
}

// m, world: the displacement of a point of the collider's space as the pose changes.
vec3 displacement(Pose pose, PoseChange change, vec3 point)
{
    const vec4 d = change.rotation;
    const vec4 turned = pose.rotation + d;
    return change.position + 2 * (cross(d.xyz, cross(turned.xyz, point) + turned.w * point) +
                               cross(pose.rotation.xyz, cross(d.xyz, point) + d.w * point));
}

// m: a position relative to the collider's origin at the start of the step. Float is precise enough there.
vec3 from_origin(uint c, uint flags, FinePosition p)
{
    precise const vec3 offset = p.x - (is_moved(flags) ? collider_motions[c].origin : colliders[c].origin) + p.residual;
    return offset;
}

// Between positions relative to ColliderMotion::origin and the collider's space.
vec3 to_collider(Pose pose, vec3 p) { return rotate_back(pose.rotation, p - pose.position); }
vec3 to_world(Pose pose, vec3 p) { return rotate(pose.rotation, p) + pose.position; }

// A position in the collider's space.
vec3 into_collider(uint c, uint flags, FinePosition p, float progress)
{
    const vec3 offset = from_origin(c, flags, p);
    return is_moved(flags) ? to_collider(pose_at(c, progress), offset) : offset;
}

#endif
