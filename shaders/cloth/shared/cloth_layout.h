// Cloths, colliders and push constants as the GPU reads them. One definition for GLSL and C++.
#ifndef VOILE_CLOTH_LAYOUT_H
#define VOILE_CLOTH_LAYOUT_H

#include "../../shared_types.h"

// The springs of a grid vertex come in eight classes; a class joins it to the vertices at +offset and -offset.
// Classes 0-1 structural (column, row), 2-3 shear, 4-5 bend, 6-7 diagonal bend.
// A mesh has five: 0 along its edges (a Material's), 1 between the vertices opposite to an edge, 2-4 the springs of a
// Fabric's membrane along warp, weft and both diagonals (membrane.glsl), in N/m and N s/m of strain and strain rate.
#define VOILE_SPRING_CLASSES 8
#define VOILE_CLASS_EDGE 0
#define VOILE_CLASS_OPPOSITE 1
#define VOILE_CLASS_WARP 2
#define VOILE_CLASS_WEFT 3
#define VOILE_CLASS_DIAGONAL 4
#define VOILE_MEMBRANE_SPRINGS 3

// Ranges of the input along each axis, either way, as in voile/ranges.hpp.
#define VOILE_MOST_COORDINATE 1e6 // m
#define VOILE_MOST_SPEED 1e4      // m/s
// Of the air against a vertex, along each axis, and of the cell that it acts on.
#define VOILE_MOST_AIR_SPEED 1e5 // m/s
#define VOILE_MOST_AIR_AREA 1e12 // m^2

// Flags of a cloth.
#define VOILE_CLOTH_VERLET 1u    // velocity Verlet; else RK4
#define VOILE_CLOTH_ISOMETRIC 2u // bends by the isometric model; its bend springs are slack
#define VOILE_CLOTH_ALIKE 4u     // a mesh whose springs all have the class's constants, whatever their weight
// Set in MeshSpring.neighbor: no edge joins the two; a spring between them crosses one.
#define VOILE_OPPOSITE_BIT 0x80000000u

#define VOILE_COLLIDER_PLANE 0
#define VOILE_COLLIDER_SPHERE 1
#define VOILE_COLLIDER_MESH 2
#define VOILE_COLLIDER_CAPSULE 3
#define VOILE_COLLIDER_BOX 4

// m/s: how fast what is under a surface, or nearer to it than the thickness, comes up. What it pulls along may swing at
// twice that speed.
#define VOILE_RECOVERY_SPEED 0.75f
// The buffer of depenetrations begins with the sizes of two dispatches of the recovery, one of which the step writes,
// of so many words each.
#define VOILE_DISPATCH_WORDS 4

// The colliders near a patch (collider_reach.comp), in words: the box in which the list holds, where its bits begin and
// end that are not 0, in words of them, and then the bits, one per collider.
#define VOILE_NEAR_MIN 0
#define VOILE_NEAR_FIRST 3
#define VOILE_NEAR_MAX 4
#define VOILE_NEAR_END 7
#define VOILE_NEAR_WORDS 8
// How many substeps lie between two looks at which colliders are near,
#define VOILE_NEAR_PERIOD 16
// and how many colliders there are at most without.
#define VOILE_NEAR_FEW 8

// How many triangles of colliders a vertex can keep from substep to substep (contact_candidates.glsl),
#define VOILE_CANDIDATES 23
// the words of its list,
#define VOILE_CANDIDATE_WORDS (VOILE_CANDIDATES + 3)
// how many bits of a word tell the triangle,
#define VOILE_CANDIDATE_TRIANGLE_BITS 26
// and how many substeps lie between the renewals of these lists.
#define VOILE_RENEWAL 16

// Flags of a collider.
#define VOILE_COLLIDER_CLOSED 1u    // a mesh without a border
#define VOILE_COLLIDER_FRICTION 2u  // it has friction coefficients of its own
#define VOILE_COLLIDER_ONE_SIDED 4u // a mesh pushes to the side its triangles face; else to where a vertex came from
#define VOILE_COLLIDER_MOVED 8u     // it is, or was, somewhere else than where it was added: see its ColliderMotion
#define VOILE_COLLIDER_DEFORMS 16u  // a mesh whose vertices move: its hierarchy is a padded tree (padded_layout.h)
// The number of the substep in which a list of candidates was made, and their count: one word.
#define VOILE_CANDIDATE_COUNT_BITS 5
#define VOILE_CANDIDATE_COUNT_MASK 31u

