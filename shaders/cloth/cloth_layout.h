// Cloths, colliders and push constants as the GPU reads them. One definition for GLSL and C++.
#ifndef VOILE_CLOTH_LAYOUT_H
#define VOILE_CLOTH_LAYOUT_H

#include "../shared_types.h"

// The springs of a grid vertex come in eight classes; a class joins it to the vertices at +offset and -offset.
// Classes 0-1 structural (column, row), 2-3 shear, 4-5 bend, 6-7 diagonal bend.
#define VOILE_SPRING_CLASSES 8

#define VOILE_COLLIDER_PLANE 0
#define VOILE_COLLIDER_SPHERE 1
#define VOILE_COLLIDER_MESH 2

// A closed mesh has an outside: its triangles push outwards. Any other mesh pushes to the side that a vertex came from.
#define VOILE_COLLIDER_CLOSED 1u
// The collider has friction coefficients of its own.
#define VOILE_COLLIDER_FRICTION 2u

VOILE_SHARED_BEGIN(cloth)

struct SpringClass
{
    float stiffness;   // N/m
    float damping;     // N s/m
    float rest_length; // m
    float padding;
};

// One a cloth. Vertices of a cloth are consecutive: row * columns + column, from first_vertex.
struct ClothRecord
{
    uint first_vertex;
    uint columns;
    uint rows;
    float thickness;       // m
    float static_friction; // Coulomb coefficients of the fabric
    float kinetic_friction;
    float linear_drag;     // N s/m a vertex: force = linear_drag * (wind - velocity)
    float drag_normal;     // C_n of the quadratic law
    float drag_tangential; // C_t
    float border_share;    // of masses and of springs along the border
    float padding_1;
    float padding_2;
    SpringClass springs[VOILE_SPRING_CLASSES];
};

// What one workgroup works on: vertices first .. first + group size - 1 of one cloth.
struct Chunk
{
    uint cloth;
    uint first; // counted within the cloth
};

struct ColliderRecord
{
    uint kind;
    uint flags;
    float static_friction;
    float kinetic_friction;
    vec3 box_min; // m, world; everything of the collider is inside (planes: unused)
    uint first_node;
    vec3 box_max;
    uint first_triangle;
    vec4 shape; // plane: unit normal and offset (normal . x of its points); sphere: centre and radius
};

// Push constants of the integration stages.
struct StagePush
{
    vec3 gravity;      // m/s^2
    float step;        // s, of the whole substep
    vec3 wind;         // m/s
    float air_density; // kg/m^3
};

// Push constants of the contact pass.
struct ContactPush
{
    float step; // s
    uint colliders;
};

// Push constants of the statistics passes.
struct StatisticsPush
{
    uint colliders;
};

struct StatisticsReducePush
{
    uint chunks;
    uint slot; // of the result
};

// Sums and maxima over a chunk, and, reduced, over all cloths.
struct StatisticsRecord
{
    float max_stretch;         // max of l / L - 1 over structural and shear springs
    float stretch_sum;         // sum of l / L - 1 over the same springs
    float kinetic_energy;      // J
    float deepest_penetration; // m under a collider's surface
    uint springs;              // how many stretch_sum adds up
    uint nan_vertices;         // vertices with a position or velocity that is not finite
    uint penetrating_vertices; // vertices under the surface of a collider
    uint contacts;             // vertices that touch a collider
};

VOILE_SHARED_END

#endif
