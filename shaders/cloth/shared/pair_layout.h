// Pairs of near primitives of cloths, as the GPU reads and writes them: a vertex and a triangle, or two edges.
#ifndef VOILE_PAIR_LAYOUT_H
#define VOILE_PAIR_LAYOUT_H

#include "../../shared_types.h"

// The capacity of a vertex's list of pairs.
#define VOILE_PAIRS 32
// The most threads of a search, how many of them share a candidate, and the most pairs that each finds.
#define VOILE_PAIR_LANES 16
#define VOILE_PAIR_WEDGE_LANES 4
#define VOILE_PAIR_FOUND 8

// The sizes of the dispatches that make the lists: one thread per place in the order of vertices, one per vertex of a
// patch, folds of levels, one per vertex of a slot of a leaf, push.candidate_lanes per place, one workgroup for all
// cloths, push.lanes per place.
#define VOILE_PAIR_SEARCHES 16
#define VOILE_PAIR_OF_PLACES 0
#define VOILE_PAIR_OF_PATCHES 1
#define VOILE_PAIR_FOLDS 2
#define VOILE_PAIR_OF_LEAVES 7
#define VOILE_PAIR_OF_CANDIDATES 8
#define VOILE_PAIR_OF_CLOTHS 9
#define VOILE_PAIR_OF_LANES 10
// The dispatch whose `entries` count the events in a step in which vertices without mass took more room than a pair
// had.
#define VOILE_PAIR_FORCED 0
// The dispatch whose `entries` count the pairs of an edge and a triangle that intersect at the step's start.
#define VOILE_PAIR_TANGLED 1
// The dispatch whose `entries` say how urgent new lists are, and the one with the urgency at which they are made
// (patience.glsl).
#define VOILE_PAIR_URGENCY 2
#define VOILE_PAIR_MOST_URGENCY 3
// The dispatch whose `entries` count the searches of a step.
#define VOILE_PAIR_SEARCHED 4
// The pass, + 1, that made the last lists that left little room to a pin, or to a vertex that is pushed. For some
// passes, sweeps are halved where they leave little room. It is kept from step to step.
#define VOILE_PAIR_CROWDED 11
#define VOILE_PAIR_CROWDED_PASSES 64
#define VOILE_PAIR_CROWDED_LIST 2
// The number of steps in a row that found no tangles and forced no pairs. It is kept from step to step. Then a step
// searches for tangles from one of so many parts of the triangles.
#define VOILE_PAIR_UNTANGLED 12
#define VOILE_TANGLE_PARTS 8
// Directions out of tangles are summed up in this unit.
#define VOILE_TANGLE_UNIT (1.0f / 4096)
// How often the sweep of a vertex is halved (PairMemory): the bits of the number; by how much it rises where a sweep
// left no room; for how many passes it is known.
#define VOILE_PAIR_HALVING_BITS 3
#define VOILE_PAIR_HALVINGS 2
#define VOILE_PAIR_HALVED_PASSES 1024
// The most candidates of a vertex, in as many lists as a leaf has vertices. They take the memory of the references to
// pairs. Those with this bit are not near.
#define VOILE_PAIR_CANDIDATES (4 * VOILE_PAIRS)
#define VOILE_PAIR_CANDIDATE_LIST (VOILE_PAIR_CANDIDATES / VOILE_PAIR_LEAF)
#define VOILE_PAIR_FAR_BIT (1u << 31)
// During a search the mask of a list has the lengths of the lists of candidates, so many bits for each, and whether any
// candidate is near.
#define VOILE_PAIR_LENGTH_BITS 7
#define VOILE_PAIR_LENGTH_MASK 0x7fu
#define VOILE_PAIR_NEAR_BIT (1u << 31)
// The dispatches of a pass: over the listed pairs, over the vertices in any. After the first one of a step a pass has
// as many workgroups as the lists of the pass before needed; they take entries in turn.
#define VOILE_PAIR_MEET 0
#define VOILE_PAIR_RESPOND 1
// No dispatch: counts the references to pairs.
#define VOILE_PAIR_REFERENCES 2
// Of a search, over the vertices that have near candidates, and over the candidates that are sifted.
#define VOILE_PAIR_FIND 3
#define VOILE_PAIR_SIFT 4
#define VOILE_PAIR_PASSES 5
// For so many passes nothing of an island is carried after the clock has carried vertices too near each other.
#define VOILE_PAIR_STOPPED_PASSES 16
// Momenta are summed up in this unit, m/s of the heaviest vertex, as a part of the mean, and masses in this one of it.
#define VOILE_PAIR_UNIT_SPEED 1e-6f
#define VOILE_PAIR_UNIT_MASS 1e-9f
// Sums over the vertices of a cloth, or of an island (FrameSums). r: m, from the origin of the cloth, or of the island.
// A restraint is a direction n, unit, in which an anchor or a collider restrains a vertex, and how fast it moves there,
// d. With m = r x n, the weighted sums are, in this order, of n n^T, n m^T (columns), m m^T, d n, d m and d^2; then,
// over all vertices of velocity v, of v, r, r x v and r r^T. Symmetric matrices: the diagonal, and yz, zx, xy.
#define VOILE_FRAME_SUMS 43
#define VOILE_FRAME_DIRECTIONS 0
#define VOILE_FRAME_MIXED 6
#define VOILE_FRAME_TURNS 15
#define VOILE_FRAME_DRIVES 21
#define VOILE_FRAME_MOMENTS 24
#define VOILE_FRAME_SQUARES 27
#define VOILE_FRAME_RESTRAINTS 28 // so many of them are of restraints
#define VOILE_FRAME_VELOCITIES 28
#define VOILE_FRAME_POSITIONS 31
#define VOILE_FRAME_SPINS 34
#define VOILE_FRAME_SPREADS 37
// Workgroups add whole numbers of these units: of sums of n n^T, of those with m, of those with d, of d^2, of all
// others.
#define VOILE_FRAME_UNIT_DIRECTION 1e-4f
#define VOILE_FRAME_UNIT_LEVER 1e-5f
#define VOILE_FRAME_UNIT_DRIVE 1e-3f
#define VOILE_FRAME_UNIT_SQUARE 1e-2f
#define VOILE_FRAME_UNIT_MOTION 1e-5f
// s: lists last so long at least, and sweeps at most.
#define VOILE_PAIR_SWEEP_TIME 3e-3f
// Lists last for so many passes at least, and a little longer, because times are rounded.
#define VOILE_PAIR_LISTED_PASSES 4.04f
// The largest fall, of the square of the time that lists last. Half if the clock runs as fast as time.
#define VOILE_PAIR_MOST_FALL 0.75f
// The part of a distance by which each side may approach the other. Less than half: both sides do.
#define VOILE_PAIR_APPROACH 0.45f
// Cloth is flat around a vertex if its primitives are farther apart than this part of the range of lists.
#define VOILE_FLAT_RANGE 0.85f
// So many vertices have a leaf of the hierarchy of pairs.
#define VOILE_PAIR_LEAF 4
// Weights in sums of loads are integers, so that their order does not matter.
#define VOILE_PAIR_UNIT_LOAD 65536.0f

