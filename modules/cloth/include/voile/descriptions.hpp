// What can be added to a solver: cloths and colliders. Everything is copied and validated when it is added. Whatever a
// description says of its transform, every position that it gives in the world must be within 1e6 m along each axis
// (ranges.hpp).
#pragma once

#include "voile/ids.hpp"
#include "voile/material.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace voile
{

// How a cloth is advanced. RK4 evaluates the forces four times a substep and takes substeps 1.3 times as long; it is
// the one to take where accuracy counts. Velocity Verlet evaluates them once: the faster one for stiff cloth.
enum class Integrator
{
    rk4,
    verlet,
};

// A rectangular cloth, flat in x and z and centerd on the origin before its transform. Vertex index = row * columns +
// column; column c lies at x = (c / (columns - 1) - 1/2) * width, row r likewise in z.
struct GridCloth
{
    std::string name = "cloth"; // for messages and captures
    uint32_t columns = 64;      // vertices along x, 2..8192
    uint32_t rows = 64;         // vertices along z, 2..8192
    float width = 1;            // m along x, 1e-4..1e5
    float depth = 1;            // m along z, 1e-4..1e5
    glm::mat4 transform{1.f};   // world from grid; affine. Rest lengths are the grid's, not the transformed ones
    glm::vec3 velocity{0.f};    // m/s, -1e4..1e4 along each axis, of every vertex at the start
    ClothMaterial material{};
    Integrator integrator = Integrator::rk4;
    std::vector<uint32_t> held{};        // vertices that do not move (inverse mass 0)
    std::vector<float> inverse_masses{}; // 1/kg, 0..1e9, one per vertex, in place of the material's; 0 holds
    uint32_t layers = 1;                 // bits; it meets the colliders that have one of them
};

// A cloth of any triangles: open or closed, in one piece or several, vertices and their order kept. Triangles without
// area have no springs; vertices without a triangle are held; across an edge of three or more triangles each pair of
// them bends. mesh_report tells of all of these.
//
// The warp of a Fabric runs in each triangle where the first texture coordinate grows and the second does not; the weft
// is at right angles to it. Their scale does not matter. Where there are none, or a triangle's have no area, those
// apply that are given for an empty list: a flat mesh in x and z has its warp along x, like a GridCloth. Both turn with
// the transform.
//
// The stiffest springs and folds set the substeps of the whole cloth (Solver::stable_substeps), and slivers have ones
// beyond all measure: a triangle 3 cm long and 10 um high asks for a million. So a few may not. A triangle that is more
// than 8 times as stiff against the mass it moves as 99 % of all are, or all but 12 of 240 and more, or 95 % of 60 and
// more, is softened to the stiffest of the others; folds and springs across edges, which grow faster as triangles
// shrink, where it is 64 times. Masses and all else stay, forces between vertices stay equal and opposite. Nothing is
// softened in meshes whose triangles are much alike, whose sizes pass into each other, or that have fewer than 60
// triangles. Springs of a Material, which are all alike, never are.
struct MeshCloth
{
    std::string name = "cloth";
    std::span<const glm::vec3> positions{};           // m, in the mesh's space
    std::span<const glm::uvec3> triangles{};          // indices into positions, counter-clockwise seen from outside
    std::span<const glm::vec2> texture_coordinates{}; // m of fabric, -1e6..1e6, one a position. Empty: the mesh seen
                                                      // along that of its own axes along which it is thinnest
    glm::mat4 transform{1.f};                         // world from mesh; affine. The shape at rest is what it makes
    glm::vec3 velocity{0.f};                          // m/s, -1e4..1e4 along each axis, of every vertex at the start
    ClothMaterial material{};
    Integrator integrator = Integrator::rk4;
    std::vector<uint32_t> held{};
    std::vector<float> inverse_masses{};
    uint32_t layers = 1;
};

// What a mesh is like as a cloth.
struct MeshReport
{
    uint32_t components = 0;           // pieces that hang together by edges
    uint32_t boundary_edges = 0;       // with one triangle; 0: closed
    uint32_t non_manifold_edges = 0;   // with three triangles or more
    uint32_t isolated_vertices = 0;    // without a triangle that has area
    uint32_t degenerate_triangles = 0; // without area
    uint32_t coincident_vertices = 0;  // at the place of an earlier one, and not joined to it: a seam that is open
    uint32_t softened_edges = 0;       // of slivers, with springs or folds softer than the material's
    float shortest_edge = 0;           // m; the number of substeps follows from the smallest triangles
};

struct Friction
{
    float static_coefficient = 0;  // kinetic_coefficient..100
    float kinetic_coefficient = 0; // 0..100
};

// Friction of a pair is the geometric mean of the fabric's and the collider's; a collider without takes the fabric's.

// To which side a mesh pushes.
enum class Sidedness
{
    automatic, // a closed mesh outwards, also what begins inside it; an open one to the side that a vertex comes from
    one_sided, // to where its triangles face, counter-clockwise seen from there
    two_sided, // to the side that a vertex comes from: a box that holds cloth in
};

// Vertices of cloth that are inside a collider at the start of a step come out of it at 0.9 m/s, relative to its
// surface, as long as they are inside, and a step later than they were found; pins stay. Colliders that overlap are one
// solid. Inside is a sphere, a capsule, a box, or a closed mesh which pushes outwards, where its winding number is
// above 0. A sheet goes out to one side, along its normals and together, and leaves at less than 2.5 m/s. One that a
// solid stands through is stretched by that: of 60 random poses the worst was stretched by 21 %, and of those without
// gravity the fastest part reached 2.5 m/s. Meanwhile a vertex's own motion is slowed down to 0.6 m/s, a collider
// carries it along at 0.75 m/s at most, the collider's corners and edges do not hold its cloth back, and no other solid
// stops the vertex. What is under a plane, or nearer to any surface than the thickness at the start of a substep, comes
// up at 0.75 m/s. Whether any is inside is found out after uploads, edits and snapshots, where colliders move, as long
// as any is, and every eighth step. A collider that moves onto cloth pushes it at any speed.

// Corners and edges of colliders that stand between the vertices of a cloth meet its triangles and edges
// (SolverOptions::feature_contact). That holds below some 5 m/s. Faster, no vertex goes through a surface, but edges of
// the cloth may stay through a collider: with 1 mm of thickness and 32 mm between vertices up to 4 on a box of
// triangles and 10 on a BoxCollider, and at 60 m/s a needle stays through the sheet. Meshes that deform have no corners
// and edges; only vertices feel them, and spikes that turn through cloth can tear it along (551 m/s at tips of 23 m/s,
// 35 with corners and edges). Cloth that corners, edges, thin spheres and capsules bear between its vertices is held by
// static friction less exactly than by its vertices: it may slip from 0.8 of it on, and creeps by less than 0.3 mm/s.
// Finer cloth, which touches with its vertices, does neither.

// Cloth at rest is at rest where its vertices touch. What hangs free swings on for long: the hem of coarse wool on a
// box at some 50 mm/s after 10 s.

// Colliders cost where cloth is near them: with more than 8, it is looked up every 16 substeps which are near which
// part of a cloth. Planes are near everywhere.

// A triangle mesh. It is closed if every edge is shared by two triangles that agree on it. One open part makes all of
// it open, and nothing of it is turned. Of a closed one, each part that hangs together by vertices is turned if it is
// inside-out, and what lies in it with it. Only cavities stay as they are, which are inside-out in the solid of another
// part: a hollow ball stays hollow. A part lies in another if the vertices that reach farthest along the world's axes
// do. All this is found out when the mesh is added, and holds as it deforms.
//
// All mesh colliders of a solver together can have 67,108,864 triangles, those that deform half as many. The hierarchy
// over the triangles of one that keeps its shape is built when it is added, by one thread a core; 2
// million triangles took 0.7 s on two cores (bench/NOTES.md). It is kept for when the same mesh is added again, to any
// solver: set_hierarchy_cache_limit.
struct MeshCollider
{
    std::string name = "mesh";
    std::span<const glm::vec3> positions{};  // m, in the mesh's space
    std::span<const glm::uvec3> triangles{}; // indices into positions; triangles without area are dropped
    glm::mat4 transform{1.f};                // world from mesh; affine
    std::optional<Friction> friction{};
    Sidedness sidedness = Sidedness::automatic;
    bool deforms = false; // its vertices move: Solver::deform_collider. Its hierarchy is refitted on the GPU, and costs
                          // more to traverse than that of a mesh that keeps its shape
    uint32_t layers = 1;  // bits; it meets the cloths that have one of them
};

// The hierarchies of the mesh colliders that were added last are kept for all solvers of the process: up to this many
// bytes together, about 85 a triangle; those used longest ago go first. A mesh is the same if its triangles, in the
// world's axes and seen from its middle, are, to the bit. 0 keeps none and frees what there is. From any thread, at any
// time.
constexpr uint64_t k_default_hierarchy_cache_limit = uint64_t{256} << 20;
void set_hierarchy_cache_limit(uint64_t bytes);

// Everything below the plane is solid.
struct PlaneCollider
{
    std::string name = "plane";
    glm::vec3 normal{0, 1, 0}; // unit length
    float offset = 0;          // m, -1e6..1e6; normal . x = offset on the plane. An inclined one is as precise at a
                               // cloth as at the origin if the cloth is near the middle of those that it meets, where
                               // they started
    std::optional<Friction> friction{};
    uint32_t layers = 1;
};

struct SphereCollider
{
    std::string name = "sphere";
    glm::vec3 center{0.f}; // m
    float radius = 1;      // m, 1e-4..2e6
    std::optional<Friction> friction{};
    uint32_t layers = 1;
};

// Everything within `radius` of the segment between both ends.
struct CapsuleCollider
{
    std::string name = "capsule";
    glm::vec3 from{0.f}; // m
    glm::vec3 to{0, 1, 0};
    float radius = 0.5f; // m, 1e-4..2e6
    std::optional<Friction> friction{};
    uint32_t layers = 1;
};

struct BoxCollider
{
    std::string name = "box";
    glm::vec3 min{-0.5f}; // m, in the box's space, -1e6..1e6; each at least 1e-4 below max's
    glm::vec3 max{0.5f};
    glm::mat4 transform{1.f}; // world from box; rigid
    std::optional<Friction> friction{};
    uint32_t layers = 1;
};

using Collider = std::variant<MeshCollider, PlaneCollider, SphereCollider, CapsuleCollider, BoxCollider>;

// A box along the axes of the space that it is told in.
struct BoundingBox
{
    glm::vec3 min{0.f}; // m
    glm::vec3 max{0.f};
};

} // namespace voile
