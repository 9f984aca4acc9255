// Solver: cloths and colliders on the GPU, advanced by dispatches recorded into the host's command buffer.
//
//   auto solver = Solver::create(handles, {});           // borrowed handles, see requirements()
//   auto sheet  = solver->add_cloth({...});              // copied and validated
//   auto ball   = solver->add_collider(SphereCollider{...});
//   auto upload = solver->record_upload(cmd);            // keep until cmd has completed
//   each frame:   if (auto r = solver->record(cmd, {.duration = 1.f / 60}); !r) ...  // r.error().message
//                 draw solver->vertices(*sheet)           // the same buffers that were written
//
// The host draws from the buffers of VertexStreams: positions, velocities, normals. docs/buffers.md lists all buffers
// and which kernels write and read them.
//
// docs/integration.md is the contract: threads, lifetimes, queues, scopes, memory. In short:
// - one thread at a time uses a solver; different solvers are independent of each other;
// - the solver submits nothing and waits for nothing. Destroy a Solver, an Upload or a Snapshot, or assign to it, when
//   no command buffer that it recorded into, or that uses it, is pending. Uploads and Snapshots may outlive the Solver;
//   the handles outlive all of them;
// - a Solver, an Upload or a Snapshot that was moved from may only be destroyed or assigned to.
#pragma once

