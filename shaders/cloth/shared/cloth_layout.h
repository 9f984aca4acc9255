// Cloths, the lists of their meshes, and patches, as the GPU reads them. One definition for GLSL and C++.
#ifndef VOILE_CLOTH_LAYOUT_H
#define VOILE_CLOTH_LAYOUT_H

#include "../../shared_types.h"

// The springs of a grid vertex have eight classes. A class joins the vertex to the vertices at +offset and -offset.
// Classes 0-1: structural (column, row), 2-3: shear, 4-5: bend, 6-7: diagonal bend.
// The springs of a mesh have five classes. 0: along edges (Material). 1: between the vertices opposite to an edge. 2-4:
// the springs of a Fabric's membrane along warp, weft and both diagonals (membrane.glsl), in N/m and N s/m of strain
// and strain rate.
#define VOILE_SPRING_CLASSES 8
#define VOILE_CLASS_EDGE 0
#define VOILE_CLASS_OPPOSITE 1
#define VOILE_CLASS_WARP 2
#define VOILE_CLASS_WEFT 3
#define VOILE_CLASS_DIAGONAL 4
#define VOILE_MEMBRANE_SPRINGS 3

// In ClothRecord.first_limit.
#define VOILE_NO_LIMIT_LEVELS 0xffffffffu

// Absolute limits of the input along each axis, as in voile/ranges.hpp.
#define VOILE_MOST_COORDINATE 1e6 // m
#define VOILE_MOST_SPEED 1e4      // m/s
// Limits of the speed of the air relative to a vertex, along each axis, and of the area that it acts on.
#define VOILE_MOST_AIR_SPEED 1e5 // m/s
#define VOILE_MOST_AIR_AREA 1e12 // m^2

// Flags of a cloth.
#define VOILE_CLOTH_VERLET 1u          // velocity Verlet; otherwise RK4
#define VOILE_CLOTH_ISOMETRIC 2u       // isometric bending; a Fabric then has no bend springs
#define VOILE_CLOTH_UNIFORM_SPRINGS 4u // a mesh whose springs all have their class's constants; weights do not count
#define VOILE_CLOTH_SELF_COLLISION 8u  // it collides with itself, and with other cloths of its layers that do
// Set by the GPU: the cloth sleeps in this step (wake_cloths.comp).
#define VOILE_CLOTH_ASLEEP 16u
// Set in MeshSpring.neighbor: the spring joins the two vertices opposite to an edge.
#define VOILE_OPPOSITE_BIT 0x80000000u

// Flags of a vertex. Their sum is the w of its velocity.
#define VOILE_VERTEX_TOUCHES 1         // it touches a collider
#define VOILE_VERTEX_TAUT 2            // an attachment or a tether acts on it
#define VOILE_VERTEX_TOUCHES_FEATURE 4 // a triangle or an edge around it touches a feature of a collider
#define VOILE_VERTEX_SUPPORTED 8       // while colliders move: one of them holds it against other cloth
#define VOILE_VERTEX_PUSHED 16         // a moving collider or pin pushes it, maybe through other cloth
#define VOILE_VERTEX_HELD 32           // a max-distance constraint is taut, or a spring acts within a few milliseconds
#define VOILE_VERTEX_BOUND 64          // a tether, a max-distance constraint or a backstop limits it

VOILE_SHARED_BEGIN(voile)

struct SpringClass
{
    float stiffness;   // N/m
    float damping;     // N s/m
    float rest_length; // m; of a mesh's edges: the mean spacing of vertices; each spring has its own length
    float padding;
};

// A cloth. Its vertices are consecutive, from first_vertex on. In a grid, the index of a vertex is row * columns +
// column.
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
    float linear_drag;     // N s/m per vertex: force = linear_drag * (wind - velocity)
    float drag_normal;     // C_n of the quadratic law
    float drag_tangential; // C_t of the quadratic law
    float border_scale;    // of masses and of springs along a grid's border
    uint flags;
    float omega_squared;      // 1/s^2, of the fastest mode in any shape, with bending
    float decay;              // 1/s, the fastest decay rate in any shape
    float gravity_scale;      // times the gravity of the step
    float inverse_density;    // 1 / areal density or vertex mass; times `start.w` of a vertex, its inverse mass
    float strain_relaxation;  // of a correction of the strain limit
    uint layers;              // bits; the cloth collides with colliders that have one of them
    float flat_omega_squared; // 1/s^2, of the fastest mode of the flat cloth
    float strain_limit;       // largest l / L - 1; 0: no limit
    uint strain_spacing;      // of the widest level of the strain limit that limit_strain.comp takes, in grid lines
    float pair_thickness;     // m, from itself and other cloths
    float pair_range;         // m, within which pairs are listed
    float pair_sweep;         // m, the longest motion along which they are
    float pair_slide;         // m, the longest part of it along the surface
    uint strain_passes;       // of the strain limit on each level
    float sleep_speed;        // m/s; 0: it never sleeps
    // Stiffness of the isometric model. Grid, N/m: of a second difference along a row, along a column, and of a twist.
    // Mesh, N m: x.
    vec3 bending;
    float bending_time;     // s; the bending force depends on x + bending_time * v
    float pair_mass;        // kg, of its heaviest vertex
    uint first_fan;         // of a mesh that collides with itself: its first MeshFan
    float softened_substep; // s; if longer than a substep, the cloth is softened as if it were one
    uint first_limit;       // its first LimitVertex; VOILE_NO_LIMIT_LEVELS: levels are lines of the grid
    SpringClass springs[VOILE_SPRING_CLASSES];
};