// Wave vectors of the gusts (wind.glsl), in units of the longest one's.
#define VOILE_GUST_WAVES                                                                                               \
    vec3(0.8f, 0, 0.6f), vec3(-1.2091f, 0.9068f, 1.3099f), vec3(2.4368f, 2.4368f, -2.0307f),                           \
        vec3(1.5689f, -4.7068f, 6.2757f)

// What a velocity's w says of its vertex, as a sum of these.
#define VOILE_VERTEX_TOUCHES 1 // it touches a collider
#define VOILE_VERTEX_TAUT 2    // a tether, a maximum distance or a backstop limits it
#define VOILE_VERTEX_MEETS 4   // a triangle or an edge around it meets a corner or an edge of a collider

VOILE_SHARED_BEGIN(voile)

struct SpringClass
{
    float stiffness;   // N/m
    float damping;     // N s/m
    float rest_length; // m; of a mesh's edges: the mean spacing of its vertices, each spring has a length of its own
    float padding;
};

// One a cloth. Its vertices are consecutive, from first_vertex; those of a grid are row * columns + column.
struct ClothRecord
{
    uint first_vertex;
    uint vertices;
    uint columns; // of a grid; 0: a mesh
    uint rows;
    uint first_list;       // of a mesh: its first MeshVertex
    float thickness;       // m
    float static_friction; // Coulomb coefficients of the fabric
    float kinetic_friction;
    float linear_drag;     // N s/m a vertex: force = linear_drag * (wind - velocity)
    float drag_normal;     // C_n of the quadratic law
    float drag_tangential; // C_t
    float border_share;    // of masses and of springs along a grid's border
    uint flags;
    float omega_squared;     // 1/s^2, of the fastest mode in any shape, bending included
    float decay;             // 1/s, of the fastest decay in any shape
    float strain_limit;      // largest l / L - 1; 0: none
    float inverse_density;   // 1 / areal density or vertex mass: times a vertex's own measure it gives the inverse mass
    float strain_relaxation; // of a correction of the strain limit
    uint layers;             // bits; it meets colliders that have one of them
    float flat_omega_squared; // 1/s^2, of the fastest mode of the flat cloth
    vec3 bending;       // isometric. Grid: N/m a second difference along a row, along a column, a twist. Mesh: x, N m
    float bending_time; // s; the bending force sees x + bending_time * v
    SpringClass springs[VOILE_SPRING_CLASSES];
};

// A mesh vertex's lists: its springs and the triangles around it, entries first, first + stride, ... of MeshSpring[]
// and of MeshCorner[] and MembraneCorner[]. With stride 1 each vertex's list is in one piece; with the stride of a
// workgroup the first entries of its vertices stand side by side, then their second ones, so that a workgroup's reads
// coalesce.
struct MeshVertex
{
    uint first_spring;
    uint springs;
    uint first_corner;
    uint corners;
};

struct MeshSpring
{
    uint neighbor;     // counted within the cloth; VOILE_OPPOSITE_BIT
    float rest_length; // m
    float weight;      // times the class's stiffness and damping. Edge: 1; opposite: 1/m^2. 0: no spring
    float bending;     // of the isometric model, 1/m^2: force = -B * bending * (x_neighbor - x)
};

// A triangle around a vertex by its other two corners, counter-clockwise, counted within the cloth.
struct MeshCorner
{
    uint b;
    uint c;
};

// The same triangle at rest, entry for entry; alike for all of its corners but for which one the vertex is.
struct MembraneCorner
{
    vec2 gradient_1; // 1/m, along warp and weft, of the barycentric coordinates of corner 1
    vec2 gradient_2; // and of corner 2
    float weight;    // m^2, the area; of a sliver less
    uint corner;     // the vertex: 0..2, counter-clockwise
};

// What one workgroup works on. Of a mesh: vertices first .. first + group size - 1. Of a grid: a tile of 2^tile_shift
// columns from column `first` on, and as many rows from `row` on as fill the group: what lies near on the cloth is
// worked on together. What it has of its cloth is here to save a dependent load.
struct Patch
{
    uint cloth;
    uint first_vertex; // of the cloth
    uint columns;      // of the cloth; of a mesh 0
    uint rows;         // of the cloth; of a mesh its vertices
    uint first;        // counted within the cloth
    uint row;
    uint tile_shift;
    uint near_features; // 1: it may meet corners and edges of colliders before the next look (feature_reach.comp)
};

// A frame that attachments follow, before and after the step.
struct AnchorRecord
{
    mat4 from; // world from anchor
    mat4 to;
    mat4 motion; // to * inverse(from)
};

