// SubstepRecorder: the passes of one step, substep by substep.
#pragma once

#include "solver/solver_state.hpp"

namespace voile
{

// Passes of the strain limit whose widest level has that spacing: an odd number.
uint32_t limit_passes(uint32_t widest_spacing);

class SubstepRecorder
{
public:
    SubstepRecorder(gpu::Recorder& recorder, const Solver::State& solver, const StepHistory& history, const Step& step,
                    uint32_t substeps, uint32_t first_substep);

    // Which colliders come near which patches, until the next such look. Nothing where there are few. The first one
    // comes before whatever else looks for colliders in the step.
    void record_near_colliders(uint32_t substep);
    // Integration, attachments, tethers and contact of each substep, and the strain limit at the end.
    void record();

private:
    [[nodiscard]] shared::StagePush make_push(double substeps) const; // after so many of them
    void record_rk4(uint32_t substep);
    void record_verlet(shared::StagePush push, uint32_t substep);
    void finish_verlet(shared::StagePush push);
    // At the substep's end, over `duration` s; over 0 springs add nothing, and bounds still hold.
    void record_attachments(uint32_t substep, float duration);
    [[nodiscard]] float progress(uint32_t substeps_done) const; // of the step, 0..1
    // Which patches come near corners and edges of colliders, until the next such look.
    void record_near_features(uint32_t substep);
    [[nodiscard]] float sudden_speed() const; // m/s
    void record_features(uint32_t substep);
    void record_contact(uint32_t substep);
    [[nodiscard]] const gpu::Kernel& contact_kernel() const;
    void record_strain_limit();
    void record_limit_passes();
    void record_limit_guard();
    void keep_state(const StateBuffers& kept); // a copy of the state
    // Whether a substep begins in stage B: the state goes back and forth between there and its own buffers. Where
    // contact is to commit it ends in these, since the last one copies if their number is odd. Without contact that is
    // Verlet's alone.
    [[nodiscard]] bool in_stage_b(uint32_t substep) const
    {
        return substep % 2 == 1 && (has_contact_ ? swaps_ && substep < substeps_ : true);
    }
    [[nodiscard]] uint32_t verlet_threads() const;

    gpu::Recorder& recorder_;
    const Solver::State& solver_;
    const StepHistory& history_;
    const Kernels& kernels_;
    const DeviceState& device_;
    uint32_t patches_;
    const Step& step_;
    uint32_t group_;
    uint32_t substeps_;
    uint32_t first_substep_; // counted through all steps
    float h_;                // s
    bool has_contact_;       // the contact pass runs on what is proposed
    bool swaps_;             // and changes it in place; else it takes all of it from stage B into the state
};

} // namespace voile