VOILE_SHARED_BEGIN(voile)

// The size of an indirect dispatch. Vertices that ask for new lists write `wanted`.
struct PairDispatch
{
    uint groups;
    uint wanted; // 1 or 0, along y
    uint one;
    uint entries; // that the groups work on
};

// The list of the pairs of a vertex's primitives.
struct PairList
{
    float range; // m, up to which it has all pairs
    uint count;
    uint cloth;
    uint mask; // the places of pairs that both sides list, if there are any
};

// From which the frame of an island follows (moving_frame.glsl). The numbers are high * 2^16 + low.
struct FrameSums
{
    uint restrained; // vertices
    uint low[VOILE_FRAME_SUMS];
    int high[VOILE_FRAME_SUMS];
};

// What a cloth shares with others. Cloths that may come near each other until the lists are made again are an island,
// named by its first cloth. It has a clock that runs at most as fast as time, and more slowly where vertices that it
// carries would meet (PairSweep). All of that is relative to a frame that moves with the anchors and colliders that
// drive the island until the lists are made again.
struct PairIsland
{
    uint before;  // the first cloth of the island is so many before this one
    uint arrived; // workgroups of pair_clear.comp, if there is one cloth
    uint joined;  // while islands are found: another one that it becomes a part of is so many before it
    // Since the last lists, of the cloth; when islands are known, in the record of the first cloth, of the island.
    uint vertices;
    uint clear;      // of colliders
    uint mass;       // of those, in VOILE_PAIR_UNIT_MASS
    int momentum[3]; // in VOILE_PAIR_UNIT_SPEED
    int moment[3];   // mass times r, in that unit, m instead of m/s
    FrameSums frame_sums;
    // The box around the vertices of the cloth. Ordered numbers (ordered.glsl), the lower corner's inverted; 0: no
    // cloth.
    uint low[3];
    uint high[3];
    // While islands are found: the box until the lists are made again, m; and in the record of the first cloth, sums
    // over the island.
    float reach_low[3];
    float reach_high[3];
    uint heaviest; // kg, the bits of a float: the vertex to which the totals are relative
    int total_momentum[3];
    int total_moment[3];
    uint total_mass;
    FrameSums total_frame_sums;
    uint total_vertices;
    uint total_clear;
    uint total_stopped;
    // Of the first cloth. The pass, + 1, in which the clock carried vertices too near each other; 0: there was none in
    // this step. The rates for which pairs have room, floats, for even and for odd passes.
    uint stopped;
    uint rates[2];
    // For even and for odd passes: the clock at the beginning, s, and what gravity adds to the way of what falls
    // freely: the square of the clock, about half, s^2.
    float clocks[2];
    float falls[2];
    // The same of the last pass, until the next one.
    float rate;
    float clock;
    float fall;
    float fall_rate;      // s, what `fall` gains per second
    float rounded_off[3]; // m/s, what packing the mean velocity has rounded off
    // The frame: its velocity at its origin, m/s, its angular velocity, rad/s, and the origin when lists were made, m.
    float frame[3];
    float frame_turn[3];
    float frame_origin[3];
    // s, since lists were made: at the beginning of even and odd passes; at that of the last one, until the next.
    float times[2];
    float time;
};

