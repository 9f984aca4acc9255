// Contact and depenetration, as the GPU reads and writes them.
#ifndef VOILE_CONTACT_LAYOUT_H
#define VOILE_CONTACT_LAYOUT_H

#include "../../shared_types.h"

// m/s: the speed at which a vertex under a surface, or nearer to it than the thickness, is lifted. Vertices that it
// pulls along may swing at twice that speed.
#define VOILE_DEPENETRATION_SPEED 0.75f
// m/s: a vertex inside a solid follows it up to this speed, and less the faster it moves beyond that.
#define VOILE_FOLLOWED_SPEED 10.0f
// The buffer of depenetrations begins with the sizes of two indirect dispatches of depenetration. Each step writes one
// of them. A size has this many words.
#define VOILE_DISPATCH_WORDS 4

// The capacity of a vertex's list of candidates: triangles of colliders, kept from substep to substep
// (contact_candidates.glsl).
#define VOILE_CANDIDATES 23
// The number of words of a list.
#define VOILE_CANDIDATE_WORDS (VOILE_CANDIDATES + 3)
// The number of bits of a triangle's index in its word.
#define VOILE_CANDIDATE_TRIANGLE_BITS 26
// Where contact writes its result: the whole state into the earlier one; only what it changes, into the proposed one;
// the same, and the positions into the earlier ones, from which the next pass starts.
#define VOILE_CONTACT_INTO_EARLIER 0
#define VOILE_CONTACT_IN_PLACE 1
#define VOILE_CONTACT_KEEPS_START 2
#define VOILE_PLANE_OF_EXIT 0xffffffffu
// One word of a list contains its length, and above it the number of the substep in which the list was made.
#define VOILE_CANDIDATE_COUNT_BITS 5
#define VOILE_CANDIDATE_COUNT_MASK 31u

// The votes of a cloth's vertices that are inside of colliders: ballots, that of collider c at c % VOILE_BALLOTS, and
// after them one word: 1 if vertices are inside that may have begun there. Of a ballot, word 0: the sum of the votes
// for sides. Words 1-3: the sum of the exit directions in the world.
#define VOILE_BALLOTS 32
#define VOILE_BALLOT_WORDS 7
#define VOILE_BALLOT_COUNT 4    // the word of the number of directions
#define VOILE_BALLOT_COLLIDER 5 // the largest index, plus 1, of colliders that vertices are inside of; 0: none
#define VOILE_BALLOT_TOGETHER 6 // bits of the ballots that are counted as one with it
#define VOILE_VOTE_BEGAN (VOILE_BALLOTS * VOILE_BALLOT_WORDS)
#define VOILE_VOTE_WORDS (VOILE_VOTE_BEGAN + 1)

VOILE_SHARED_BEGIN(voile)

// The exit of a vertex that was inside a collider at the start of the step.
struct Depenetration
{
    vec3 velocity; // m/s, world, relative to the collider
    uint solid;    // the index of the collider + 1; 0: the vertex is inside no collider
};

// The surface that a vertex touched in the last contact pass. Until the next one Verlet keeps the vertex above it. A
// vertex inside a solid leaves it meanwhile.
struct ContactPlane
{
    vec3 normal;   // unit, world, away from the surface; 0: none. Of an exit: m/s, the exit velocity
    float slack;   // m, of the vertex above the plane
    vec3 velocity; // m/s, of the surface
    uint friction; // two halves: the static and the kinetic coefficient; or VOILE_PLANE_OF_EXIT
};

// Push constants of the contact pass. Times are in substeps of level 0.
struct ContactPush
{
    float substeps; // since the last contact pass
    uint colliders;
    uint refresh;           // 1: lists of candidates are refreshed in this pass
    float refresh_substeps; // from one refresh to the next
    float progress_from;    // 0..1, of the step, at the last contact pass
    float progress_to;      // 0..1, of the step, at the substep's end
    float progress_per_substep;
    uint substep;          // of the step
    uint vertices;         // of all cloths
    uint features;         // 1: colliders have features that may have touched cloth
    uint depenetrates;     // 1: there are solids that vertices can be inside of
    uint near_stride;      // words per patch of near colliders; 0: there are no lists
    uint dispatch_word;    // of the depenetration's dispatch size; 0 there: no vertex is inside a solid
    uint result;           // VOILE_CONTACT_...
    float mesh_extent;     // m, the largest extent of a mesh from its origin along an axis
    uint first_patch;      // of the dispatch
    float pair_ahead;      // from one pass over pairs to the next, of the time since the last contact pass
    float pair_from;       // from the last pass over pairs to the start of the motion
    float pair_lasts;      // of the motion
    uint limited_only;     // 1: after the strain limit, of which cloths without one take no part
    uint kicks;            // substeps since the last contact pass
    uint listed;           // the substep of the step in which lists were refreshed last
    float progress_next;   // 0..1, of the step, when they are refreshed next
    float progress_before; // 0..1, of the step, since when surfaces have had their velocity
};

// Push constants of the pass that finds exits from solids.
struct DepenetrationPush
{
    float step; // s, of the whole step
    uint colliders;
    uint near_stride;
    uint dispatch_word; // of the dispatch size that is written
};

#ifdef __cplusplus
static_assert(sizeof(Depenetration) == 16 && sizeof(Depenetration) == VOILE_DISPATCH_WORDS * sizeof(uint));
static_assert(sizeof(ContactPlane) == 32);
static_assert(sizeof(ContactPush) == 96);
#endif

VOILE_SHARED_END

#endif
