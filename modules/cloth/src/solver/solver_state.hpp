// What a Solver and an Upload hold.
#pragma once

#include "voile/solver.hpp"

#include "colliders/collider_motion.hpp"
#include "model/active_lists.hpp"
#include "model/stability.hpp"
#include "model/substep_plan.hpp"
#include "solver/device_state.hpp"
#include "solver/lifetime_check.hpp"
#include "solver/outputs.hpp"
#include "solver/step_commands.hpp"

#include "shared/pair_layout.h"
#include "shared/step_layout.h"

#include <functional>
#include <optional>
#include <set>

namespace voile
{

// Where passes read and write buffers.
inline constexpr VkPipelineStageFlags2KHR k_compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR;
inline constexpr VkAccessFlags2KHR k_storage =
    VK_ACCESS_2_SHADER_READ_BIT_KHR | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR;

// Changes by the host since the last record; the next one records them at its beginning. Changes of cloths and
// colliders that are not uploaded yet wait for their upload.
struct Edits
{
    std::set<uint32_t> records;                // cloths whose record changed
    std::set<uint32_t> limits;                 // cloths that got a strain limit
    std::set<uint32_t> colliders;              // colliders whose record changed, or that were removed
    std::vector<shared::EditPush> state_edits; // in order
    bool softened = false;                     // steps changed softening or strain limits (softening_due, limit_due)
    bool patches = false;
    bool attachments = false; // the lists of attachments and tethers
    bool pins = false;        // they must be set again
    bool masses = false;      // of all cloths: they must be set again
    bool candidates = false;  // lists of near triangles must be cleared
    bool woken = false;       // cloths must be woken (wake_due)

    // Drops the edits of a cloth that was removed.
    void forget(ClothId cloth);
};

// Lists of candidates store the number of a substep modulo this. Before a number repeats, all lists are cleared.
constexpr uint32_t k_substeps_counted = 1u << (32 - VOILE_CANDIDATE_COUNT_BITS);

// Which of the optional passes a step has.
struct Passes
{
    bool moving = false;         // colliders that move or deform
    bool convex = false;         // colliders with a formula, other than planes
    uint32_t features = 0;       // of all colliders
    uint32_t strain_spacing = 0; // the widest level of limit_strain.comp; 0: no cloth has a strain limit
    uint32_t strain_passes = 0;  // on each level
    bool smooths = false;        // a cloth has the strain limit of softened cloth
    bool contact = false;        // the contact pass of each substep
    bool depenetration = false;  // colliders with an inside
    uint32_t colliders = 0;      // slots up to the last active collider's
    bool pairs = false;          // cloths that collide with themselves
    bool sleep = false;          // cloths that may sleep
    float pair_reach = 0;        // m, how far the finest of those may be from where its lists expect it
    float mesh_extent = 0;       // m, the largest of a collider's mesh along an axis from its origin
};

// What accelerates cloths in a step.
struct Forces
{
    Vec3 gravity{0.f};
    Vec3 wind{0.f};
    float gust = 0;
    float gust_length = 0;
    float air_density = 0;

    bool operator==(const Forces&) const = default;
};

// The anchor as the GPU reads it.
shared::AnchorRecord make_record(const Anchor& anchor);

// Steps from one check of all vertices to the next, if none was inside.
constexpr uint32_t k_depenetration_period = 8;

// What pending command buffers may use, and nothing else. The next upload takes it.
struct Replaced
{
    std::vector<DeviceState> buffers;
    std::vector<gpu::BindingPool> sets; // of outputs
};

// The state of the solver from step to step, beside the buffers.
struct StepHistory
{
    bool normals_due = false;        // they do not fit the positions: after an upload, and after cloths were moved
    bool depenetration_due = false;  // vertices may be inside solids, and cloth in cloth: after uploads, edits and
                                     // snapshots
    uint32_t depenetration_step = 0; // counts the steps with depenetration
    uint32_t next_substep = 0;       // counted through all steps, below k_substeps_counted
    uint32_t next_pair_pass = 2;     // counted through all steps
    bool pairs_met = false;          // in the last step, since the last upload
    bool features_listed = false;    // the same

