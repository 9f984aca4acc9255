// What a Solver and an Upload hold.
#pragma once

#include "voile/solver.hpp"

#include "colliders/collider_motion.hpp"
#include "model/active_lists.hpp"
#include "model/substep_plan.hpp"
#include "solver/device_state.hpp"
#include "solver/lifetime_check.hpp"

#include "shared/step_layout.h"

#include <optional>

namespace voile
{

// What the host asked for since the last record; recorded at the beginning of the next one. What is asked of cloths and
// colliders that are not uploaded yet waits for their upload. Lists of attachments and tethers that do not fit their
// buffers wait for larger ones.
struct Edits
{
    std::vector<uint32_t> records;             // cloths whose record changed
    std::vector<uint32_t> colliders;           // colliders whose record changed, or that were removed
    std::vector<shared::EditPush> state_edits; // in order
    bool patches = false;
    bool attachments = false; // the lists of attachments and tethers
    bool pins = false;        // they must be set again
    bool candidates = false;  // lists of near triangles must be made anew

    // What concerns a cloth that was removed.
    void forget(ClothId cloth);
};

// So many substeps are told apart by the lists of candidates before they must be made anew.
constexpr uint32_t k_substeps_counted = 1u << (32 - VOILE_CANDIDATE_COUNT_BITS);

// Which of the optional passes a step has, by what there is.
struct Passes
{
    bool moving = false;         // colliders that move or deform
    bool convex = false;         // colliders with a formula, other than planes
    bool features = false;       // colliders with corners or edges that vertices alone do not feel
    uint32_t strain_spacing = 0; // the widest level of the strain limit; 0: no cloth has one
    bool contact = false;        // the contact pass
    bool depenetration = false;  // colliders with an inside, out of which vertices are brought
    uint32_t colliders = 0;      // slots up to the last active collider's
    float mesh_extent = 0;       // m, that a collider's mesh has at most along an axis from its origin
};

// As the GPU sees it.
shared::AnchorRecord make_record(const Anchor& anchor);

// Of the strain limit, on each level.
constexpr uint32_t k_strain_passes = 16;
constexpr float k_strain_radius = 0.95f; // of the iteration, for its acceleration

// Steps from one look at all vertices to the next, where none was inside.
constexpr uint32_t k_depenetration_period = 8;

// What one step leaves for the next, beside the buffers.
struct StepHistory
{
    bool normals_due = false;        // they are of other places: after an upload, and after cloths were moved
    bool depenetration_due = false;  // vertices may have got into solids otherwise than by moving
    uint32_t depenetration_step = 0; // counts the steps with depenetration
    uint32_t next_substep = 0;       // counted through all steps, below k_substeps_counted
};

struct Solver::State
{
    gpu::Context context;
    SolverOptions options;
    Kernels kernels;
    Model model;
    ColliderModels collider_models;
    bool anchors_moved = false;   // in the last step
    bool colliders_moved = false; // in the last step
    float farthest_motion = 0;    // m, of anchors and colliders in the step that is recorded, if there are features
    StepHistory history;
    ActiveLists lists;                  // those of attachments: as they were when they fitted their buffers last
    AttachmentCounts attachment_counts; // of the active cloths
    std::vector<SubstepNeed> needs;     // of the active cloths, in no order; kept so that recording does not allocate
    gpu::Buffer statistics;             // one record a slot; the host reads it. Uploads leave it alone
    Edits edits;
    Passes passes;
    std::optional<DeviceState> device; // none before the first upload
    bool dirty = false;
    LifetimeCheck lifetime; // the last member: it looks before anything is destroyed

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
    // Gives cloths the levels of a plan and lists them anew, if that changes any.
    void assign_levels(const SubstepPlan& next, const Step& step);

    // Whether the next record has edits to record.
    [[nodiscard]] bool changes_due() const;
    // After a cloth was uploaded, removed, enabled or disabled.
    void update_patches();
    // Those of one cloth that follow an anchor.
    void remove_attachments(ClothId cloth, AnchorId anchor);
    // After the attachments or tethers of a cloth changed, and after the above.
    void update_attachments();
    // After materials or colliders changed, and after the above: the passes over what takes part.
    void update_passes();
    // What an upload records after its copies.
    void finish_upload(gpu::Recorder& recorder);
    // A collider's record changed. `meets_others`: so may the triangles that are near a cloth.
    void update_collider(ColliderId collider, bool meets_others);
    // Errors: a cloth of so many patches makes dispatches too large.
    [[nodiscard]] Result<void> check_patches(const std::string& name, uint64_t added) const
    {
        return check_dispatch(model.limits, "cloth", name, "with it the solver has", model.patches + added);
    }
    // Whether the attachments, with their anchors, and the tethers of the active cloths fit their buffers.
    [[nodiscard]] bool fits() const;
};

// Takes the vertices of deforming meshes into their positions: first the copies, then, once these are visible to
// compute, the passes. Both do nothing where no mesh deforms.
void record_deforming_input(gpu::Recorder& recorder, const Solver::State& solver);
void record_deforming_passes(gpu::Recorder& recorder, Solver::State& solver);
// The boxes of deforming meshes that do not move, for statistics that are recorded before the next step.
void record_boxes_at_rest(gpu::Recorder& recorder, const Solver::State& solver, std::span<const ColliderId> colliders);

// Sets the size of an indirect dispatch, at a word of its buffer, to nothing; what is added to x comes in so many
// workgroups each. A buffer of other counts, if any, becomes 0 too. Between barriers of its own.
void clear_dispatch(gpu::Recorder& recorder, VkBuffer size, uint32_t word = 0, uint32_t groups_each = 1,
                    VkBuffer counts = VK_NULL_HANDLE);

// Where the size of depenetration's dispatch stands in the buffer of depenetrations, of even and of odd steps.
constexpr uint32_t depenetration_word(size_t step)
{
    return static_cast<uint32_t>(step % 2) * VOILE_DISPATCH_WORDS;
}

// Makes the size of an indirect dispatch visible that a dispatch has written.
void publish_dispatch(gpu::Recorder& recorder);

// Empties the lists of candidates and the corrections by features, both told apart by substeps: the next contact pass
// makes lists anew. Between barriers of its own.
void forget_candidates(gpu::Recorder& recorder, const DeviceState& device);

// Writes the list of patches. Between barriers of the caller's.
void record_patches(gpu::Recorder& recorder, Solver::State& solver);

// Records the edits that wait, and moves pins and anchors on. Begins and ends in the scope of compute and transfers.
void record_edits(gpu::Recorder& recorder, Solver::State& solver, const Step& step);

// The host's scopes, as given or as they are where none are given.
HostScopes host_scopes(const SolverOptions& options);

// Whether solvers with these options look for commands that run when they are destroyed.
bool checks_lifetime(const SolverOptions& options);

struct Upload::Contents
{
    gpu::Buffer staging;
    DeviceState replaced;
    LifetimeCheck lifetime; // the last member, as the solver's
};

} // namespace voile
