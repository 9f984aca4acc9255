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
    // vertices) and with its friction. Two cloths collide at the mean of their thicknesses,
    // with the geometric means of their friction coefficients.
    //
    // Cloths that start without intersections stay without them, whatever forces, colliders, attachments, tethers and
    // the strain limit do. A collider that presses layers together enters them instead
    // (Statistics::penetrating_vertices). Nothing stops a vertex without mass: cloth may intersect if pins are driven
    // into it faster than it can give way (Statistics::forced_pairs). A free sheet gave way to a pinned one at up to an
    // eighth of the thickness per substep, three sheets on each other at up to a thirtieth. Cloth may also intersect
    // where the host puts it: reset, teleport, a snapshot, a pin with a position elsewhere. Strips of 0.1 m width whose
    // pinned ends turned against each other stayed free of intersections up to 4.2 turns per meter, in weightlessness;
    // from 4.9 turns per meter on, or 3.1 of 0.14 m width, the pins forced their way, and tangles stayed.
    //
    // Cloth that intersects when a step starts is pulled apart (SolverOptions::untangling, Statistics::tangled_pairs).
    // In that step, vertices around an intersection collide with all other cloth but not with each other. They are
    // accelerated at 300 m/s^2 up to 0.5 m/s along directions that shorten the line of intersection; springs may add to
    // that. Sheets of 14 x 14 vertices that start halfway through each other are free within half a second. The pull
    // ignores masses, so momentum is not conserved: silk and leather together gained 0.35 m/s. Cloth that pins or
    // colliders hold inside other cloth stays there, and so do sheets at exactly the same position. Some crumples that
    // pass through each other many times keep moving and never come free.
    //
    // Near other cloth, a vertex moves at most 0.45 of the gap in 0.27 to 0.53 ms, or in a substep if that is longer.
    // This is relative to the mean velocity, by mass, of the cloth that is clear of colliders; beside colliders and
    // anchors it is relative to the rigid motion that fits theirs best, and the cloth's in directions in which they do
    // not hold it. A vertex that this stops keeps its velocity, and hands it on to what it has met. While colliders or
    // anchors move, where lists of pairs are full, and beside pins, that velocity is lost with its momentum. The mean
    // is that of an island: the cloths whose boxes may meet within 3 ms. Cloths outside the island affect only when
    // near pairs are searched. Cloth in free flight falls freely, in any shape and at any speed, as long as its island
    // flies together. That holds even if layers start very near each other, or touch. A closed sphere of 38 vertices
    // along a seam that is not merged drove itself to 0.8 m/s in 4 s. Two sheets nearer than a tenth of the thickness
    // lost 0.06 m/s or a little more while they parted. Layers that start nearer than a fiftieth of the thickness do
    // not part. Parts of a mesh that touch at the start, as along a seam that is not merged, do not collide with each
    // other there. Neither does cloth that pins hold at one point, nor cloth that is within 1e-7 m of other cloth, or
    // within 1e-7 of its coordinates: these count as forced.
    //
    // So cloth that anchors or colliders carry along, or that slides or falls along a surface, is as free as cloth at
    // rest, also on a budget of 8 substeps: two layers on a floor that moves at 30 m/s do not slip, two that slide at
    // 12 m/s are slowed as Coulomb's law says within 1 %, on uneven ground within 10 %, capes of 10 and 25 mm spacing
    // follow anchors at 15 and 40 m/s, and capes 0.4 m from a vertical axis follow anchors that turn at 5 rad/s in 8
    // substeps, at 7 in 16, and at 15 with all, with less than 1.5 times their stretch without self-collision (leather,
    // ribbons and other axes: up to 2.3 times, about an axis through the hem up to 4.9 times, 0.27 instead of 0.055).
    //
    // All of an island has one such rigid motion. What moves very differently from it is held back as if it were fast
    // beside cloth at rest, and left behind or torn: a cape that passes a curtain within 20 mm at 8 m/s in 8 substeps,
    // or at 40 m/s with all (at 25 m/s with all it is not); as islands are found by boxes along the axes, also one that
    // passes within the box of a large diagonal curtain at 4 m/s in 8 substeps, or at 6 m/s in 16. Capes on anchors
    // that turn at 10 rad/s, or swing by 0.2 m at 3 Hz, stretch by 0.7 to 6 in 8 substeps, flags that crumple on an
    // anchor at 10 m/s by 0.9 to 6 in 8 and 1.2 in 16, and intersect there (Statistics::forced_pairs). A sphere of 30
    // mm that a hem passes 10 mm above at 6 m/s stretches a cape by 0.15 instead of 0.03 in 8 substeps. Layers that
    // slide through a narrow channel of few flat sides (0.5 m radius, 24 sides, 8 m/s) lose most of their speed, and in
    // 8 substeps their edges enter it; layers on a moving floor are braked by a ceiling nearer than 20 mm in 8
    // substeps, nearer than 12 mm at 12 m/s with all. Three layers and more slip in 8 substeps where friction is
    // needed, by 40 to 100 mm in a second, also at rest. At 4 km from the origin layers lose a tenth of their friction,
    // at 8 km all; beyond 9 km floats leave cloth of 3 mm too little room: it freezes or, with anchors that turn, is
    // torn.
    //
    // A collider that moves less than half of the thickness per substep pushes such cloth without entering it. This
    // held at 24 m/s with a spacing of 11 mm and automatic substeps. A faster collider may pass through. A collider
    // that drives a sheet into another one may pass through from a quarter of the thickness per substep on. Colliders
    // that moved 0.15 to 0.25 of the thickness per substep entered three and more sheets for some frames, by 4 to 16
    // vertices, up to 12 mm deep. The faster colliders or anchors move, the more often near pairs are searched, up to
    // once per substep. The solver does not know the speed of vertices in a GPU buffer (DeviceVertices).
    //
    // Cloth sticks on cloth up to nine tenths of static friction and creeps there at less than 0.1 mm/s; a second sheet
    // on top of it creeps at up to 0.6 mm/s. Where vertices lie above vertices, as in equal grids that are not rotated
    // against each other, a sheet creeps at up to 1 mm/s at eight tenths, and one slid at 0.88. Cloth that slides on
    // cloth is slowed as Coulomb's law says, within 1 % at up to 1.5 m/s and 5 % at 2 m/s; at 3 m/s by up to 1.6 times
    // as much. Layers that lie on each other on a plane or a sphere come to rest: two to six sheets kept less than 1e-4
    // J/kg, and the uppermost of six moved at 0.1 to 0.4 mm/s. Pins that gather a grid to a twentieth of its width, in
    // their order, keep single vertices beside them in motion. Three meshes with edges of 20 mm that pins gathered to a
    // fifth or less within 0.5 s intersected (Statistics::forced_pairs), and stayed tangled.
    //
    // Of 40 random pairs of sheets of equal spacing that approached each other at 0.5 to 4 m/s, none lost more than
    // 0.1 % of its momentum; of 24 at 5 to 11 m/s none lost more than 2.2 %. Cloth of 8 to 12 mm spacing on coarser
    // cloth lost up to 19 % at 4 m/s and 56 % at 8 m/s, a mesh that hit another one with its edge 36 %, and cloth in 4
    // substeps a frame 78 %, because lists of pairs were full. Equal sheets, one of which hits the other with its edge,
    // lost 2 % at 2 m/s and 28 to 33 % at 4 m/s. A sheet of four times the mass that hits another one flat at 30 and
    // 50 m/s adds neither momentum nor energy. Cloths of different kinds that hit each other at 24 m/s, or in 8
    // substeps a frame, may: four random scenes gained 9 to 16 % of their energy. Sheets that start nearer than the
    // thickness part at up to 0.25 m/s.
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