// Where a vertex may be until the lists are made again, in the frame of its island. The clock carries `from`, in
// StepInput::list_time by twice what `carry` says (sweep.glsl). The vertex may be within `reach` of the segment from
// there to `sweep` beyond. Then no two primitives that no list contains can meet.
struct PairSweep
{
    vec3 from;      // m
    float reach;    // m
    vec3 sweep;     // m
    uint listed;    // 1: the vertex is in a listed pair; VOILE_PAIR_CROWDED_LIST: and a list with a pair
                    // around it is almost full
    uvec2 residual; // of `from` (fine_position.glsl)
    uint carry;
    float fall; // 0: gravity does not accelerate what carries `from`; else the part of a substep after which the
                // velocity of the vertex is that of the integrator
};

// Where a vertex may be until the next pass over the pairs. Let d be its displacement from `from`, less that by which
// the clock and the frame of its island have carried it since. dot(plane.xyz, d) + plane.w >= 0 for each plane, and
// length(d) <= reach. Then no two primitives of a list can meet.
struct PairGuard
{
    vec4 planes[2];
    vec3 from;      // m
    float reach;    // m
    uvec2 residual; // of `from`
    uint support;   // the direction (direction.glsl) in which a collider drives it, while it has VOILE_VERTEX_SUPPORTED
    uint massless;  // 1: a pair has a vertex without mass
};

// What bounds the motion of a vertex that collides with other cloth.
struct PairBound
{
    PairSweep sweep;
    PairGuard guard; // void unless sweep.listed
    vec3 impulse;    // m/s, the change of velocity by the last pass
    float speed;     // m/s, after it, relative to what carries the vertex
};

// What a vertex keeps from pass to pass.
struct PairMemory
{
    vec3 velocity; // m/s, after the last pass
    uint pass; // its number, and how often the sweep is halved (memory.glsl). If it is not the last one, velocity and
               // slip are void.
    vec3 slip; // m, how far the pairs that stick have drifted
    uint friction; // static and kinetic coefficients of the cloth, as halfs
};

// What the cloth around a vertex intersects at the step's start.
struct Tangle
{
    int direction[3]; // that shortens the lines of intersection, summed over the pairs, in VOILE_TANGLE_UNIT
    uint pairs;       // of an edge of a triangle and another triangle; 0: the vertex collides as usual
};

// What a listed pair does in a pass, as the owner of one side sees it. Both sides compute the same bits.
struct PairResponse
{
    vec3 impulse;    // m/s, towards the first side, for a pair of inverse mass 1/kg; 0: the pair is not pushed
    uint normal;     // towards the first side (packSnorm2x16 of its octahedral map)
    vec4 mobilities; // 1/kg, weight times inverse mass of each vertex
    uvec2 heights;   // m, as halfs: how far the vertices of the own side may approach the other side; how far along
                     // the normal the clock carries the planes of both sides until the next pass, if it runs as fast
                     // as time
    uvec2 drift; // m, as halfs: how far a pair that sticks, or just misses, has slid since the last pass; and 1 if a
                 // vertex of it has no mass
};

struct PairPush
{
    float substeps; // of level 0, from this pass to the next
    uint first_patch;
    uint places;          // in the order of vertices
    uint leaves;          // of the hierarchy
    uint pass;            // of the step
    uint vertices;        // of the solver, the capacity of its buffers
    uint threads;         // per vertex in respond_to_pairs.comp
    uint lanes;           // per vertex in find_pairs.comp
    uint candidate_lanes; // per vertex in find_candidates.comp: 1, 2 or 4
    uint capacity;        // of a list, at most VOILE_PAIRS
    uint colliders;
    uint sifted; // the most candidates of a vertex that are sifted, at most VOILE_PAIRS
    uint cloths;
    uint least_groups; // of the dispatches of the next pass
    float lag;         // substeps: gravity has not yet acted for so long on velocities of Verlet, half a substep behind
};

#ifdef __cplusplus
static_assert(sizeof(PairSweep) == 48);
static_assert(sizeof(PairGuard) == 64);
static_assert(2 * sizeof(PairBound) == VOILE_PAIR_SEARCHES * sizeof(PairDispatch));
static_assert(sizeof(PairMemory) == 32);
static_assert(sizeof(Tangle) == 16);
static_assert(sizeof(PairResponse) == 48);
#endif

VOILE_SHARED_END

#endif