    // What vertices remember from the last pass over pairs does not fit where they are now.
    void forget_pairs() { next_pair_pass += VOILE_PAIR_HALVED_PASSES; }
};

using StrainLimitOf = std::function<StrainLimit(const ClothModel&)>;

struct Solver::State
{
    gpu::Context context;
    SolverOptions options;
    Kernels kernels;
    Model model;
    ColliderModels collider_models;
    bool anchors_moved = false;   // in the last step
    bool colliders_moved = false; // in the last step
    float farthest_motion = 0;    // m, of anchors and colliders in the step that is recorded
    Forces forces;                // of the last step
    uint64_t changes = 0;         // by the host, of what may wake cloths
    StepHistory history;
    ActiveLists lists;
    std::vector<SubstepNeed> needs; // of the active cloths, in no order; kept so that recording does not allocate
    gpu::Buffer statistics;         // one record per slot; the host reads it. Uploads leave it alone
    Slots<OutputId, Output> outputs;
    Replaced replaced;
    Edits edits;
    Passes passes;
    std::optional<DeviceState> device;      // none before the first upload
    std::unique_ptr<StepCommands> commands; // with SolverOptions::command_reuse
    RecordReport report;
    bool dirty = false;
    uint64_t number = next_number(); // tells the snapshots of this solver from those of others
    LifetimeCheck lifetime;          // the last member, so that it checks before anything is destroyed

    static uint64_t next_number();

    [[nodiscard]] const ClothModel* find(ClothId cloth) const { return model.cloths.find(cloth); }
    [[nodiscard]] const ColliderModel* find(ColliderId collider) const
    {
        return collider_models.colliders.find(collider);
    }
    [[nodiscard]] Result<void> check(ClothId cloth) const { return model.cloths.check("cloth", cloth); }
    [[nodiscard]] Result<void> check(ColliderId collider) const
    {
        return collider_models.colliders.check("collider", collider);
    }

    // The substeps of the active cloths, and of one more if it is not active. Overwrites `needed`.
    [[nodiscard]] SubstepPlan plan(const Step& step, std::vector<SubstepNeed>& needed, const ClothModel* other) const;
    // Gives cloths the levels of a plan. If that changes any, they are listed again.
    void assign_levels(const SubstepPlan& next, const Step& step);