// Flags of an attachment.
#define VOILE_ATTACHMENT_PLACED 1u // its position is given; else a pin goes on from where its vertex is
#define VOILE_ATTACHMENT_BACKSTOP 2u

// An attachment of a vertex. Pins come first, then the others.
struct AttachmentRecord
{
    vec3 place;  // m, in the anchor's space
    uint vertex; // in the solver's buffers
    vec3 normal; // of the backstop, in the anchor's space
    uint anchor;
    float stiffness;    // N/m
    float damping;      // N s/m
    float max_distance; // m; infinite: none
    float backstop;     // m behind the place
    uint flags;
    uint cloth;
    uint padding_0;
    uint padding_1;
};

#define VOILE_TETHERS 4

// The tethers of one vertex.
struct TetherRecord
{
    uint vertex; // in the solver's buffers, like the pins
    uint count;  // 1..VOILE_TETHERS
    uint cloth;
    uint padding;
    uint pins[VOILE_TETHERS];
    float lengths[VOILE_TETHERS]; // m
};

// A collider where it was added, in its own space: the world as it was then (of a box: the box's), seen from `origin`.
// So that what contact computes is as precise far from the world's origin as near to it.
struct ColliderRecord
{
    uint kind;
    uint flags;
    float static_friction;
    float kinetic_friction;
    vec3 box_min;    // m; everything of a mesh is inside. If it deforms: as it was added
    uint first_node; // or box, of a mesh that deforms
    vec3 box_max;
    uint first_triangle; // or leaf
    uint triangles;      // of a mesh, from first_triangle on
    uint layers;         // bits; it meets cloths that have one of them
    uint nodes;          // of a mesh that does not deform, from first_node on
    uint padding;
    vec4 shape;   // plane: unit normal, offset; sphere: w, radius; capsule: half of its axis, radius; box: half of its
                  // size
    vec3 origin;  // m, in the world of a collider that has not moved; of a ball, a capsule and a box the center
    float extent; // m, that a mesh has at most along an axis from there
};

// How a collider goes through the step. Its origin goes straight.
struct ColliderMotion
{
    vec4 rotation_from; // unit quaternions, world from the collider's space
    vec4 rotation_to;
    vec3 origin;     // m, in the world at the step's start, rounded
    uint first_from; // of a mesh that deforms: its first vertex at the start of the step
    vec3 place_from; // m, of the origin, from there
    uint first_to;   // and at its end
    vec3 place_to;
    uint padding;
};

// Push constants of the integration passes.
struct StagePush
{
    vec3 gravity;         // m/s^2
    float step;           // s, of the whole substep
    vec3 wind;            // m/s
    float air_density;    // kg/m^3
    vec4 gust_phases;     // rad, of the four waves of the gusts at this time
    float gust_speed;     // m/s, of all waves together, root mean square
    float gust_frequency; // 1/m, of the longest wave
    uint first_patch;     // of the dispatch
    float kick;           // Verlet: s, how long the acceleration acts on the velocity
    float drift;          // Verlet: s, how far the position moves on; 0 ends a step
    uint stage;           // RK4: 1 to 4
};

// Push constants of the contact pass.
struct ContactPush
{
    float step; // s
    uint colliders;
    uint renew;          // 1: lists of candidates are renewed in this substep
    float renewal_time;  // s, from one renewal to the next
    float progress_from; // 0..1, of the step at the substep's start
    float progress_to;   // and at its end
    float progress_a_substep;
    uint substep;       // counted through all steps
    uint first_substep; // of the step
    uint vertices;      // of all cloths
    uint features;      // 1: colliders have corners or edges that may have met vertices
    uint recovers;      // 1: colliders have an inside, from which vertices are brought out
    uint near_stride;   // words per patch of near colliders; 0: there are no lists
    uint recovery;      // the word of the dispatch's size that tells whether any vertex is inside
    uint in_place;      // 1: what contact changes it writes into the proposed state; 0: all goes into the earlier one
    float mesh_extent;  // m, that a mesh has at most along an axis from its origin
};

// Push constants of the look at which colliders are near.
struct ColliderReachPush
{
    float time;   // s, to the next look
    float sudden; // m/s, that a vertex at rest may come to have until then
    float progress_per_substep;
    uint colliders;
    uint features; // 1: colliders have corners or edges that may meet the cloth
    uint near_stride;
};

// Votes of a cloth's vertices inside of colliders: of sides, the sum of directions in the world, how many these are,
// and the colliders, each a bit, the 33rd that of the first.
#define VOILE_VOTE_WORDS 6
#define VOILE_VOTE_COUNT 4     // the word of their number
#define VOILE_VOTE_COLLIDERS 5 // the word of the bits

