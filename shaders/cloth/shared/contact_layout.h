// Contact and depenetration, as the GPU reads and writes them.
#ifndef VOILE_CONTACT_LAYOUT_H
#define VOILE_CONTACT_LAYOUT_H

#include "../../shared_types.h"

// m/s: how fast what is under a surface, or nearer to it than the thickness, comes up. What it pulls along may swing at
// twice that speed.
#define VOILE_DEPENETRATION_SPEED 0.75f
// The buffer of depenetrations begins with the sizes of two dispatches of depenetration, one of which the step writes,
// of so many words each.
#define VOILE_DISPATCH_WORDS 4

// How many triangles of colliders a vertex can keep from substep to substep (contact_candidates.glsl),
#define VOILE_CANDIDATES 23
// the words of its list,
#define VOILE_CANDIDATE_WORDS (VOILE_CANDIDATES + 3)
// how many bits of a word tell the triangle,
#define VOILE_CANDIDATE_TRIANGLE_BITS 26
// and how many substeps lie between the renewals of these lists.
#define VOILE_REFRESH_PERIOD 16
// The number of the substep in which a list of candidates was made, and their count: one word.
#define VOILE_CANDIDATE_COUNT_BITS 5
#define VOILE_CANDIDATE_COUNT_MASK 31u

// Votes of a cloth's vertices inside of colliders: of sides, the sum of directions in the world, how many these are,
// and the colliders, each a bit, the 33rd that of the first.
#define VOILE_VOTE_WORDS 6
#define VOILE_VOTE_COUNT 4     // the word of their number
#define VOILE_VOTE_COLLIDERS 5 // the word of the bits

VOILE_SHARED_BEGIN(voile)

// How a vertex comes out of a collider that it was inside of at the start of the step.
struct Depenetration
{
    vec3 velocity; // m/s, world, relative to the collider
    uint solid;    // the collider + 1; 0: it is inside of none
};

// Push constants of the contact pass.
struct ContactPush
{
    float step; // s
    uint colliders;
    uint refresh;          // 1: lists of candidates are renewed in this substep
    float refresh_time;  // s, from one renewal to the next
    float progress_from; // 0..1, of the step at the substep's start
    float progress_to;   // and at its end
    float progress_per_substep;
    uint substep;       // counted through all steps
    uint first_substep; // of the step
    uint vertices;      // of all cloths
    uint features;      // 1: colliders have corners or edges that may have met vertices
    uint depenetrates;      // 1: colliders have an inside, from which vertices are brought out
    uint near_stride;   // words per patch of near colliders; 0: there are no lists
    uint dispatch_word;      // the word of the dispatch's size that tells whether any vertex is inside
    uint in_place;      // 1: what contact changes it writes into the proposed state; 0: all goes into the earlier one
    float mesh_extent;  // m, that a mesh has at most along an axis from its origin
};

// Push constants of the pass that finds the way out of colliders.
struct DepenetrationPush
{
    float step; // s, of the whole step
    uint colliders;
    uint near_stride;
    uint dispatch_word; // the word of the size that is written
};

#ifdef __cplusplus
static_assert(sizeof(Depenetration) == 16 && sizeof(Depenetration) == VOILE_DISPATCH_WORDS * sizeof(uint));
static_assert(sizeof(ContactPush) == 64);
#endif

VOILE_SHARED_END

#endif
