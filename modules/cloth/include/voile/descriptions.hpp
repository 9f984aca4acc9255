// Descriptions of what a solver simulates: cloths and colliders. A description is copied and validated when it is
// added. Units are SI. Positions in the world lie within 1e6 m along each axis; ranges.hpp lists all ranges.
#pragma once

#include "voile/cooked.hpp"
#include "voile/ids.hpp"
#include "voile/material.hpp"
#include "voile/math.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace voile
{

// How a cloth advances in time.
enum class Integrator
{
    rk4,    // Four force evaluations per substep, and substeps 1.3 times as long. The more accurate one.
    verlet, // Velocity Verlet. One force evaluation per substep. The faster one for stiff cloth.
};

// A rectangular cloth. It lies flat in x and z, centered on the origin, before its transform.
//
// Vertex index = row * columns + column. Column c lies at x = (c / (columns - 1) - 1/2) * width, row r in z by the same
// rule.
struct GridCloth
{
    // For messages and captures.
    std::string name = "cloth";

    // Vertices along x and along z, 2..8192.
    uint32_t columns = 64;
    uint32_t rows = 64;

    // Size along x and along z, m, 1e-4..1e5.
    float width = 1;
    float depth = 1;

    // World from grid; affine. It does not change the rest lengths: with a transform that stretches, the cloth starts
    // stretched. The transformed x and z axes are at least 1e-7 long and not parallel.
    Mat4 transform{1.f};

    // Velocity of every vertex at the start, m/s, -1e4..1e4 along each axis.
    Vec3 velocity{0.f};

    // A Fabric or a Material. fabrics.hpp has presets.
    ClothMaterial material{};

    Integrator integrator = Integrator::rk4;

    // Vertices that stay where they are. Repeated vertices are allowed. Solver::set_attachments replaces these pins.
    std::vector<uint32_t> pins{};

    // Inverse mass of each vertex, 1/kg, 0..1e9. 0 keeps a vertex in place. Empty: the material's masses.
    std::vector<float> inverse_masses{};

    // Bits. The cloth collides with colliders that share one, and with cloths that share one if both have
    // `self_collision`.
    uint32_t layers = 1;

    // The cloth collides with itself and with other such cloths, at its thickness (at most 0.4 of the spacing of its
    // vertices) and with its friction. Two cloths collide at the mean of their thicknesses, with the geometric means of
    // their friction coefficients.
    //
    // Cloths that start without intersections stay without them, whatever forces, colliders, attachments, tethers and
    // the strain limit do. Statistics count the exceptions: pins that drive vertices into cloth faster than it gives
    // way (forced_pairs), colliders that press layers together, which then enter the collider (penetrating_vertices),
    // and cloth that the host puts into cloth (tangled_pairs), which is pulled apart (SolverOptions::untangling).
    //
    // Near other cloth, fast vertices are held back relative to the motion of the cloths around them. On a budget of
    // substeps, what passes other cloth at several m/s may be left behind or tear. A collider that moves less than half
    // of the thickness per substep pushes such cloth without entering it. A faster one may pass through.
    // docs/self-collision.md has all limits with their numbers.
    bool self_collision = false;

    // m/s, 0..10. The cloth falls asleep when none of its vertices has been faster than this for 0.5 s of simulated
    // time. Both the velocity at the end of each step and the displacement in the step must be below it. On other
    // cloth, velocities may be larger by what gravity adds in 0.13 to 0.27 ms, or in half a substep if that is longer:
    // cloth at rest there has them. Vertices without mass do not count. 0: the cloth never sleeps. The GPU decides;
    // Statistics::sleeping_cloths counts the cloths that sleep.
    //
    // A sleeping cloth keeps its positions bit for bit, and its velocities are 0. The passes of a step skip it. It
    // wakes at the beginning of a step
    // - after the host has changed the cloth: material, attachments, tethers, layers, reset, teleport, velocity,
    //   enabled, sleep_speed, Solver::wake;
    // - in which one of its anchors moves;
    // - if gravity, wind, gusts or the air's density have changed since the last step and act on it;
    // - after a collider of its layers was added, removed, enabled or disabled, or its friction, layers or size
    //   changed, or an upload that adds a cloth made its edges anew;
    // - in which such a collider moves or deforms and may come near: the box that it sweeps in the step is within twice
    //   the thickness of the box around the cloth. A moving plane is near all cloths. A rotating collider sweeps a ball
    //   around its origin.
    // - with `self_collision`, if a cloth of its island is awake: cloths whose boxes may meet within 3 ms fall asleep
    //   and wake together, so they do not sleep near one whose sleep_speed is 0. A cloth whose velocities lead near it
    //   within the step also wakes it. A cloth that is accelerated towards it during the step, as by a fast collider,
    //   finds it at rest until the next step. Removing, enabling or disabling a cloth with self_collision wakes all
    //   other such cloths.
    // A cloth that wakes stays awake for at least 0.5 s. So does an awake cloth that a moving collider comes near.
    // Cloth on which gusts act does not fall asleep, nor does cloth beside a moving collider.
    float sleep_speed = 0;
};

// A cloth of triangles. The mesh may be open or closed, in one piece or several. Vertices keep their order.
//
// - The longest side of each triangle is 1e-4..1e5 m, after the transform. The other sides may be shorter.
// - A triangle counts as having no area if its height is below 20 nm, or below 2e-6 of its longest side.
// - Triangles without area have no springs and may have any size. Vertices without a triangle stay where they are.
// - At an edge of three or more triangles, each pair of them resists bending.
// - mesh_report counts all such cases.
//
// Small triangles are stiff, and the stiffest springs and folds set the substeps of the whole cloth
// (Solver::stable_substeps). A sliver 3 cm long and 10 um high would need a million, so a few slivers are softened:
// - A triangle is softened if it is more than 8 times as stiff, relative to the mass it moves, as most others: 99 % of
//   all, or all but 12 of 240 or more, or 95 % of 60 or more. It gets the stiffness of the stiffest of those.
// - A fold, or a spring across an edge, is softened if it is 64 times as stiff.
// - Masses stay, and forces between vertices stay equal and opposite.
// - Nothing is softened in a mesh of fewer than 60 triangles, of similar triangles, or of triangles whose sizes change
//   gradually. Springs of a Material are uniform and are never softened.
struct MeshCloth
{
    // For messages and captures.
    std::string name = "cloth";

    // m, in the space of the mesh.
    std::span<const Vec3> positions{};

    // Indices into positions, counter-clockwise seen from outside.
    std::span<const UVec3> triangles{};

    // One per position, m of fabric, -1e6..1e6. In each triangle, the warp of a Fabric runs in the direction in which
    // the first coordinate grows and the second does not change; the weft is at right angles to it. Both turn with the
    // transform, and the scale of the coordinates does not matter. Empty: the mesh is projected along the one of its
    // own axes along which it is thinnest, so a flat mesh in x and z has its warp along x, like a GridCloth. A triangle
    // whose coordinates have no area is also projected.
    std::span<const Vec2> texture_coordinates{};

    // World from mesh; affine. The transformed mesh is the shape at rest.
    Mat4 transform{1.f};

    // Velocity of every vertex at the start, m/s, -1e4..1e4 along each axis.
    Vec3 velocity{0.f};

    // A Fabric or a Material. fabrics.hpp has presets.
    ClothMaterial material{};

    Integrator integrator = Integrator::rk4;

    // Vertices that stay where they are. Repeated vertices are allowed. Solver::set_attachments replaces these pins.
    std::vector<uint32_t> pins{};

    // Inverse mass of each vertex, 1/kg, 0..1e9. 0 keeps a vertex in place. Empty: the material's masses.
    std::vector<float> inverse_masses{};

    // Bits. The cloth collides with colliders that share one, and with cloths that share one if both have
    // `self_collision`.
    uint32_t layers = 1;

    // The cloth collides with itself, and with other such cloths (GridCloth::self_collision).
    bool self_collision = false;

    // m/s, 0..10: below this speed the cloth falls asleep (GridCloth::sleep_speed). 0: never.
    float sleep_speed = 0;

    // Replaces positions, triangles and texture coordinates, which stay empty (voile/cooked.hpp). The shape at rest is
    // that of the transform at cooking. This transform may differ from that one by a rotation and a translation. With
    // the same transform, results are bit-identical to those of the mesh itself. The material must be of the same kind
    // as at cooking, and may bend isometrically only if the material at cooking did.
    CookedCloth cooked{};
};

// Irregularities of a mesh as a cloth.
struct MeshReport
{
    uint32_t components = 0;           // pieces that are connected by edges
    uint32_t boundary_edges = 0;       // edges of one triangle; 0: the mesh is closed
    uint32_t non_manifold_edges = 0;   // edges of three triangles or more
    uint32_t isolated_vertices = 0;    // vertices without a triangle that has area
    uint32_t degenerate_triangles = 0; // triangles without area
    uint32_t coincident_vertices = 0;  // at the position of an earlier one but not joined to it: an open seam
    uint32_t softened_edges = 0;       // edges of slivers, with springs or folds softer than the material's
    float shortest_edge = 0;           // m; the smallest triangles set the number of substeps
};

// Coulomb friction of a collider. The friction of a pair is the geometric mean of the cloth's and the collider's. A
// collider without friction takes the cloth's.
struct Friction
{
    float static_coefficient = 0;  // kinetic_coefficient..100
    float kinetic_coefficient = 0; // 0..100
};

// The side to which a mesh pushes.
enum class Sidedness
{
    automatic, // A closed mesh pushes outwards, even cloth that starts inside it. An open one is two-sided.
    one_sided, // To the side that its triangles face. They are counter-clockwise seen from there.
    two_sided, // To the side that a vertex comes from. A box that holds cloth in needs this.
};

// Contact. A crossing test stops every vertex at any speed. Edges and corners of colliders also stop cloth between its
// vertices (SolverOptions::feature_contact). Where colliders close on cloth, they hold it until they part. Cloth at
// rest on a collider stays at rest.
//
// Cloth that is inside a collider at the start of a step is moved out on one side, at less than 2.5 m/s
// (SolverOptions::depenetration): inside a sphere, a capsule, a box, or a closed mesh that pushes outwards. Overlapping
// colliders are one solid. Several that are apart may throw it.
//
// docs/contact.md has the limits with their numbers: fast and thin colliders, strain limits, layers of cloth, friction
// at edges.

// A triangle mesh.
//
// It is closed if every edge is shared by two triangles that run along it in opposite directions. One open part makes
// the whole mesh open. A part is a set of triangles connected by vertices. An inside-out part of a closed mesh is
// flipped, together with the parts within it. A cavity is inside-out within the solid of another part and stays as it
// is: a hollow ball stays hollow. A part lies within another if its farthest vertices along the world's axes do. All of
// this is determined when the mesh is added and stays so as it deforms.
//
// The mesh colliders of a solver have at most 67,108,864 triangles together; those that deform have at most half as
// many. The hierarchy of a mesh that does not deform is built when it is added, with one thread per core: 0.7 s for 2
// million triangles on two cores (bench/NOTES.md). It is cached in case the same mesh is added again, to any solver;
// see set_hierarchy_cache_limit.
struct MeshCollider
{
    std::string name = "mesh";

    // m, in the space of the mesh.
    std::span<const Vec3> positions{};

    // Indices into positions. Triangles without area are dropped.
    std::span<const UVec3> triangles{};

    // World from mesh; affine.
    Mat4 transform{1.f};

    // None: the cloth's.
    std::optional<Friction> friction{};

    Sidedness sidedness = Sidedness::automatic;

    // The host moves its vertices with Solver::deform_collider. The GPU refits its hierarchy, which costs more to
    // traverse than that of a mesh that does not deform.
    bool deforms = false;

    // Bits. The collider collides with cloths that share one.
    uint32_t layers = 1;

    // Replaces positions and triangles, which stay empty (voile/cooked.hpp). The transform may differ by a rotation and
    // a translation from the one that the mesh was cooked with; a rotated collider behaves and costs like one that was
    // moved there. With the same transform, results are bit-identical to those of the mesh itself. A cooked collider
    // cannot deform.
    CookedCollider cooked{};
};

// Limits the memory of cached hierarchies, in bytes. The cache belongs to the process and serves all solvers. A
// hierarchy takes about 85 bytes per triangle, and the least recently used go first. Two meshes are the same if their
// triangles are bit-identical in the world's axes, relative to their center. 0 caches none and frees all. Any thread
// may call this at any time.
constexpr uint64_t k_default_hierarchy_cache_limit = uint64_t{256} << 20;
VOILE_API void set_hierarchy_cache_limit(uint64_t bytes);

// A plane. Everything below it is solid: normal . x < offset.
struct PlaneCollider
{
    std::string name = "plane";

    // Unit length.
    Vec3 normal{0, 1, 0};

    // m, -1e6..1e6. An inclined plane far from the origin is as precise as one at the origin, near the middle of where
    // the cloths that collide with it started. So another such cloth changes the rounding of contact with it.
    float offset = 0;

    std::optional<Friction> friction{};
    uint32_t layers = 1;
};

// A solid sphere.
struct SphereCollider
{
    std::string name = "sphere";
    Vec3 center{0.f}; // m
    float radius = 1; // m, 1e-4..2e6
    std::optional<Friction> friction{};
    uint32_t layers = 1;
};

// A solid capsule: everything within `radius` of the segment between both ends.
struct CapsuleCollider
{
    std::string name = "capsule";
    Vec3 from{0.f}; // m
    Vec3 to{0, 1, 0};
    float radius = 0.5f; // m, 1e-4..2e6
    std::optional<Friction> friction{};
    uint32_t layers = 1;
};

// A solid box.
struct BoxCollider
{
    std::string name = "box";

    // Opposite corners, m, in the space of the box, -1e6..1e6. Each side is at least 1e-4 m long.
    Vec3 min{-0.5f};
    Vec3 max{0.5f};

    // World from box; rigid.
    Mat4 transform{1.f};

    std::optional<Friction> friction{};
    uint32_t layers = 1;
};

using Collider = std::variant<MeshCollider, PlaneCollider, SphereCollider, CapsuleCollider, BoxCollider>;

// An axis-aligned box.
struct BoundingBox
{
    Vec3 min{0.f}; // m
    Vec3 max{0.f};
};

} // namespace voile
