// Rotations by small angles, without sines: a turn is the vector part of a quaternion whose scalar part is 1.
#ifndef VOILE_TURN_GLSL
#define VOILE_TURN_GLSL

// `angle`: rad, along the axis. Rotates by 2 atan(angle / 2): less, by a twelfth of its third power.
vec3 turn_of(vec3 angle) { return 0.5 * angle; }

// What a turn adds to a vector. The opposite of a turn is its inverse.
vec3 added_by(vec3 turn, vec3 v)
{
    const vec3 across = cross(turn, v);
    return 2 / (1 + dot(turn, turn)) * (across + cross(turn, across));
}

vec3 turned(vec3 turn, vec3 v) { return v + added_by(turn, v); }

#endif
