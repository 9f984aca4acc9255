// Model: the host's copy of everything that was added to a solver, in the layout that is uploaded.
#pragma once

#include "voile/attachments.hpp"
#include "voile/descriptions.hpp"

#include "model/mesh_topology.hpp"
#include "model/range_checks.hpp"
#include "shared/attachment_layout.h"
#include "shared/bvh_layout.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/padded_layout.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace voile
{

struct MeshInput; // colliders/mesh_input.hpp

// A cloth as the solver remembers it: what its record follows from when its material changes.
struct ClothModel
{
    std::string name;
    ClothMaterial material;
    Integrator integrator = Integrator::rk4;
    std::optional<MeshTopology> mesh; // none: a grid
    glm::vec2 spacing{0.f};           // m, of a grid along a row and along a column
    // Masses that were given, as a share of those of the material: the largest inverse one in 1/kg times the vertex's
    // area (fabric) or share (material). 0: all are the material's.
    double own_inverse_mass = 0;
    glm::vec3 velocity{0.f};             // m/s, at the start
    std::vector<Attachment> attachments; // pins and others, in the order given
    std::optional<Tethers> tether_options;
    std::vector<shared::TetherRecord> tethers;
    std::vector<glm::uvec3> triangles;          // of a mesh, as they were given
    std::vector<glm::vec2> texture_coordinates; // of a mesh
};

// A mesh collider whose vertices the host moves.
struct DeformingMesh
{
    uint32_t collider = 0;
    uint32_t vertices = 0;
    uint32_t first_vertex = 0; // in deforming_positions; as many again follow them
    glm::mat4 transform{1.f};  // world from the mesh's space

    [[nodiscard]] uint32_t first(uint32_t half) const { return first_vertex + half * vertices; }
};

// A plane as it was added: normal . x = offset.
struct Plane
{
    uint32_t collider = 0;
    float offset = 0; // m
};

// Bytes from one vertex to the next in what the host gives for a deforming mesh, at most.
constexpr uint32_t k_most_stride = 64;

struct Model
{
    std::vector<ClothModel> cloths;
    std::vector<shared::ClothRecord> records; // one a cloth
    std::vector<glm::vec4> start;             // places; w: inverse of the area or share that the density multiplies
    std::vector<glm::vec4> positions;         // at the start; w: inverse mass, 0 if pinned
    std::vector<glm::uvec2> residuals;        // of the positions at the start (fine_position.glsl)
    std::vector<glm::vec4> velocities;        // at the start
    std::vector<shared::MeshVertex> mesh_vertices; // of all meshes, lists in one piece; see interleave
    std::vector<shared::MeshSpring> mesh_springs;
    std::vector<shared::MeshCorner> mesh_corners;
    std::vector<shared::MembraneCorner> membrane_corners; // one for each of these
    std::vector<glm::mat4> anchors{glm::mat4(1)}; // where they were when they were added; the first is the world
    std::vector<shared::ColliderRecord> colliders;
    std::vector<glm::mat4> placements;    // of the colliders: the world when they were added, of boxes from their space
    std::vector<glm::dvec3> origins;      // of the colliders, m, before their placement: records are told from there
    std::vector<Plane> planes;            // in the order of their colliders
    std::vector<DeformingMesh> deforming; // likewise
    std::vector<glm::vec4> deforming_positions;
    std::vector<shared::PaddedLeaf> padded_leaves;
    uint32_t padded_boxes = 0;
    std::vector<shared::BvhNode> nodes;
    std::vector<shared::BvhTriangle> triangles;
    uint64_t patches = 0; // workgroups over all cloths, see make_patches
    uint32_t workgroup_size = 128;
    uint32_t max_workgroups = std::numeric_limits<uint32_t>::max();   // of each dispatch
    uint64_t max_buffer_bytes = std::numeric_limits<uint64_t>::max(); // of each buffer: what the device binds

    // Append after validating; unchanged on error.
    Result<ClothId> add(const GridCloth& grid);
    Result<ClothId> add(const MeshCloth& cloth);
    Result<ColliderId> add(const MeshCollider& collider);
    Result<ColliderId> add(const PlaneCollider& collider);
    Result<ColliderId> add(const SphereCollider& collider);
    Result<ColliderId> add(const CapsuleCollider& collider);
    Result<ColliderId> add(const BoxCollider& collider);
    ColliderId append(const shared::ColliderRecord& record, const glm::dvec3& origin,
                      const glm::mat4& placement = glm::mat4(1));
    // Puts the origin of a plane where it is nearest to `point`, m, both before its placement.
    void place_plane(const Plane& plane, const glm::dvec3& point);
    ColliderId append_deforming(shared::ColliderRecord record, const MeshInput& mesh, const glm::mat4& transform);
    [[nodiscard]] uint64_t bytes_with_deforming(const MeshInput& mesh) const;
};

// What the validation of cloths and colliders shares.
// Errors: `contents` need a buffer of more bytes than the device binds.
Result<void> check_room(const Model& model, const std::string& what, const std::string& name,
                        const std::string& contents, uint64_t bytes);
// Errors: the transform of the cloth takes one of them out of range.
Result<void> check_places(const std::string& cloth, std::span<const glm::dvec3> world);
// A rotation in floats stretches by some 1e-7, which stiff springs feel. What is that near to a rigid transform is made
// one exactly.
glm::dmat4 without_rounding(const glm::mat4& transform);
Result<void> check_friction(const std::string& name, const std::optional<Friction>& friction);
shared::ColliderRecord make_collider_record(uint32_t kind, uint32_t layers, const std::optional<Friction>& friction);

// Errors: a dispatch of more workgroups than the device takes. `contents` need them.
Result<void> check_dispatch(const Model& model, const std::string& what, const std::string& name,
                            const std::string& contents, uint64_t workgroups);

// What the validation of grids and meshes shares: transform, velocity, material, pinned vertices, inverse masses.
struct ClothInput
{
    const std::string& name;
    const glm::mat4& transform;
    const glm::vec3& velocity;
    const ClothMaterial& material;
    Integrator integrator;
    std::span<const uint32_t> pins;
    std::span<const float> inverse_masses;
};
Result<void> validate(const ClothInput& cloth, uint64_t vertices);

// Areal density of a fabric, kg/m^2, or the mass of a vertex, kg.
double density(const ClothMaterial& material);

// Whether a material bends by the isometric model.
bool bends_isometrically(const ClothMaterial& material);

// The record that follows from a material; places (first_vertex, first_list) and sizes of `record` are kept.
void apply_material(const ClothModel& cloth, shared::ClothRecord& record);

// Appends the start of a cloth whose record is complete: masses from the material unless they are given.
void append_state(Model& model, const ClothInput& cloth, std::span<const glm::dvec3> places, uint32_t index);

// The attachments of all cloths as records, pins first, and the tethers.
struct AttachmentLists
{
    std::vector<shared::AttachmentRecord> attachments;
    uint32_t pins = 0; // the first ones
    std::vector<shared::TetherRecord> tethers;
};
AttachmentLists make_attachment_lists(const Model& model);

// Errors: an anchor that add_anchor did not give.
Result<void> check_anchor(const Model& model, AnchorId anchor);

// Errors: a vertex that does not exist or has two attachments, an anchor that does not exist, values out of range.
Result<void> validate_attachments(const Model& model, uint32_t cloth, std::span<const Attachment> attachments);

// The tethers of a cloth by its present pins. Errors: no pin, a value out of range, no vertex that could be tethered.
Result<std::vector<shared::TetherRecord>> make_tethers(const Model& model, uint32_t cloth, const Tethers& tethers);

// Triangles of a cloth, a grid's cut as Solver::triangles says.
std::vector<glm::uvec3> cloth_triangles(const Model& model, uint32_t cloth);

// The patches that cover all cloths with workgroups of `workgroup_size` vertices, none across two cloths. Those of
// cloths that use RK4 come first.
struct Patches
{
    std::vector<shared::Patch> patches;
    uint32_t rk4 = 0; // how many
};
Patches make_patches(const Model& model, uint32_t workgroup_size);

// How many of them a grid or a mesh has.
uint64_t count_grid_patches(uint32_t columns, uint32_t rows, uint32_t workgroup_size);
uint64_t count_mesh_patches(uint64_t vertices, uint32_t workgroup_size);

// The lists of mesh vertices, those of a workgroup's vertices interleaved: their first entries side by side, then their
// second ones, each list as long as the longest of the workgroup.
struct MeshLists
{
    std::vector<shared::MeshVertex> vertices;
    std::vector<shared::MeshSpring> springs;
    std::vector<shared::MeshCorner> corners;
    std::vector<shared::MembraneCorner> membrane; // one for each of these
};
MeshLists interleave(const Model& model, uint32_t workgroup_size);

} // namespace voile
