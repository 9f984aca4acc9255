// Solver: cloths and colliders on the GPU, advanced by dispatches recorded into the host's command buffer.
//
//   auto solver = Solver::create(handles, {});           // borrowed handles, see requirements()
//   auto sheet  = solver->add_cloth({...});              // copied and validated
//   auto ball   = solver->add_collider(SphereCollider{...});
//   auto upload = solver->record_upload(cmd);            // keep until cmd has completed
//   each frame:   if (auto r = solver->record(cmd, {.duration = 1.f / 60}); !r) ...  // r.error().message
//                 draw solver->vertices(*sheet)           // the same buffers that were written
//
// The host draws from the buffers of VertexStreams, or from its own after record_outputs (voile/output.hpp).
// docs/buffers.md lists all buffers and which kernels write and read them.
//
// docs/integration.md is the contract: threads, lifetimes, queues, scopes, memory. In short:
// - one thread at a time uses a solver; different solvers are independent of each other;
// - the solver submits nothing and waits for nothing. Destroy a Solver, an Upload or a Snapshot, or assign to it, only
//   when no command buffer that it recorded into, or that uses it, is pending. Uploads and Snapshots may outlive the
//   Solver; the handles outlive all of them;
// - a moved-from Solver, Upload or Snapshot may only be destroyed or assigned to.
#pragma once

