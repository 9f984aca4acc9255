// Stops vertices at the guards of their pairs (hold.glsl), and asks for new lists.
//
// The including kernel declares pair_searches[], velocities[] (before the substep) and what hold.glsl expects.
#ifndef VOILE_STOP_GLSL
#define VOILE_STOP_GLSL

#include "pairs/forced.glsl"
#include "pairs/hold.glsl"
#include "pairs/patience.glsl"

// m/s: what a vertex keeps of its velocity where guards leave `cut` of it: as fast as after the last pass. The next one hands
// that on to the other side, so that it has the momentum. What springs have added meanwhile is lost: vertices that are
// pressed together would become ever faster. All is lost without room, beside vertices without mass, which take nothing, and
// while colliders or anchors move (drive.glsl). What is in no pair only waits for lists, and stays as fast as before the
// substep: else light cloth would have the velocity of its island before heavy cloth hits it.
vec3 kept_velocity(uint i, Hold hold, vec3 v, vec3 cut)
{
    const PairGuard guard = hold.bound.guard;
    const float room = min(guard.reach, min(guard.planes[0].w, guard.planes[1].w));
    const bool listed = hold.bound.sweep.listed != 0;
    if (step_input.driven != 0 || (listed && (room <= 0 || guard.massless != 0)))
        return cut;
    const vec3 relative = v - hold.carry;
    const float before = listed ? pair_bounds[i].speed : length(velocities[i].xyz - hold.carry);
    const float most = max(before, length(cut - hold.carry));
    return hold.carry + min(1, most / max(length(relative), 1e-30)) * relative;
}

// Whether the motion changes.
bool slide_along_planes(uint i, Hold hold, inout Motion motion)
{
    const vec3 along = along_planes(hold, motion.displacement);
    if (along == motion.displacement)
        return false;
    if (push.substeps > 0)
        motion.v = kept_velocity(i, hold, motion.v, motion.v + (along - motion.displacement) / seconds(push.substeps));
    motion.displacement = along;
    return true;
}

// Whether a vertex may be held where its sweep ends. What colliders and anchors drive would get through other cloth, what
// is fast would fall behind its neighbors, what is in no pair would lose its velocity, and so would what the clock carries
// once it ends.
bool can_wait(Hold hold, Motion motion)
{
    const PairSweep sweep = hold.bound.sweep;
    const float ahead = k_patience * push.pair_ahead * seconds(push.substeps) * length(motion.v - hold.carry);
    return step_input.driven == 0 && sweep.listed != 0 && sweep.reach > 0 && hold.left == vec3(0) &&
           ahead <= cloths[motion.cloth].pair_range;
}

// Many vertices ask at the same time. Most find that it is known, because writes to one word queue. `waits`: if it can.
void ask_for_lists(Hold hold, Motion motion, bool waits)
{
    if (!wants_lists(hold, motion.displacement) || are_lists_wanted())
        return;
    if (waits && can_wait(hold, motion))
        wait_for_lists();
    else
        want_lists();
}

// Cuts the motion where the guards of pairs end. Whether it does.
bool hold_within_guards(uint i, Hold hold, inout Motion motion)
{
    const float part = held_part(hold, motion.displacement - hold.carried);
    if (part < 1)
    {
        motion.v = kept_velocity(i, hold, motion.v, mix(hold.carry, motion.v, part));
        motion.displacement = mix(hold.carried, motion.displacement, part);
    }
    ask_for_lists(hold, motion, true);
    return part < 1;
}

// Nothing holds a vertex without mass.
void watch_driven(uint i, uint cloth, Motion motion)
{
    const Hold hold = hold_of(i, cloth, motion.from);
    ask_for_lists(hold, motion, false);
    if (!is_in_sweep(hold, motion.displacement))
        count_forced();
}

#endif
