// What integration proposes for a vertex, as contact reads it, and what contact makes of it.
//
// The including kernel declares the buffers of both states, corrections[], depenetrations[] and push (ContactPush).
#ifndef VOILE_PROPOSALS_GLSL
#define VOILE_PROPOSALS_GLSL

// The motion that integration proposes, with the correction of features if this substep has one. `flags`:
// VOILE_VERTEX_...
Motion proposed_motion(uint i, uint cloth, vec3 proposed, out uint flags)
{
    const vec4 velocity = proposed_velocities[i];
    Motion motion;
    motion.from = FinePosition(positions[i].xyz, unpack_residual(residuals[i]));
    motion.displacement = displacement(motion.from, FinePosition(proposed, unpack_residual(proposed_residuals[i])));
    motion.v = velocity.xyz;
    motion.cloth = cloth;
    flags = uint(velocity.w);
    if (push.features != 0 && patches[patch_of_group()].near_features != 0 &&
        corrections[i].substep == counted_substep(push.substep))
    {
        motion.displacement += corrections[i].shift;
        if (push.limited_only == 0) // else no time passes, and features would take moving surfaces for ones at rest
            motion.v += corrections[i].change;
        flags |= VOILE_VERTEX_TOUCHES_FEATURE;
    }
    return motion;
}

// Loaded only in steps in which any vertex is inside a collider.
Depenetration depenetration_of(uint i)
{
    if (push.depenetrates == 0 || dispatch_sizes[push.dispatch_word] == 0)
        return Depenetration(vec3(0), 0);
    return depenetrations[i];
}

// `flags`: VOILE_VERTEX_...
void write_motion(uint i, Motion motion, uint flags)
{
    const FinePosition to = moved(motion.from, motion.displacement);
    const vec4 position = vec4(to.x, proposed_positions[i].w);
    const vec4 velocity = vec4(motion.v, flags);
    const vec4 change = vec4(motion.v - proposed_velocities[i].xyz, 0);
    const bool verlet = is_verlet(cloths[motion.cloth].flags);
    if (push.result != VOILE_CONTACT_IN_PLACE)
    {
        positions[i] = position;
        residuals[i] = pack_residual(to);
    }
    if (push.result == VOILE_CONTACT_INTO_EARLIER)
    {
        velocities[i] = velocity;
        if (verlet)
            predicted[i] = proposed_predicted[i] + change;
        return;
    }
    proposed_positions[i] = position;
    proposed_residuals[i] = pack_residual(to);
    proposed_velocities[i] = velocity;
    if (verlet)
        proposed_predicted[i] += change;
}

// For a vertex without contact. Both states then have the same bits.
void copy_proposed(uint i, uint cloth, vec4 proposed)
{
    if (push.result == VOILE_CONTACT_IN_PLACE)
        return;
    positions[i] = proposed;
    residuals[i] = proposed_residuals[i];
    if (push.result != VOILE_CONTACT_INTO_EARLIER)
        return;
    velocities[i] = proposed_velocities[i];
    if (is_verlet(cloths[cloth].flags))
        predicted[i] = proposed_predicted[i];
}

#endif