#include "voile/attachments.hpp"
#include "voile/descriptions.hpp"
#include "voile/export.hpp"
#include "voile/handles.hpp"
#include "voile/output.hpp"
#include "voile/solver_options.hpp"
#include "voile/statistics.hpp"
#include "voile/step.hpp"

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace voile
{

namespace gpu // <voile/gpu/...>: only for hosts that also use these
{
struct Context;
class Recorder;
class Timestamps;
} // namespace gpu

// What the host must enable when it creates its device, and what the device must have. With the default options, all
// other needs are within the limits that Vulkan guarantees.
struct Requirements
{
    uint32_t api_version = 0;                   // VK_API_VERSION_1_2
    std::vector<const char*> device_extensions; // VK_KHR_synchronization2
    bool synchronization2 = true;               // VkPhysicalDeviceSynchronization2FeaturesKHR
    uint32_t storage_buffers = 0;               // least maxPerStageDescriptorStorageBuffers
};
VOILE_API Requirements requirements();

// Vertices in a buffer of the host, three floats each. The buffer needs TRANSFER_SRC usage.
struct DeviceVertices
{
    VkBuffer buffer{};
    VkDeviceSize offset = 0; // bytes, of the first vertex; a multiple of 4
    uint32_t stride = 12;    // bytes from one vertex to the next: 12 to 64, a multiple of 4
};

// Staging memory and the buffers that an upload replaced. Destroy it, or assign another one to it, once the command
// buffer has completed, or at any time if it was never submitted. It may outlive the solver. A default-constructed one
// holds nothing.
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

// A copy of the state of all cloths: positions, velocities, normals. record_save and record_restore copy it on the GPU.
// Its memory is visible to the host, so it can be written to a file. Destroy it once the command buffers that use it
// have completed. It may outlive the solver.
class VOILE_API Snapshot
{
public:
    ~Snapshot();
    Snapshot(Snapshot&&) noexcept;
    Snapshot& operator=(Snapshot&&) noexcept;

    // What record_save copied, once its command buffer has completed.
    [[nodiscard]] std::span<const std::byte> bytes() const;
    // Takes the bytes() of another snapshot of cloths with as many vertices. It cannot check whether they are the same
    // cloths. Errors: a different number of bytes; a position or velocity that is not finite.
    Result<void> assign(std::span<const std::byte> bytes);

private:
    friend class Solver;
    struct Contents;
    explicit Snapshot(std::unique_ptr<Contents> contents);
    std::unique_ptr<Contents> contents_;
};

// The last call of Solver::record.
struct RecordReport
{
    uint32_t commands = 0; // Vulkan commands that it recorded, without labels, timestamps and lifetime checks
    bool reused = false;   // it executed the commands of an earlier step (SolverOptions::command_reuse)
};

class VOILE_API Solver
{
public:
    // Compiles the kernels, on several threads (voile/jobs.hpp): seconds the first time, half a second once the
    // driver's cache has them (docs/performance.md). Errors: null handles, a device without the functions or the limits
    // that requirements() lists, options out of range or beyond the device's limits, out of memory. The version of the
    // instance and the enabled features cannot be read from a handle; validation reports missing ones.
    static Result<Solver> create(const Handles& handles, const SolverOptions& options);
    ~Solver();
    Solver(Solver&&) noexcept;
    Solver& operator=(Solver&&) noexcept;

    // Copy and validate the description. The GPU gets it with the next record_upload. Errors name the input and the
    // value: a grid smaller than 2 x 2, a mesh whose triangles have no area, a material out of range, a pinned vertex
    // that does not exist, a position or velocity out of range (voile/ranges.hpp), an index beyond the positions, more
    // than the device's buffers or dispatches can hold.
    Result<ClothId> add_cloth(const GridCloth& grid);
    Result<ClothId> add_cloth(const MeshCloth& mesh);
    // Contacts of a vertex with several colliders are resolved in the order of the indices of their ids. A new collider
    // takes the smallest free index.
    Result<ColliderId> add_collider(const Collider& collider);

    // Remove a cloth, a collider or an anchor at any time. It takes no part from the next record on; no upload is
    // needed. Later additions reuse its range of the buffers. Its id stays invalid, even if a later addition gets the
    // same index. Pending command buffers can read its vertices until the next record_upload. Removing an anchor also
    // removes the attachments to it. Removing a collider also removes the attachments on its surface. Their vertices
    // become free, and tethers to them end. Removing a cloth removes its outputs. Errors: an id that is not valid.
    Result<void> remove(ClothId cloth);
    Result<void> remove(ColliderId collider);
    Result<void> remove(AnchorId anchor);

    // An output copies a cloth's vertices into a vertex buffer of the host's, in the host's layout. It lasts until it
    // or its cloth is removed; uploads do not change it. The buffer must exist until the last command buffer that
    // writes it has completed. Errors: an id that is not valid, a null buffer, nothing to write, a stride or an offset
    // that is not a multiple of 4, a stride of 0, an attribute that overlaps another or the end of the vertex, previous
    // positions that the solver does not keep, vertices beyond the end of the buffer or beyond what a shader can bind,
    // out of memory.
    Result<OutputId> add_output(ClothId cloth, const VertexLayout& layout);
    // Removes an output. Call it when no command buffer that writes the output is pending. Errors: an id that is not
    // valid.
    Result<void> remove(OutputId output);

    // A disabled cloth keeps its state: no pass runs over it, and stable_substeps, budgets and statistics leave it out.
    // It can still be drawn. When it is enabled again, it continues with its former velocities. Pins with a position
    // are then at their anchors' new poses; pins without one have not followed (attachments.hpp). set_material, reset,
    // teleport and set_velocity also act on a disabled cloth. A disabled collider collides with no cloth. It can be
    // moved meanwhile and has its new pose when it is enabled again. Cloths and colliders are enabled when they are
    // added. Errors: an id that is not valid.
    Result<void> set_enabled(ClothId cloth, bool enabled);
    Result<void> set_enabled(ColliderId collider, bool enabled);
    [[nodiscard]] bool enabled(ClothId cloth) const; // false for an id that is not valid
    [[nodiscard]] bool enabled(ColliderId collider) const;

    // Every function below that takes an id and returns a Result has one more error: an id that is not valid. Functions
    // without a Result return an empty value for such an id: no attachments, no boxes, no triangles, an empty name, a
    // default material, null handles, zeros. References are valid until the solver changes.

    // Changes. They take effect with the next record, without an upload unless a function says so. Changes of a cloth
    // or a collider that is not uploaded yet take effect with the first record after its upload. After an error nothing
    // has changed.

    // A cloth that becomes heavier keeps its momentum; one that becomes lighter keeps its velocity. After a change of
    // thickness, the next upload selects anew which edges and corners of colliders collide with the cloth. Errors: a
    // value out of range; a Fabric for a cloth that was added with a Material, or the other way round; isometric
    // bending of a mesh that was added without it.
    Result<void> set_material(ClothId cloth, const ClothMaterial& material);
    [[nodiscard]] const ClothMaterial& material(ClothId cloth) const;

    // Replaces all attachments of the cloth, including the pins of its description. Vertices that are no longer
    // attached are free. Tethers are computed again from the new pins; while there are no pins, there are no tethers.
    // Allocates if the solver never had so many attachments. Errors: a vertex that does not exist or has two
    // attachments, a value out of range, an anchor that does not exist, out of memory.
    Result<void> set_attachments(ClothId cloth, std::span<const Attachment> attachments);
    Result<void> set_attachments(ClothId cloth, std::initializer_list<Attachment> attachments);
    [[nodiscard]] const std::vector<Attachment>& attachments(ClothId cloth) const;
    // A pin for each vertex of the cloth that starts within `distance` (m) of the collider's surface. It pins the
    // vertex to the nearest point of that surface and moves with the collider. Errors: no vertex is that near, a mesh
    // that deforms.
    [[nodiscard]] Result<std::vector<Attachment>> attachments_on_surface(ClothId cloth, ColliderId collider,
                                                                         float distance);

    // Tethers vertices to the present pins; none: removes the tethers. Allocates if the solver never had so many.
    // Errors: no pin, a stretch out of range, out of memory.
    Result<void> set_tethers(ClothId cloth, const std::optional<Tethers>& tethers);

    // A cloth collides with the colliders that share a layer (a bit) with it. If a collider collides with a cloth for
    // the first time, its edges and corners collide only from the next upload on (needs_upload).
    Result<void> set_layers(ClothId cloth, uint32_t layers);
    Result<void> set_layers(ColliderId collider, uint32_t layers);

    // Friction of the collider; none: the cloth's. Errors: a coefficient out of range.
    Result<void> set_friction(ColliderId collider, const std::optional<Friction>& friction);
    // m, of a sphere or a capsule. The radius changes at once. Vertices that are then inside leave it by depenetration.
    // Errors: another kind of collider, a radius out of range.
    Result<void> set_radius(ColliderId collider, float radius);

    // A frame for attachments. Allocates if the solver never had so many anchors. Errors: a transform that is not
    // affine, an axis with an entry beyond 1e3, an origin beyond 1e6 m, a volume below 1e-9 of the unit cube's, out of
    // memory.
    Result<AnchorId> add_anchor(const Mat4& world_from_anchor);
    // Sets the anchor's pose at the end of the next step. Its attachments move there along straight lines.
    Result<void> move_anchor(AnchorId anchor, const Mat4& world_from_anchor);

    // Sets the collider's pose at the end of the next step: `motion` applied to the pose at which it was added. It
    // moves there at constant velocity and takes the shorter rotation. Cloth feels the velocity of the surface. That
    // velocity is constant within a step, so cloth on an accelerating collider slips a little at the start of each
    // step. On a collider that moves at constant velocity, static friction holds as on one at rest up to 0.5 m/s, and
    // within 5 % up to 4 m/s. The hierarchy of a mesh does not change. Errors: a motion that is not finite or not
    // rigid, or that takes the center beyond 1e6 m.
    Result<void> move_collider(ColliderId collider, const Mat4& motion);

    // Sets the vertices of a deforming mesh at the end of the next step, in the mesh's space. They move there along
    // straight lines. The step refits the hierarchy, and cloth feels the velocity of the surface. Errors: a collider
    // that does not deform, a different number of vertices from the one that it was added with, a position that is not
    // finite or beyond 1e6 m in the world.
    Result<void> deform_collider(ColliderId collider, std::span<const Vec3> positions);
    // The same from a buffer on the GPU, such as the output of the host's skinning. The next record copies from it, and
    // waits for compute and transfer writes that were recorded before. A vertex that is not finite or out of range
    // keeps its position. Errors: a collider that does not deform, no buffer, an offset or stride out of range.
    Result<void> deform_collider(ColliderId collider, const DeviceVertices& vertices);

    // The boxes of a mesh collider's hierarchy at a level, at the pose at which it was added, for debug views. Level 0
    // is one box around the whole mesh; each further level has the children of the boxes of the level before. A leaf
    // appears at all levels below its own. Empty for a collider without a mesh, and for one that deforms: its boxes are
    // on the GPU only.
    [[nodiscard]] std::vector<BoundingBox> hierarchy_boxes(ColliderId collider, uint32_t level) const;

    // Resets positions, velocities and masses to those at the start. Attachments stay.
    Result<void> reset(ClothId cloth);
    // Moves a cloth at once: transforms its positions by the transform and its velocities by the transform's axes. Pins
    // with a position go back to it. Positions are clamped to 1e6 m along each axis, velocities to 1e4 m/s. Errors: a
    // transform that is not affine, an axis with an entry beyond 1e3, a translation beyond 2e6 m.
    Result<void> teleport(ClothId cloth, const Mat4& transform);
    // Moves an anchor or a collider at once, with the arguments and errors of move_anchor and move_collider. It has no
    // velocity there. To teleport a dressed character, teleport its cloths, its anchors and its colliders before one
    // record. move_anchor and move_collider would sweep through the world within a step and drag the cloth along, and
    // so does what is left behind. In one step, teleport comes before a move, which it would undo.
    Result<void> teleport(AnchorId anchor, const Mat4& world_from_anchor);
    Result<void> teleport(ColliderId collider, const Mat4& motion);
    // Sets the velocity of every vertex, m/s. Errors: beyond 1e4 along an axis.
    Result<void> set_velocity(ClothId cloth, const Vec3& velocity);

    // m/s, 0..10; 0: the cloth never sleeps (GridCloth::sleep_speed). Wakes the cloth. Errors: a speed out of range.
    Result<void> set_sleep_speed(ClothId cloth, float speed);
    // Wakes the cloth for the next step, and for 0.5 s at least. Changes that act on the cloth wake it without this
    // call.
    Result<void> wake(ClothId cloth);

    // True if something was added since the last upload, or if a change above needs an upload.
    [[nodiscard]] bool needs_upload() const;

    // Records the upload of what is new. It stages only new data, however much the solver has. A buffer that is too
    // small is replaced by one at least half larger, and the GPU copies its contents. Begins and ends like record.
    // Errors: out of device memory, larger than the device's buffers; the solver then stays as it was.
    Result<Upload> record_upload(VkCommandBuffer cmd);

    // Records the passes of one step, outside of a render pass. Never submits, waits or reads a clock. Allocates only
    // with command_reuse.
    // - Begins with a barrier: waits for earlier reads of the streams by vertex input, for transfers and uploads.
    // - Ends with a barrier: writes are visible to vertex input, compute and transfer reads that follow.
    // - Records nothing before the first record_upload, and only changes and motions while no cloth is enabled.
    // - While an upload is due, simulates everything that is already uploaded, with its motions and changes.
    // Errors: a member of the step out of its range; see CommandReuse. Then nothing is recorded, and changes wait for
    // the next step.
    Result<void> record(VkCommandBuffer cmd, const Step& step, gpu::Timestamps* timestamps = nullptr);
    Result<void> record(gpu::Recorder& recorder, const Step& step);

    // All 0 before the first call of record, and after one that returned an error.
    [[nodiscard]] RecordReport record_report() const;

    // Save and restore the state of all cloths, bit for bit: after restoring, the same steps give the same bits as
    // after saving. They are not those of a run that does not save: what cloths with self_collision remember of the
    // contact before is in no snapshot, so saving forgets it, too. Materials, attachments, anchors and colliders are
    // not part of a snapshot. Masses and pins are those that the solver has when it restores; a vertex that is heavier
    // than it was keeps its momentum, as in set_material. Changes that wait for the next record, such as reset, are
    // made after restoring. Cloths that slept when the snapshot was saved sleep on if nothing that may wake cloths has
    // changed or moved since, and if the bytes are this snapshot's own. Otherwise all cloths wake, and bits differ.
    // Errors: nothing uploaded yet, out of memory; a snapshot of another solver; cloths were uploaded or removed since
    // create_snapshot; nothing saved to restore.
    [[nodiscard]] Result<Snapshot> create_snapshot() const;
    Result<void> record_save(VkCommandBuffer cmd, const Snapshot& snapshot) const;
    Result<void> record_restore(VkCommandBuffer cmd, const Snapshot& snapshot);

    // Records the copies of outputs, one dispatch each, in the order given. Never allocates. Nothing is recorded for a
    // cloth that is not uploaded yet. Begins and ends like record. HostScopes also orders the host's buffers, so the
    // host draws from them without a barrier of its own. Errors: an id that is not valid; nothing is recorded then.
    Result<void> record_outputs(VkCommandBuffer cmd, std::span<const OutputId> outputs,
                                gpu::Timestamps* timestamps = nullptr) const;
    Result<void> record_outputs(VkCommandBuffer cmd, std::initializer_list<OutputId> outputs,
                                gpu::Timestamps* timestamps = nullptr) const;

    // Records the computation of the statistics into `slot`. Read them once the submission has completed; uploads do
    // not disturb them. Nothing is recorded before the first record_upload. Errors: a slot that does not exist.
    Result<void> record_statistics(VkCommandBuffer cmd, uint32_t slot, gpu::Timestamps* timestamps = nullptr) const;
    // The same. On request it also counts intersections (voile/statistics.hpp) and marks their vertices
    // (VertexStreams::intersections), which takes longer than a step. One more error: SolverOptions::intersections is
    // off.
    Result<void> record_statistics(VkCommandBuffer cmd, uint32_t slot, Intersections intersections,
                                   gpu::Timestamps* timestamps = nullptr) const;
    // All 0 for a slot that has no statistics or does not exist.
    [[nodiscard]] Statistics statistics(uint32_t slot) const;

    // The number of substeps with which every enabled cloth is stable at its full stiffness, with a margin of 5 %: the
    // largest number that one of them needs, at most max_substeps. 0 for a duration that record refuses. It follows
    // from bounds on the spectra of M^-1 K and M^-1 C that hold in every shape of the cloth, crumpled or stretched: RK4
    // allows omega h <= 2.6, velocity Verlet omega h <= 2, less with damping. If springs of one direction carry nearly
    // all of the stiffness, Verlet takes up to 16 % more substeps; without them it would gain energy.
    [[nodiscard]] uint32_t stable_substeps(float duration, uint32_t max_substeps = Step{}.max_substeps) const;
    // The substeps of a cloth in a step. Cloths are grouped by the substeps that they need: a group takes the largest
    // number, or a half, a quarter ... a sixteenth of it, if that saves time. Each group has its own dispatches, so on
    // a large GPU a small soft cloth stays in the group of a stiff one. The call takes time in proportion to the number
    // of cloths. needed and used are 0 for a step that record refuses.
    [[nodiscard]] Stability stability(ClothId cloth, const Step& step) const;

    [[nodiscard]] VertexStreams vertices(ClothId cloth) const;
    // Triangles of a cloth, indices within the cloth. Normals are computed from them. Triangles of a grid are
    // counter-clockwise seen from +y when it is flat; those of a mesh are as they were given.
    [[nodiscard]] std::vector<UVec3> triangles(ClothId cloth) const;
    // One per vertex, in meters of fabric: those of a grid from its first vertex, those of a mesh as they were given.
    [[nodiscard]] std::vector<Vec2> texture_coordinates(ClothId cloth) const;
    [[nodiscard]] const std::string& name(ClothId cloth) const;
    // Irregularities of a mesh as a cloth; all 0 for a grid.
    [[nodiscard]] MeshReport mesh_report(ClothId cloth) const;

    [[nodiscard]] const gpu::Context& context() const;
    [[nodiscard]] uint32_t vertex_count() const;   // of all cloths
    [[nodiscard]] uint32_t triangle_count() const; // of all cloths
    // The number of dispatches in a step; 0 for a step that record refuses. Uploads, changes and deforming meshes add a
    // few to the next step.
    [[nodiscard]] uint32_t dispatches(const Step& step) const;

    struct State; // of the implementation

private:
    explicit Solver(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

} // namespace voile