#include "voile/attachments.hpp"
#include "voile/descriptions.hpp"
#include "voile/export.hpp"
#include "voile/handles.hpp"
#include "voile/jobs.hpp"
#include "voile/statistics.hpp"

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace voile
{

namespace gpu // <voile/gpu/...>: only for hosts that use these, too
{
struct Context;
class Recorder;
class Timestamps;
} // namespace gpu

// What the host must switch on when it makes its device, and what this must have. Everything else is within the limits
// that Vulkan guarantees, with the default options.
struct Requirements
{
    uint32_t api_version = 0;                   // VK_API_VERSION_1_2
    std::vector<const char*> device_extensions; // VK_KHR_synchronization2
    bool synchronization2 = true;               // VkPhysicalDeviceSynchronization2FeaturesKHR
    uint32_t storage_buffers = 0;               // maxPerStageDescriptorStorageBuffers, at least
};
VOILE_API Requirements requirements();

// How contact finds the surface of a mesh within the thickness.
enum class ContactMethod
{
    normal_ray,    // a ray along the vertex normal and its opposite, the nearest hit
    nearest_point, // the nearest point of the mesh
};

// How the lists of mesh vertices lie in memory.
enum class MeshLayout
{
    compact,     // the list of one vertex after the other
    interleaved, // the lists of a workgroup's vertices entry by entry, so that its reads coalesce
};

// Knobs of the implementation, for measurements and comparisons. The defaults need never be touched.
struct Tuning
{
    // Invocations per workgroup. A power of two, from 1 to what the device's invocations and shared memory allow: 48
    // bytes per invocation. A dispatch has at most maxComputeWorkGroupCount workgroups.
    uint32_t workgroup_size = 128;

    // Invocations per vertex that share its triangles in feature contact. A power of two up to workgroup_size. 0:
    // eight, on CPU devices one.
    uint32_t feature_threads = 0;

    ContactMethod contact_method = ContactMethod::nearest_point;
    MeshLayout mesh_layout = MeshLayout::interleaved;
};

// Stages and accesses as in VkMemoryBarrier2.
struct Scope
{
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 accesses = 0;
};

// What the host's own commands do with the vertex streams. Compute shaders and transfers need not be named. A member
// of 0 names nothing.
struct HostScopes
{
    Scope before; // what must be done before the solver writes: stages that read; accesses only of what writes
    Scope after;  // what sees what the solver has written
};

struct SolverOptions
{
    uint32_t statistics_slots = 2; // frames in flight whose statistics can be waited for, 1..16
    bool feature_contact = true;   // corners and edges of colliders meet the triangles and edges of cloths, at moderate
                                 // speed (see descriptions.hpp). Where vertices alone do not feel one, a substep has a
                                 // pass more
    bool depenetration = true; // what is inside a collider at the start of a step is brought out along a smooth field;
                               // without, straight to the nearest surface, and out of meshes not at all
    // None: vertex input reads the streams. A queue without graphics has no vertex input: there give the host's own
    // stages on that queue, or HostScopes{}, and let semaphores order other queues.
    std::optional<HostScopes> host_scopes{};
    // Destroying a Solver or an Upload while the GPU executes its commands ends the program with a line on stderr.
    // None: on if the module was compiled without NDEBUG.
    std::optional<bool> lifetime_checks{};
    Tuning tuning{};
    Jobs jobs{}; // the host's job system, for add_cloth, add_collider and record_upload (voile/jobs.hpp)
};

// One call of record. Everything must be finite and in the range given; vectors, each component (voile/ranges.hpp).
struct Step
{
    float duration = 1.f / 60;    // s, 1e-6..10
    uint32_t substeps = 0;        // of every cloth, 0..1000000; 0: each cloth takes as many as it needs, see Stability
    uint32_t max_substeps = 2000; // of those, 1..1000000; a cloth for which they are too few is softened
    // A budget: the sum over all cloths of vertices times substeps. What exceeds it is taken from the substeps of all
    // cloths by the same fraction; Solver::stability reports what that costs in stiffness. 0: no budget. At least one
    // substep per cloth is taken.
    uint64_t max_vertex_substeps = 0;
    Vec3 gravity{0, -9.81f, 0}; // m/s^2, -1e4..1e4
    Vec3 wind{0.f};             // m/s, -1e3..1e3
    float gust = 0;             // root mean square of the gusts as a share of the wind's speed, 0..10
    float gust_length = 4;      // m, 0.01..1e6: the wavelength of the longest gusts; the shortest are an eighth of it
    double time = 0;            // s, -1e9..1e9, at the step's start; the gusts depend on it and the position alone
    float air_density = 1.225f; // kg/m^3, 0..1e5
};

// Errors: a member out of its range, with its name and value.
VOILE_API Result<void> validate(const Step& step);

// Vertices in a buffer of the host's, three floats each. It needs TRANSFER_SRC usage.
struct DeviceVertices
{
    VkBuffer buffer{};
    VkDeviceSize offset = 0; // bytes, of the first vertex; a multiple of 4
    uint32_t stride = 12;    // bytes from one vertex to the next: 12 to 64, a multiple of 4
};

// What the substeps of a step are for a cloth beside those that the solver has now.
struct Stability
{
    uint32_t needed = 0;       // substeps that bear all of its stiffness and damping
    uint32_t used = 0;         // substeps that it takes: at least as many, unless a maximum or the budget are smaller
    float stiffness_scale = 1; // of its stiffness that it has in this step, 0..1
    float damping_scale = 1;   // likewise
    float load = 0; // fraction of what the integrator bears that the step takes up, 0..0.95; 1 would be its bound
};

// Staging memory and the buffers that an upload replaced. Destroy it, or assign another one to it, once the command
// buffer has completed; one that was never submitted may go at any time. It may outlive the solver. A
// default-constructed one holds nothing.
class VOILE_API Upload
{
public:
    Upload();
    ~Upload();
    Upload(Upload&&) noexcept;
    Upload& operator=(Upload&&) noexcept;

private:
    friend class Solver;
    struct Contents;
    std::unique_ptr<Contents> contents_;
};

// The state of all cloths at one time: positions, velocities, normals. Copied on the GPU by record_save and
// record_restore, in memory that the host sees, so that it can be kept in a file. Destroy it once the command buffers
// that use it have completed. It may outlive the solver.
class VOILE_API Snapshot
{
public:
    ~Snapshot();
    Snapshot(Snapshot&&) noexcept;
    Snapshot& operator=(Snapshot&&) noexcept;

    // What record_save copied, once its command buffer has completed.
    [[nodiscard]] std::span<const std::byte> bytes() const;
    // Takes what bytes() of another one gave. Errors: another number of bytes; a vertex that is not finite.
    Result<void> assign(std::span<const std::byte> bytes);

private:
    friend class Solver;
    struct Contents;
    explicit Snapshot(std::unique_ptr<Contents> contents);
    std::unique_ptr<Contents> contents_;
};

// Where a cloth's vertices lie in the solver's buffers. Valid until the next record_upload. Null handles and 0 vertices
// for a cloth that is not uploaded yet or does not exist.
struct VertexStreams
{
    VkBuffer positions{};  // vec4: x y z (m) and inverse mass (1/kg)
    VkBuffer velocities{}; // vec4: x y z (m/s); w: 1 if the vertex touches a collider, plus 2 if a tether, a
                           // max-distance constraint or a backstop limits it, plus 4 if a triangle or an edge around it
                           // touched a feature of a collider
    VkBuffer normals{};    // vec4: unit normal and 0
    VkDeviceSize offset = 0; // bytes, of the first vertex, in each of them
    uint32_t vertices = 0;
};

class VOILE_API Solver
{
public:
    // Compiles the kernels. Errors: null handles, a device without the functions or the limits that requirements()
    // lists, options out of range or beyond what the device allows, out of memory. Which version the instance was made
    // for and which features are switched on, no handle says: validation reports it where they are missing.
    static Result<Solver> create(const Handles& handles, const SolverOptions& options);
    ~Solver();
    Solver(Solver&&) noexcept;
    Solver& operator=(Solver&&) noexcept;

    // Copy and validate; nothing changes on the GPU before record_upload. Errors name the input and the value: a grid
    // smaller than 2 x 2, a mesh whose triangles have no area, a material out of range, a pinned vertex that does not
    // exist, a position or velocity out of range (voile/ranges.hpp), an index beyond the positions, more than the
    // device's buffers hold or its dispatches take.
    Result<ClothId> add_cloth(const GridCloth& grid);
    Result<ClothId> add_cloth(const MeshCloth& mesh);
    Result<ColliderId> add_collider(const Collider& collider);

    // Remove what was added, at any time. The next record simulates without it, and without an upload; the place that
    // it leaves in the buffers is used again. Its id stays invalid, also when a later addition gets its index. Command
    // buffers that are pending and read its vertices are not disturbed before the next record_upload. With an anchor go
    // the attachments to it, and with a collider the attachments on its surface: their vertices are free, and tethers
    // to them end. Errors: an id that is not valid.
    Result<void> remove(ClothId cloth);
    Result<void> remove(ColliderId collider);
    Result<void> remove(AnchorId anchor);

    // A disabled cloth stays as it is: no pass runs over it, it takes no part in stable_substeps or statistics, and it
    // can still be drawn. It continues with the velocities that it had. A disabled collider meets no cloth. What moved
    // meanwhile is where it is when it is enabled again. Everything is enabled when it is added. Errors: an id that is
    // not valid.
    Result<void> set_enabled(ClothId cloth, bool enabled);
    Result<void> set_enabled(ColliderId collider, bool enabled);
    [[nodiscard]] bool enabled(ClothId cloth) const; // false for an id that is not valid
    [[nodiscard]] bool enabled(ColliderId collider) const;

    // Every function below that takes an id and returns a Result has one more error: an id that is not valid. Those
    // that answer without a Result say so with an empty answer: no attachments, no boxes, no triangles, an empty name,
    // a default material, null handles, zeros. References that they return hold until the solver changes.

    // Changes of what is there already. They take effect with the next record, without new buffers; those of a cloth or
    // a collider that is not uploaded yet with the first record after that. Errors leave everything as it was.

    // Errors: a value out of range; a Fabric where the cloth was added with a Material or the other way round;
    // isometric bending of a mesh that was added without. With a new density a cloth keeps its momentum where it
    // becomes heavier, its velocity where it becomes lighter. Which corners and edges of colliders count follows a new
    // thickness with the next upload.
    Result<void> set_material(ClothId cloth, const ClothMaterial& material);
    [[nodiscard]] const ClothMaterial& material(ClothId cloth) const;

    // Replaces all attachments of the cloth, also the pins of its description. Vertices that are no longer attached are
    // free. Tethers follow. Errors: a vertex that does not exist or has two attachments, a value out of range, an
    // anchor that does not exist, tethers that are left without a pin. More attachments than ever before need an upload
    // (needs_upload).
    Result<void> set_attachments(ClothId cloth, std::span<const Attachment> attachments);
    Result<void> set_attachments(ClothId cloth, std::initializer_list<Attachment> attachments);
    [[nodiscard]] const std::vector<Attachment>& attachments(ClothId cloth) const;
    // A pin for each vertex of the cloth that starts within `distance` (m) of the collider's surface. It pins the
    // vertex to the nearest point of that surface and moves with the collider. Errors: no vertex is that near.
    [[nodiscard]] Result<std::vector<Attachment>> attachments_on_surface(ClothId cloth, ColliderId collider,
                                                                         float distance);

    // Tethers from the present pins; none: takes them away. Errors: no pin, a stretch out of range. More than ever
    // before need an upload.
    Result<void> set_tethers(ClothId cloth, const std::optional<Tethers>& tethers);

    // Which colliders a cloth meets: those whose layers share a bit with its own. Where these have corners and edges
    // that only now count, they do from the next upload on (needs_upload).
    Result<void> set_layers(ClothId cloth, uint32_t layers);
    Result<void> set_layers(ColliderId collider, uint32_t layers);

    // Friction of the collider's own; none: the cloth's. Errors: a coefficient out of range.
    Result<void> set_friction(ColliderId collider, const std::optional<Friction>& friction);
    // m, of a sphere or a capsule, at once: what is inside of it then is brought out like any vertex that starts
    // inside. Errors: another kind of collider, a radius out of range.
    Result<void> set_radius(ColliderId collider, float radius);

    // A frame for attachments. Errors: a transform that is not affine, an axis with an entry beyond 1e3, an origin
    // beyond 1e6 m, a volume below 1e-9 of the unit cube's.
    Result<AnchorId> add_anchor(const Mat4& world_from_anchor);
    // Where the anchor is at the end of the next step; its attachments go there along straight lines.
    Result<void> move_anchor(AnchorId anchor, const Mat4& world_from_anchor);

    // Where a collider is at the end of the next step: moved and turned by `motion` from where it was added. It goes
    // there evenly, turning the shorter way; cloth feels its surface's velocity, which jumps from step to step where it
    // changes: cloth on ground that accelerates slips a little in each jump. On ground that moves evenly static
    // friction holds as on ground at rest up to 0.5 m/s, within 5 % up to 4 m/s. Costs no refit. Errors: a motion that
    // is not finite or not rigid, or takes its center beyond 1e6 m.
    Result<void> move_collider(ColliderId collider, const Mat4& motion);

    // Where the vertices of a deforming mesh are at the end of the next step, in the mesh's space; they go there
    // straight. The step refits the hierarchy, and cloth feels the surface's velocity. Errors: a collider that does not
    // deform, another number of vertices than it was added with, a position that is not finite or beyond 1e6 m in the
    // world.
    Result<void> deform_collider(ColliderId collider, std::span<const Vec3> positions);
    // The same from a buffer that the GPU has written, as by the host's skinning: the next record copies from it, and
    // waits for compute and transfer writes recorded before. A vertex that is not finite or in range stays where it
    // was. Errors: a collider that does not deform, no buffer, an offset or stride out of range.
    Result<void> deform_collider(ColliderId collider, const DeviceVertices& vertices);

    // The boxes of a mesh collider's hierarchy at a level, where it was added: 0 has one around the whole mesh, each
    // further one their halves; a leaf stands for itself at all levels below it. For looking at. Empty for a collider
    // without a mesh, and for one that deforms, whose boxes are on the GPU alone.
    [[nodiscard]] std::vector<BoundingBox> hierarchy_boxes(ColliderId collider, uint32_t level) const;

    // Back to the start: positions, velocities, masses. Attachments stay as they are.
    Result<void> reset(ClothId cloth);
    // Moves a cloth at once: positions by the transform, velocities by its axes. Pins that have a position go back to
    // it. What this takes beyond 1e6 m or 1e4 m/s along an axis stays there. Errors: a transform that is not affine, an
    // axis with an entry beyond 1e3, a translation beyond 2e6 m.
    Result<void> teleport(ClothId cloth, const Mat4& transform);
    // m/s, of every vertex. Errors: beyond 1e4 along an axis.
    Result<void> set_velocity(ClothId cloth, const Vec3& velocity);

    // True if something was added since the last upload, or what was set needs larger buffers.
    [[nodiscard]] bool needs_upload() const;

    // Records the upload of what is new. What does not fit the buffers gets larger ones, by half at least, into which
    // the former contents are copied on the GPU; what fits costs as much as it is large, whatever else the solver has.
    // Begins and ends like record. Errors: out of device memory, larger than the device's buffers; the solver then
    // stays as it was.
    Result<Upload> record_upload(VkCommandBuffer cmd);

    // Records the passes of one step. Never allocates, submits, waits or reads a clock. Outside rendering.
    // Begins: earlier reads of the vertex streams by vertex input, and transfers, are waited for here; earlier uploads
    // too. Ends: writes are visible to vertex input, compute and transfer reads that follow. Nothing is recorded before
    // the first record_upload, or without cloths. While an upload is due, everything that is uploaded goes on: motions
    // of anchors and colliders, and changes, as above.
    // Errors: a member of the step out of its range. Nothing is recorded then, and what waits for the next step waits
    // on.
    Result<void> record(VkCommandBuffer cmd, const Step& step, gpu::Timestamps* timestamps = nullptr);
    Result<void> record(gpu::Recorder& recorder, const Step& step);

    // The state of all cloths, saved and brought back to the bit: the same steps then give the same bits as after
    // saving. Materials, attachments, anchors and colliders are the host's and are not part of it. Errors: nothing
    // uploaded yet, out of memory; cloths were uploaded or removed since; nothing saved to restore.
    [[nodiscard]] Result<Snapshot> create_snapshot() const;
    Result<void> record_save(VkCommandBuffer cmd, const Snapshot& snapshot) const;
    Result<void> record_restore(VkCommandBuffer cmd, const Snapshot& snapshot);

    // Records the reduction of the statistics into `slot`, to be read once the submission has completed, also after
    // uploads. Nothing is recorded before the first record_upload. Errors: a slot that does not exist.
    Result<void> record_statistics(VkCommandBuffer cmd, uint32_t slot, gpu::Timestamps* timestamps = nullptr) const;
    // All 0 for a slot that nothing was recorded into, or that does not exist.
    [[nodiscard]] Statistics statistics(uint32_t slot) const;

    // The substeps with which every enabled cloth is stable at its full stiffness, with a margin of 5 %, the largest
    // number that one of them needs; at most max_substeps. 0 for a duration that record refuses. From bounds of the
    // spectra of M^-1 K and M^-1 C that hold in every shape of the cloth, crumpled and stretched: RK4 takes omega h
    // <= 2.6, velocity Verlet omega h <= 2, less with damping. Where springs of one direction carry nearly all, Verlet
    // takes up to 16 % more substeps, or it would heat up.
    [[nodiscard]] uint32_t stable_substeps(float duration, uint32_t max_substeps = Step{}.max_substeps) const;
    // Cloths that need fewer substeps than others take fewer: a half, a quarter ... down to a sixteenth of the largest
    // number, where that saves time. Each group of cloths that take the same number has dispatches of its own, so that
    // on a large GPU only large cloths are worth a group. needed and used are 0 for a step that record refuses.
    [[nodiscard]] Stability stability(ClothId cloth, const Step& step) const;

    [[nodiscard]] VertexStreams vertices(ClothId cloth) const;
    // Triangles of a cloth as the normals see them, indices within the cloth; a grid's counter-clockwise seen from +y
    // when flat, a mesh's as they were given.
    [[nodiscard]] std::vector<UVec3> triangles(ClothId cloth) const;
    // One a vertex, meters of fabric: a grid's from its first vertex, a mesh's as they were given.
    [[nodiscard]] std::vector<Vec2> texture_coordinates(ClothId cloth) const;
    [[nodiscard]] const std::string& name(ClothId cloth) const;
    // What a mesh is like as a cloth; all 0 for a grid.
    [[nodiscard]] MeshReport mesh_report(ClothId cloth) const;

    [[nodiscard]] const gpu::Context& context() const;
    [[nodiscard]] uint32_t vertex_count() const;   // of all cloths
    [[nodiscard]] uint32_t triangle_count() const; // of all cloths
    // That record makes; 0 for a step that it refuses. A few more follow an upload, and what is changed, moved or
    // deformed.
    [[nodiscard]] uint32_t dispatches(const Step& step) const;

    struct State; // of the implementation

private:
    explicit Solver(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

} // namespace voile