// The lists of a mesh vertex: its springs, and the triangles around it. A list consists of the entries first, first +
// stride, first + 2 stride, ... of MeshSpring[], or of MeshCorner[] and MembraneCorner[]. With a stride of 1 each list
// is contiguous. With a stride of the workgroup's size the first entries of its vertices are contiguous, then the
// second ones, so that the reads of a workgroup coalesce.
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
    float weight;      // factor of the class's stiffness and damping. Edge: 1; opposite: 1/m^2. 0: no spring
    float bending;     // 1/m^2, of the isometric model: force = -B * bending * (x_neighbor - x)
};

// A triangle around a vertex: its other two corners, counter-clockwise, counted within the cloth.
struct MeshCorner
{
    uint b;
    uint c;
};

// Of a mesh vertex: its wedges, and the owners of primitives around it (pairs/fan.glsl), each from the first one on.
struct MeshFan
{
    uint first_wedge;
    uint wedges;
    uint first_owner;
    uint owners;
};

// In MeshWedge: the vertex owns the edge to b, or to c.
#define VOILE_SPOKE_BIT 0x80000000u

// A triangle that a vertex owns, with its other two corners counted within the cloth, or an edge: b == c. A vertex that
// owns neither has one wedge without spokes: it can meet triangles itself.
struct MeshWedge
{
    uint b;
    uint c;
};

// The same triangle at rest, at the same index as its MeshCorner. For the three corners of a triangle only `corner`
// differs.
struct MembraneCorner
{
    vec2 gradient_1; // 1/m, along warp and weft, of the barycentric coordinates of corner 1
    vec2 gradient_2; // and of corner 2
    float weight;    // m^2, the area; less for a sliver
    uint corner;     // the number of the vertex in the triangle: 0..2, counter-clockwise
};

// In Patch.tile. Its lowest bits are the tile_shift.
#define VOILE_PATCH_TILE_SHIFT 15u
// Set by the GPU: the cloth of the patch sleeps in this step (wake_cloths.comp).
#define VOILE_PATCH_ASLEEP 16u
// The bits from here on, which the GPU writes: in the n-th patch of a batch, the index of the batch's n-th patch whose
// cloth is awake (list_awake_patches.comp).
#define VOILE_PATCH_AWAKE_SHIFT 5
// In the push constant first_patch: workgroups take the patches that are awake.
#define VOILE_AWAKE_PATCHES 0x80000000u

// The vertices of one workgroup. Of a mesh: vertices first .. first + group size - 1. Of a grid: a tile of 2^tile_shift
// columns from column `first` on, and of as many rows from `row` on as fill the group, so that a workgroup's vertices
// are near each other. Members of the cloth are copied here to save a dependent load.
struct Patch
{
    uint cloth;
    uint first_vertex; // of the cloth
    uint columns;      // of the cloth; of a mesh 0
    uint rows;         // of the cloth; of a mesh its vertices
    uint first;        // counted within the cloth
    uint row;
    uint tile;          // VOILE_PATCH_*
    uint near_features; // 1: it may touch features of colliders before the next query (find_near_features.comp)
};

#ifdef __cplusplus
static_assert(sizeof(SpringClass) == 16);
static_assert(sizeof(ClothRecord) == 144 + 16 * VOILE_SPRING_CLASSES);
static_assert(offsetof(ClothRecord, bending) == 112);
static_assert(offsetof(ClothRecord, springs) == 144);
static_assert(sizeof(MeshVertex) == 16);
static_assert(sizeof(MeshSpring) == 16);
static_assert(sizeof(MeshCorner) == 8);
static_assert(sizeof(MeshFan) == 16);
static_assert(sizeof(MeshWedge) == 8);
static_assert(sizeof(MembraneCorner) == 24);
static_assert(sizeof(Patch) == 32);
#endif

VOILE_SHARED_END

#endif