// How a vertex comes out of a collider that it was inside of at the start of the step.
struct Depenetration
{
    vec3 velocity; // m/s, world, relative to the collider
    uint solid;    // the collider + 1; 0: it is inside of none
};

// Push constants of the pass that finds the way out of colliders.
struct RecoverPush
{
    float step; // s, of the whole step
    uint colliders;
    uint near_stride;
    uint recovery; // the word of the size that is written
};

// Push constants of the passes over pins, attachments and tethers.
struct AttachmentPush
{
    uint first; // of the records
    uint count;
    float step;     // s; pins: of the whole step
    float progress; // 0..1, of the step at the substep's end
    float rate;     // 1/s, of the progress
};

#define VOILE_EDIT_MASSES 0    // inverse masses from areas and density
#define VOILE_EDIT_RESET 1     // back to the start
#define VOILE_EDIT_TRANSFORM 2 // places by the matrix, velocities by its turning
#define VOILE_EDIT_VELOCITY 3  // all velocities alike

// Push constants of the pass that takes a deforming mesh's vertices from what the host gave.
struct DeformPush
{
    mat4 transform;  // the collider's space from the mesh's
    vec3 origin;     // m, of that space in the world
    uint first_word; // of the input
    uint stride;     // words
    uint first_from; // where the vertices are now
    uint first_to;   // where they go
    uint vertices;
};

// Push constants of an edit of one cloth.
struct EditPush
{
    mat4 transform;
    vec3 velocity; // m/s
    uint kind;
    uint cloth;
};

// Push constants of one pass of the strain limit.
struct StrainPush
{
    uint spacing; // of the level, in grid lines
    uint between; // 1: vertices between the lines of the level before take over what their neighbors were moved by
    float acceleration; // of the passes of a level (Chebyshev); 1: none
    uint first;         // 1: of a level; no vertex knows yet what it bears
    uint last;          // 1: of all; what vertices bear gives way to their flags
};

// A patch's part of what a step or the strain limit does to its cloth (limit_work.comp). Of a displacement dx and a
// change of velocity dv:
struct LimitWork
{
    float energy;      // J, of springs in one state
    float work;        // J, of elastic forces and gravity in that state along dx
    float linear_work; // J, of bending and gravity alone
    float v_dv;        // J, sum of m v . dv
    float dv_dv;       // J, sum of m dv . dv
    float v_dx;        // J s, sum of m v . dx
    float dx_dx;       // J s^2, sum of m dx . dx
    float dv_dx;       // J s, sum of m dv . dx
    float undone;      // J s^2, minus the sum of m dx . (displacement from the step's start)
};

// How much a cloth takes of what the strain limit changes, and what the limit has taken from its energy and may give
// back.
struct LimitScale
{
    float position;   // 0..1, of the displacements as they are now
    float velocity;   // 0..1, of the changes of velocity
    float shift_rate; // 1/s, of the displacements as a change of velocity besides
    float kept;       // 0..1, of the limit's displacements in all
    float saved;      // J, that displacements may cost; after the last look, what the next step may
    float lost;       // J, that they may cost besides, gone in this step
};

// How often the energy of what is kept is measured.
#define VOILE_LIMIT_LOOKS 2

struct LimitScalePush
{
    uint patches;
    float rate; // 1/s, the largest shift_rate
    uint look;  // 0: at all of the displacements; then, up to VOILE_LIMIT_LOOKS, at what is kept of them
};

// Push constants of the statistics passes.
struct StatisticsPush
{
    uint colliders;
    uint near_stride;
};

struct StatisticsReducePush
{
    uint patches;
    uint slot; // of the result
};

// Sums and maxima over a patch, and, reduced, over all cloths.
struct StatisticsRecord
{
    float max_stretch;         // max of l / L - 1 over structural and shear springs
    float stretch_sum;         // sum of l / L - 1 over the same springs
    float kinetic_energy;      // J
    float deepest_penetration; // m, of a vertex inside a collider from the nearest surface
    uint springs;              // how many stretch_sum adds up
    uint nan_vertices;         // vertices with a position or velocity that is not finite
    uint penetrating_vertices; // vertices inside a collider
    uint contacts;             // vertices that touch a collider
    uint candidates;           // triangles in the lists of all vertices
    uint overflowing_vertices; // vertices near more triangles than a list holds: they traverse in every substep
    uint padding_0;
    uint padding_1;
};

VOILE_SHARED_END

#endif
