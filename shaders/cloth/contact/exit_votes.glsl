// The votes of a cloth's vertices for their exits from solids (VOILE_BALLOT_...). Solids whose boxes overlap are left
// together, as parts of one body: their ballots are counted as one. Others are left on their own. One vote for all of
// them drew a vertex through a sphere to the side on which the cloth left a capsule beside it.
//
// The including kernel declares last_votes[], next_votes[], push.colliders, and what swept_box.glsl needs.
#ifndef VOILE_EXIT_VOTES_GLSL
#define VOILE_EXIT_VOTES_GLSL

#include "colliders/swept_box.glsl"

// Votes are integers because their sum must not depend on the order.
const int k_vote = 1024;

uint ballot_word(uint cloth, uint ballot) { return VOILE_VOTE_WORDS * cloth + VOILE_BALLOT_WORDS * ballot; }
uint own_ballot(uint cloth, uint c) { return ballot_word(cloth, c % VOILE_BALLOTS); }

// Of a solid at the step's start, in the world, grown by `margin`.
Box solid_box(uint c, float margin)
{
    const ColliderRecord collider = colliders[c];
    const Box local = grown(local_box(collider), margin);
    if (!is_moved(collider.flags))
        return shifted(local, collider.origin);
    const Pose pose = pose_at(c, 0);
    const vec3 half_size = 0.5 * (local.max - local.min);
    const vec3 center = to_world(pose, 0.5 * (local.min + local.max)) + collider_motions[c].origin;
    vec3 reach = vec3(0);
    for (int axis = 0; axis < 3; ++axis)
    {
        vec3 along = vec3(0);
        along[axis] = half_size[axis];
        reach += abs(rotate(pose.rotation, along));
    }
    return Box(center - reach, center + reach);
}

struct Votes
{
    int side;       // k_vote times the sum of the votes for the side of the cloth's normals
    vec3 direction; // k_vote times the sum of the exit directions, world
    uint count;     // of directions
};

// Of the last step, for all solids that are left together with one. `margin`: m, by which boxes that touch overlap.
Votes votes_for(uint cloth, uint c, float margin)
{
    const Box own = solid_box(c, margin);
    Votes sum = Votes(0, vec3(0), 0);
    uint together = 0;
    for (uint ballot = 0; ballot < VOILE_BALLOTS; ++ballot)
    {
        const uint word = ballot_word(cloth, ballot);
        const uint other = last_votes[word + VOILE_BALLOT_COLLIDER];
        const bool exists = other > 0 && other <= push.colliders; // it may have been removed since
        if (!exists || !(ballot == c % VOILE_BALLOTS || overlap(own, solid_box(other - 1, margin))))
            continue;
        together |= 1u << ballot;
        sum.side += int(last_votes[word]);
        sum.direction += vec3(int(last_votes[word + 1]), int(last_votes[word + 2]), int(last_votes[word + 3]));
        sum.count += last_votes[word + VOILE_BALLOT_COUNT];
    }
    atomicOr(next_votes[own_ballot(cloth, c) + VOILE_BALLOT_TOGETHER], together);
    return sum;
}

void vote_for_side(uint cloth, uint c, float side)
{
    atomicAdd(next_votes[own_ballot(cloth, c)], uint(int(k_vote * side)));
}

// `direction`: unit, world.
void vote_for_direction(uint cloth, uint c, vec3 direction)
{
    const uint word = own_ballot(cloth, c);
    const ivec3 vote = ivec3(k_vote * direction);
    atomicAdd(next_votes[word + 1], uint(vote.x));
    atomicAdd(next_votes[word + 2], uint(vote.y));
    atomicAdd(next_votes[word + 3], uint(vote.z));
    atomicAdd(next_votes[word + VOILE_BALLOT_COUNT], 1);
}

// That a vertex of the cloth is inside of a solid.
void note_inside(uint cloth, uint c) { atomicMax(next_votes[own_ballot(cloth, c) + VOILE_BALLOT_COLLIDER], c + 1); }

#endif