    // Whether the next record has edits to record.
    [[nodiscard]] bool changes_due() const;
    // Keeps the former buffers for pending command buffers.
    void replace_buffers(Growth growth);
    // The sets of outputs after growth, in their order.
    void replace_outputs(std::vector<OutputSet> sets);
    // After a cloth was uploaded, removed, enabled or disabled.
    void update_patches();
    // Removes the outputs of one cloth, while commands that use them may be pending.
    void remove_outputs(ClothId cloth);
    // Removes the attachments of one cloth to an anchor.
    void remove_attachments(ClothId cloth, AnchorId anchor);
    // After the host changed the attachments of a cloth, or whether it has tethers: makes its tethers, and room for all
    // of them. Errors: tethers out of range, out of memory; nothing else has changed then.
    Result<void> apply_attachments(ClothId cloth);
    // Replaces the buffers of anchors, attachments and tethers if they are too small. Errors: out of memory, more than
    // the device can bind; nothing has changed then.
    Result<void> reserve_attachments();
    // After the attachments or tethers of a cloth changed, and at the end of update_patches.
    void update_attachments();
    // After materials or colliders changed, and at the end of update_attachments.
    void update_passes();
    // Wakes a cloth, those of layers, those that collide with themselves, in the next step, and counts it as a change.
    void wake(ClothModel& cloth);
    void wake_near(uint32_t layers);
    void wake_paired();
    // With the strain limits of a step.
    [[nodiscard]] Passes passes_with(const StrainLimitOf& limit_of) const;
    // What an upload records after its copies.
    void finish_upload(gpu::Recorder& recorder);
    // After a collider's record changed. `meets_others`: the triangles that a cloth collides with may have changed.
    void update_collider(ColliderId collider, bool meets_others);
    // Errors: a cloth of so many patches makes dispatches too large.
    [[nodiscard]] Result<void> check_patches(const std::string& name, uint64_t added) const
    {
        return check_dispatch(model.limits, "cloth", name, "with it the solver has", model.patches + added);
    }
};

// Copies the vertices of deforming meshes into their positions: first the copies, then, once these are visible to
// compute, the passes. Both do nothing if no mesh deforms.
void record_deforming_input(gpu::Recorder& recorder, const Solver::State& solver);
void record_deforming_passes(gpu::Recorder& recorder, Solver::State& solver);

// What an upload brings of deforming meshes.
struct NewDeforming
{
    std::vector<ColliderId> meshes;
    std::vector<ColliderId> features;
};

// Computes the boxes and the facings of deforming meshes at rest, for the next step and statistics that are recorded
// before it.
void record_at_rest(gpu::Recorder& recorder, const Solver::State& solver, const NewDeforming& colliders);

// Writes sizes of indirect dispatches, and clears other buffers. Between barriers of its own.
void write_dispatches(gpu::Recorder& recorder, VkBuffer sizes, VkDeviceSize offset, std::span<const std::byte> bytes,
                      std::span<const VkBuffer> counts = {});
// A kernel over the hierarchies of cloths: one dispatch per depth of trees, whose threads take one triangle each.
void record_over_trees(gpu::Recorder& recorder, const Solver::State& solver, const gpu::Kernel& kernel,
                       VkDescriptorSet set);
// Clears the marks and numbers of intersections. Between barriers of its own.
void clear_intersections(gpu::Recorder& recorder, const DeviceState& device);

// Sets the size of an indirect dispatch, at a word of its buffer, to 0. `counts`: other buffers to clear. Between
// barriers of its own.
void clear_dispatch(gpu::Recorder& recorder, VkBuffer size, uint32_t word = 0, std::span<const VkBuffer> counts = {});

// The word of the buffer of depenetrations that holds the size of depenetration's dispatch, of even and of odd steps.
constexpr uint32_t depenetration_word(size_t step)
{
    return static_cast<uint32_t>(step % 2) * VOILE_DISPATCH_WORDS;
}

// Makes the size of an indirect dispatch, as written by a dispatch, visible to indirect commands.
void publish_dispatch(gpu::Recorder& recorder);

// Clears everything that stores the number of a substep: lists of candidates, corrections by features. The next contact
// pass makes new lists. Between barriers of its own.
void forget_candidates(gpu::Recorder& recorder, const DeviceState& device);

// Writes the list of patches. Between barriers of the caller's.
void record_patches(gpu::Recorder& recorder, Solver::State& solver);

// Whether any anchor moves in the next step, or was teleported.
bool anchors_move(const Model& model);

// m: how far colliders, and anchors that hold a cloth, move in the next step. Anchors, and colliders without a box,
// count with the points within a meter of their origin; vertices that lie on the GPU do not count. 0 without features
// and pairs.
float farthest_motion(const Solver::State& solver);

// Records the edits that wait, and moves pins and anchors on. Begins and ends in the scope of compute and transfers.
void record_edits(gpu::Recorder& recorder, Solver::State& solver, const Step& step);

// The host's scopes, or the default ones.
HostScopes host_scopes(const SolverOptions& options);

// The barriers at the beginning and the end of what a solver records.
void begin_scope(gpu::Recorder& recorder, const SolverOptions& options);
void end_scope(gpu::Recorder& recorder, const SolverOptions& options);

// Copies the positions, if the host wants to keep them: all of them before a step, with a barrier before it, and those
// of cloths that jumped in it after the step, between barriers.
void record_previous_positions(gpu::Recorder& recorder, const Solver::State& solver);
void record_jumps(gpu::Recorder& recorder, Solver::State& solver);

// Whether solvers with these options check at destruction that none of their commands run.
bool checks_lifetime(const SolverOptions& options);

struct Upload::Contents
{
    gpu::Buffer staging;
    Replaced replaced;
    LifetimeCheck lifetime; // the last member, as the solver's
};

} // namespace voile
