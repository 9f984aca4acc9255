// Where a moving collider is at a time of the step. Its own space is the world as it was when the collider was added, so that
// neither shape nor hierarchy changes when it moves: queries go there and answers come back.
//
// The including kernel declares collider_motions[] and a constant COLLIDERS_MOVE: 0 where none moves, and what serves moving
// ones is left out.
#ifndef VOILE_COLLIDER_POSE_GLSL
#define VOILE_COLLIDER_POSE_GLSL

bool is_moved(uint flags) { return COLLIDERS_MOVE != 0 && (flags & VOILE_COLLIDER_MOVED) != 0; }
bool is_deforming(uint flags) { return COLLIDERS_MOVE != 0 && (flags & VOILE_COLLIDER_DEFORMS) != 0; }

struct Pose
{
    vec4 rotation; // unit quaternion, world from the collider's space
    vec3 center;   // m, in the collider's space
    vec3 place;    // m, of the centre in the world
};

vec3 rotate(vec4 q, vec3 v) { return v + 2 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
vec3 rotate_back(vec4 q, vec3 v) { return rotate(vec4(-q.xyz, q.w), v); }

// `progress` of the step, 0 to 1. The centre goes straight; the turning is that of the chord between both quaternions.
Pose pose_at(uint collider, float progress)
{
    const ColliderMotion motion = collider_motions[collider];
    Pose pose;
    pose.rotation = normalize(mix(motion.rotation_from, motion.rotation_to, progress));
    pose.center = motion.center;
    pose.place = mix(motion.place_from, motion.place_to, progress);
    return pose;
}

vec3 to_collider(Pose pose, vec3 p) { return rotate_back(pose.rotation, p - pose.place) + pose.center; }
vec3 to_world(Pose pose, vec3 p) { return rotate(pose.rotation, p - pose.center) + pose.place; }

#endif
