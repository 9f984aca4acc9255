// The passes of one step: those of each level of substeps, and their order.
#pragma once

#include "solver/solver_state.hpp"

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
    uint32_t first_substep = 0; // counted over all steps
};

// The passes of the cloths that take the same number of substeps.
class LevelRecorder
{
public:
    LevelRecorder(const StepContext& context, uint32_t level);

    // Lists the colliders near each patch, until the next query. Records nothing with few colliders. The first query
    // comes before all other passes of the step that read colliders.
    void record_near_colliders(uint32_t substep);
    // Integration, attachments, tethers and contact.
    void record_substep(uint32_t substep, bool after_pairs);
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
    void record_limit_work(VkDescriptorSet set);

private:
    [[nodiscard]] shared::StagePush make_push(double substeps) const; // after so many of them
    void record_rk4(uint32_t substep);
    void record_verlet(shared::StagePush push, uint32_t substep);
    // At the substep's end, over `duration` s. With 0, springs add nothing and only bounds hold.
    void record_attachments(uint32_t substep, float duration);
    [[nodiscard]] float progress(uint32_t substeps_done) const; // of the step, 0..1
    // Lists the features near pieces of cloth and the patches near features, until the next query.
    void record_near_features(uint32_t substep);
    [[nodiscard]] float sudden_speed() const; // m/s
    void record_features(uint32_t substep);
    // Of the level, in the buffer of items.
    struct ItemRange
    {
        uint32_t first;
        uint32_t count;
    };
    [[nodiscard]] ItemRange feature_items() const;
    void record_contact(uint32_t substep, bool after_pairs = false);
    [[nodiscard]] const gpu::Kernel& contact_kernel() const;
    [[nodiscard]] EntryRange verlet_patches() const;
    template <typename Push>
    void dispatch(const gpu::Kernel& kernel, VkDescriptorSet set, EntryRange patches, Push push)
    {
        push.first_patch = patches.first;
        recorder_.dispatch(kernel, set, patches.count * group_, group_, push);
    }
    const StepContext& context_;
    gpu::Recorder& recorder_;
    const Solver::State& solver_;
    const Kernels& kernels_;
    const DeviceState& device_;
    const LevelLists& lists_;
    uint32_t level_;
    uint32_t group_;
    uint32_t substeps_;
    float h_;          // s
    bool has_contact_; // the contact pass runs on the proposed state
    bool swaps_;       // and changes it in place; otherwise it copies the state from stage B
};

// The passes of all levels, in the order of time, and the strain limit at the end.
class StepRecorder
{
public:
    explicit StepRecorder(const StepContext& context);

    void record_near_colliders();
    void record();

private:
    void record_strain_limit();
    void record_limit_passes();
    void record_limit_guard();
    void keep_state(const StateBuffers& kept); // a copy of the state
    template <typename Use>
    void for_each_level(const Use& use);

    const StepContext& context_;
    gpu::Recorder& recorder_;
    const Solver::State& solver_;
    const Kernels& kernels_;
    const DeviceState& device_;
    uint32_t threads_; // for all patches
    uint32_t group_;
    std::array<std::optional<LevelRecorder>, VOILE_SUBSTEP_LEVELS> levels_; // none for a level without cloths
};

} // namespace voile
