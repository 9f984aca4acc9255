// The passes of one step: those of each batch of cloths, and their order.
#pragma once

#include "solver/solver_state.hpp"

#include "shared/sleep_layout.h"

namespace voile
{

// The input of the recording of a step.
struct StepContext
{
    gpu::Recorder& recorder;
    const Solver::State& solver;
    const ActiveLists& lists;
    const StepHistory& history;
    const Step& step;
    SubstepPlan plan;
    const Passes& passes; // the solver's, with the strain limits of the step
};

// The passes of a batch: of the cloths of one level of substeps that use one integrator.
class BatchRecorder
{
public:
    BatchRecorder(const StepContext& context, uint32_t batch);

    // Lists the colliders near each patch, until the next query. Records nothing with few colliders. The first query
    // comes before all other passes of the step that read colliders.
    void record_near_colliders(uint32_t substep);
    // Integration, attachments, tethers, and contact if a contact pass is due.
    void record_substep(uint32_t substep);
    // The number of substeps from one contact pass to the next. The last ones of a step may be closer.
    [[nodiscard]] uint32_t contact_period() const { return contact_period_; }
    // Whether a substep begins in stage B: state and stage B exchange roles. With contact the last substep ends in the
    // state, because its contact pass copies if the number of substeps is odd. Without contact only Verlet exchanges.
    [[nodiscard]] bool in_stage_b(uint32_t substep) const
    {
        return substep % 2 == 1 && (has_contact_ ? swaps_ && substep < substeps_ : true);
    }
    // Verlet's last half kick.
    void finish();
    // Attachments, tethers and contact after the strain limit, over no time.
    void record_bounds();
    void record_limit_works(std::span<const VkDescriptorSet> sets);

private:
    // In substeps of level 0, as push constants have it.
    template <typename Number>
    [[nodiscard]] float of_level_0(Number substeps) const
    {
        return static_cast<float>(substeps) * static_cast<float>(1u << level_);
    }
    [[nodiscard]] shared::StagePush make_push(float substeps) const; // after so many of them
    void record_rk4(uint32_t substep);
    void record_verlet(shared::StagePush push, uint32_t substep);
    // At the substep's end. With `lasts` 0 no time passes: springs add nothing and only bounds hold.
    void record_attachments(uint32_t substep, uint32_t lasts);
    [[nodiscard]] float progress(uint32_t substeps_done) const; // of the step, 0..1
    // Lists the features near pieces of cloth and the patches near features, until the next query.
    void record_near_features(uint32_t substep);
    void record_features(uint32_t substep);
    // Of the level, in the buffer of items.
    struct ItemRange
    {
        uint32_t first;
        uint32_t count;
    };
    [[nodiscard]] ItemRange feature_items() const;
    void record_contact(uint32_t substep);
    [[nodiscard]] bool shares_forces() const;
    [[nodiscard]] const gpu::Kernel& verlet_kernel() const;
    [[nodiscard]] const gpu::Kernel& contact_kernel() const;
    // Substeps from one contact pass to the next: `first`, and so many more.
    struct ContactInterval
    {
        uint32_t first;
        uint32_t count;
    };
    [[nodiscard]] bool contact_is_due(uint32_t substep) const;              // after it
    [[nodiscard]] ContactInterval contact_interval(uint32_t substep) const; // that ends with the substep
    // Whether the contact pass keeps positions from which the next one starts. Else it starts from the state before the
    // substep.
    [[nodiscard]] bool keeps_contact_start(uint32_t substep) const;
    [[nodiscard]] size_t proposal(uint32_t substep) const;
    // Contact of odd numbers of substeps ends with a pass over one, which copies its result into the state.
    [[nodiscard]] bool ends_alone() const { return contact_period_ > 1 && substeps_ % 2 == 1; }
    // Over all patches of the batch.
    template <typename Push>
    void dispatch(const gpu::Kernel& kernel, VkDescriptorSet set, Push push,
                  gpu::Ordering ordering = gpu::Ordering::ordered)
    {
        push.first_patch = lists_.patches.first;
        recorder_.dispatch(kernel, set, lists_.patches.count * group_, group_, push, ordering);
    }
    // Over those whose cloths are awake.
    template <typename Push>
    void dispatch_awake(const gpu::Kernel& kernel, VkDescriptorSet set, Push push)
    {
        if (!context_.passes.sleep)
            return dispatch(kernel, set, push);
        push.first_patch = lists_.patches.first | VOILE_AWAKE_PATCHES;
        recorder_.dispatch_indirect(kernel, set, device_[buffer::awake_dispatches].handle(),
                                    batch_ * sizeof(shared::AwakeDispatch), push);
    }
    const StepContext& context_;
    gpu::Recorder& recorder_;
    const Solver::State& solver_;
    const Kernels& kernels_;
    const DeviceState& device_;
    const BatchLists& lists_;
    uint32_t feature_passes_ = 0; // since near features were listed
    uint32_t batch_;              // its index
    uint32_t level_;
    bool verlet_;
    uint32_t group_;
    uint32_t substeps_;
    float h_;          // s
    bool has_contact_; // the contact pass runs on the proposed state; otherwise after a strain limit alone
    bool swaps_;       // and changes it in place; otherwise it copies the state from stage B
    uint32_t contact_period_;
    uint32_t list_period_; // substeps from one refresh of lists of near triangles, features and colliders to the next
};

// The passes of all batches, in the order of time, and the strain limit at the end.
class StepRecorder
{
public:
    explicit StepRecorder(const StepContext& context);

    void record_near_colliders();
    void record();

private:
    void keep_contact_start();
    void record_strain_limit();
    void record_limit_passes();
    void record_limit_guard();
    // Copies the state's positions and residuals, and velocities on request.
    void keep_state(const StateBuffers& kept, bool velocities = true);
    template <typename Use>
    void for_each_batch(const Use& use);
    // Whether the substep begins in stage B, for the passes over pairs. With these there is one level.
    [[nodiscard]] bool in_stage_b(uint32_t substep) const;

    const StepContext& context_;
    gpu::Recorder& recorder_;
    const Solver::State& solver_;
    const Kernels& kernels_;
    const DeviceState& device_;
    uint32_t threads_; // for all patches
    uint32_t group_;
    std::array<std::optional<BatchRecorder>, VOILE_SUBSTEP_BATCHES> batches_; // none for one without cloths
};

} // namespace voile