// Limits of contact. They hold for all colliders.
//
// Depenetration. Cloth that is inside a collider at the start of a step is moved out.
// - Inside means inside a sphere, a capsule or a box, or inside a closed mesh that pushes outwards, where its winding
//   number is above 0. Overlapping colliders are one solid.
// - A vertex leaves at 0.9 m/s relative to the surface, from the step after the one that found it. Pins stay.
// - A sheet leaves to one side as a whole, along its normals, at less than 2.5 m/s. A sheet that a solid pierces is
//   stretched: by 21 % in the worst of 60 random poses. In those without gravity, the fastest part reached 2.5 m/s; a
//   vertex of a sheet thrown while it was pierced, or pushed into a slot, 13 m/s.
// - Until a vertex is out, its own motion is slowed to 0.6 m/s. The collider carries it at the collider's speed v up to
//   10 m/s. A faster collider carries it at 10 m/s (10 m/s / v)^2, so a collider that jumps throws no cloth. The
//   collider's edges and corners do not stop the cloth, and no other solid stops the vertex.
// - Where two colliders close on cloth that was outside, it stays halfway between their surfaces, and they release it
//   when they part. Balls, capsules and round meshes that overlapped by 20 mm left no edge in a sheet. Boxes whose
//   edges were within the sheet left none 10 frames after they had parted in 67 of 70 scenes, and 6 to 10 pairs in
//   three; vertices reached up to 62 m/s where boxes were tilted by 17 degrees. Plates thinner than the cloth leave
//   hundreds, and throw it. Edges and corners of both do not push that cloth meanwhile.
// - A vertex below a plane, or nearer to a surface than the thickness at the start of a substep, rises at 0.75 m/s.
// - Vertices are checked after uploads, edits and snapshots, while colliders move, while any are inside, and every
//   eighth step. A collider that moves onto cloth pushes it at any speed. If the cloth collides with itself and lies in
//   two layers, a collider that moves by more than a quarter of the thickness per substep may enter it: for sheets of 3
//   mm, 5 m/s in 112 substeps per frame. With more layers, a collider that moves by less may also enter
//   (GridCloth::self_collision).
//
// Edges and corners. Edges and corners of colliders collide with the triangles and edges of cloths
// (SolverOptions::feature_contact).
// - Cloth 1 and 3 mm thick, with 43 mm between vertices, was shot at needles, strips and boxes at 5 to 60 m/s. No edge
//   of the cloth or the collider was left through the other, nor when such colliders were driven through a sheet at up
//   to 100 m/s. Fast cloth near edges and corners may lose some of its speed along them. Of about a hundred random
//   shots, three left the corner of a plate 1 to 6 mm thick through cloth that was taut between pins, by 2 mm at most.
//   A strain limit moves cloth after contact, and so does the limit that replaces missing substeps. With either, edges
//   may be left through a collider.
// - A collider has the edges and corners that the coarsest and the thinnest cloth of its layers need, whether these are
//   enabled or not. So another such cloth changes how the collider holds this one (by 5 mm beside a sphere). Cloths of
//   other layers do not.
// - Vertices of a billionth of their neighbors' mass may be thrown at edges (1.3 km/s, 10 m/s without edges).
// - A mesh that deforms has edges and corners where its present shape bends. If its vertices move by more than the
//   thickness between two contact passes, finding these takes longer. Needles that bend and turn at more than 30 m/s
//   may be left through the cloth.
// - Static friction is less exact for cloth that edges, corners, thin spheres and capsules support between its
//   vertices. It may slip from 0.8 of static friction on, and creeps at less than 0.3 mm/s. Finer cloth, which touches
//   with its vertices, does neither. Silk that hangs over a pole 40 mm thick creeps at 10 to 17 mm/s and slides off,
//   unless every substep has a contact pass (Tuning::contact_interval).
//
// Rest. Cloth at rest stays at rest where its vertices touch. Cloth that hangs free swings for a long time: the hem of
// coarse wool on a box still moves at about 50 mm/s after 10 s.
//
// Cost. A collider costs time where cloth is near. With more than 8 colliders, the solver lists a few times per frame
// which are near which part of a cloth. Planes count as near everywhere.

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
