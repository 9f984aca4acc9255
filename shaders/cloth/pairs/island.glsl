// Islands (PairIsland): cloths that may come near each other, and the frames in which they move.
//
// The including kernel declares pair_islands[].
#ifndef VOILE_ISLAND_GLSL
#define VOILE_ISLAND_GLSL

#include "pairs/rigid_motion.glsl"
#include "shared/fine_position.glsl"
#include "shared/turn.glsl"

// The frame of an island, while lists are made and used.
struct MovingFrame
{
    RigidMotion motion;
    vec3 origin; // m, when lists were made
};

// The island of a cloth: its first cloth.
uint island_of(uint cloth) { return cloth - pair_islands[cloth].before; }

// Of its island.
MovingFrame frame_of(uint cloth)
{
    MovingFrame frame;
    for (uint k = 0; k < 3; ++k)
    {
        frame.motion.velocity[k] = pair_islands[cloth].frame[k];
        frame.motion.angular_velocity[k] = pair_islands[cloth].frame_turn[k];
        frame.origin[k] = pair_islands[cloth].frame_origin[k];
    }
    return frame;
}

bool is_turning(MovingFrame frame) { return frame.motion.angular_velocity != vec3(0); }

bool is_moving(MovingFrame frame) { return frame.motion.velocity != vec3(0) || is_turning(frame); }

// m, from the origin, `time` s after lists were made.
vec3 from_origin(MovingFrame frame, FinePosition x, float time)
{
    return displacement(FinePosition(frame.origin, vec3(0)), x) - time * frame.motion.velocity;
}

// m/s: of the frame at `x`, `time` s after lists were made.
vec3 velocity_at(MovingFrame frame, vec3 x, float time)
{
    if (!is_turning(frame))
        return frame.motion.velocity;
    return velocity_at(frame.motion, from_origin(frame, FinePosition(x, vec3(0)), time));
}

// Its rotation in `time` s.
vec3 turn_in(MovingFrame frame, float time) { return turn_of(time * frame.motion.angular_velocity); }

#endif
