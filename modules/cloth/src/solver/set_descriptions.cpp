// describe_sets: the roles of every set.
#include "solver/descriptor_sets.hpp"
#include "solver/state_buffers.hpp"

#include <utility>

namespace voile
{

namespace
{

// The buffers of a substep that begins in the state, and of one that begins in stage B; then of contact over several
// substeps, the last of which begins in the state, or in stage B.
struct Proposal
{
    StateBuffers earlier;
    StateBuffers proposed;
    buffer::Name earlier_predicted; // Verlet's
    buffer::Name predicted;
};

constexpr Proposal k_proposals[] = {
    {k_state, k_stage_b, buffer::stage_a_velocities, buffer::stage_c_velocities},
    {k_stage_b, k_state, buffer::stage_c_velocities, buffer::stage_a_velocities},
    // Of several substeps. Contact writes the earlier positions alone.
    {{k_contact_start.positions, k_contact_start.residuals, k_state.velocities},
     k_stage_b,
     buffer::stage_a_velocities,
     buffer::stage_c_velocities},
    {{k_contact_start.positions, k_contact_start.residuals, k_stage_b.velocities},
     k_state,
     buffer::stage_c_velocities,
     buffer::stage_a_velocities},
};

class Describer
{
public:
    Describer(DescriptorSets& sets, const Kernels& kernels) : sets_(sets), kernels_(kernels) {}

    std::vector<SetDescription> describe();

private:
    void add(VkDescriptorSet& set, const gpu::Kernel& kernel, std::vector<RoleBuffer> roles = {})
    {
        descriptions_.push_back({&set, &kernel, std::move(roles)});
    }

    void add_stage(VkDescriptorSet& set, const StateBuffers& base, const StateBuffers& third, const StateBuffers& input,
                   const StateBuffers& output);
    void add_stages();
    void add_verlet();
    void add_attachments();
    void add_strain_limit();
    void add_limit_work(VkDescriptorSet& set, buffer::Name works, const StateBuffers& here, const StateBuffers& before,
                        const StateBuffers& after);
    void add_limit_guard();
    void add_contact();
    void add_depenetration();
    void add_pairs();
    void add_refit();
    void add_intersections();

    DescriptorSets& sets_;
    const Kernels& kernels_;
    std::vector<SetDescription> descriptions_;
};

void Describer::add_stage(VkDescriptorSet& set, const StateBuffers& base, const StateBuffers& third,
                          const StateBuffers& input, const StateBuffers& output)
{
    add(set, kernels_.stage,
        {{binding::base_positions, base.positions},
         {binding::base_residuals, base.residuals},
         {binding::base_velocities, base.velocities},
         {binding::stage_positions, input.positions},
         {binding::stage_residuals, input.residuals},
         {binding::stage_velocities, input.velocities},
         {binding::next_positions, output.positions},
         {binding::next_residuals, output.residuals},
         {binding::next_velocities, output.velocities},
         {binding::second_velocities, k_stage_a.velocities},
         {binding::third_velocities, third.velocities}});
}

void Describer::add_stages()
{
    for (size_t parity = 0; parity < 2; ++parity)
    {
        const auto& [base, other, base_predicted, predicted] = k_proposals[parity];
        add_stage(sets_.stages[parity][0], base, other, base, k_stage_a);
        add_stage(sets_.stages[parity][1], base, other, k_stage_a, other);
        add_stage(sets_.stages[parity][2], base, other, other, k_stage_c);
        add_stage(sets_.stages[parity][3], base, other, k_stage_c, other);
    }
    add_stage(sets_.last_stage_alone, k_state, k_stage_b, k_stage_c, k_state);
}

void Describer::add_verlet()
{
    // Of a Verlet cloth: positions, velocities at their time or predicted for it, velocities half a substep before.
    struct Motion
    {
        buffer::Name positions;
        buffer::Name residuals;
        buffer::Name predicted;
        buffer::Name velocities;
    };
    const auto add_set = [&](VkDescriptorSet& set, const Motion& input, const Motion& output)
    {
        add(set, kernels_.verlet,
            {{binding::stage_positions, input.positions},
             {binding::stage_residuals, input.residuals},
             {binding::stage_velocities, input.predicted},
             {binding::half_step_velocities, input.velocities},
             {binding::next_positions, output.positions},
             {binding::next_residuals, output.residuals},
             {binding::next_velocities, output.velocities},
             {binding::next_predicted, output.predicted}});
    };
    constexpr Motion k_start{k_state.positions, k_state.residuals, k_state.velocities, k_state.velocities};
    constexpr Motion k_here{k_state.positions, k_state.residuals, k_stage_a.velocities, k_state.velocities};
    constexpr Motion k_there{k_stage_b.positions, k_stage_b.residuals, k_stage_c.velocities, k_stage_b.velocities};
    // The last kick does not change positions. It writes them to buffers that no pass reads.
    constexpr Motion k_end{k_stage_b.positions, k_stage_b.residuals, k_stage_c.velocities, k_state.velocities};
    add_set(sets_.verlet_first, k_start, k_there);
    add_set(sets_.verlet_forth, k_here, k_there);
    add_set(sets_.verlet_back, k_there, k_here);
    add_set(sets_.verlet_last, k_here, k_end);
    add_set(sets_.verlet_last_back, k_there, k_here);
}

// What acts on the state between steps, and on the state that a substep proposes.
void Describer::add_attachments()
{
    add(sets_.pins, kernels_.pins);
    add(sets_.edit, kernels_.edit);
    for (size_t parity = 0; parity < 2; ++parity)
    {
        const auto& [earlier, proposed, earlier_predicted, predicted] = k_proposals[parity];
        add(sets_.proposed_attachments[parity], kernels_.attachments,
            {{binding::proposed_positions, proposed.positions},
             {binding::proposed_residuals, proposed.residuals},
             {binding::proposed_velocities, proposed.velocities},
             {binding::proposed_predicted, predicted},
             {binding::earlier_positions, earlier.positions},
             {binding::earlier_residuals, earlier.residuals},
             {binding::earlier_velocities, earlier.velocities}});
        add(sets_.proposed_tethers[parity], kernels_.tethers,
            {{binding::proposed_positions, proposed.positions},
             {binding::proposed_residuals, proposed.residuals},
             {binding::proposed_velocities, proposed.velocities},
             {binding::proposed_predicted, predicted},
             {binding::earlier_positions, earlier.positions}});
    }
}

void Describer::add_strain_limit()
{
    using Roles = std::vector<RoleBuffer>;
    const auto add_pass = [&](VkDescriptorSet& set, const gpu::Kernel& kernel,
                              std::pair<const StateBuffers&, const StateBuffers&> states, const Roles& others = {})
    {
        const auto& [input, output] = states;
        Roles roles{{binding::stage_positions, input.positions},   {binding::stage_residuals, input.residuals},
                    {binding::stage_velocities, input.velocities}, {binding::next_positions, output.positions},
                    {binding::next_residuals, output.residuals},   {binding::next_velocities, output.velocities}};
        roles.insert(roles.end(), others.begin(), others.end());
        add(set, kernel, std::move(roles));
    };
    const RoleBuffer step_positions{binding::step_positions, k_state.positions};
    const RoleBuffer step_residuals{binding::step_residuals, k_state.residuals};
    const RoleBuffer step_velocities{binding::step_velocities, k_state.velocities};
    const RoleBuffer spins{binding::spins, buffer::stage_c_positions};
    add_pass(sets_.limit_coarse[0], kernels_.limit_coarse, {k_state, k_stage_b});
    add_pass(sets_.limit_coarse[1], kernels_.limit_coarse, {k_state, k_stage_a});
    add_pass(sets_.strain_back, kernels_.limit_strain, {k_stage_b, k_stage_a},
             {step_positions, step_residuals, step_velocities});
    add_pass(sets_.strain_forth, kernels_.limit_strain, {k_stage_a, k_stage_b},
             {step_positions, step_residuals, step_velocities});
    add(sets_.limit_spin, kernels_.limit_spin,
        {{binding::stage_positions, k_stage_a.positions},
         {binding::stage_velocities, k_stage_a.velocities},
         step_velocities,
         spins});
    add_pass(sets_.limit_smooth, kernels_.limit_smooth, {k_stage_a, k_stage_b}, {step_velocities, spins});
}

void Describer::add_limit_work(VkDescriptorSet& set, buffer::Name works, const StateBuffers& here,
                               const StateBuffers& before, const StateBuffers& after)
{
    add(set, kernels_.limit_work,
        {{binding::stage_positions, here.positions},
         {binding::stage_residuals, here.residuals},
         {binding::stage_velocities, here.velocities},
         {binding::before_positions, before.positions},
         {binding::before_residuals, before.residuals},
         {binding::before_velocities, before.velocities},
         {binding::after_positions, after.positions},
         {binding::after_residuals, after.residuals},
         {binding::after_velocities, after.velocities},
         {binding::works, works}});
}

void Describer::add_limit_guard()
{
    auto& works = sets_.limit_work;
    add_limit_work(works[0], buffer::step_works_first, k_step_start, k_step_start, k_before_limit);
    add_limit_work(works[1], buffer::step_works_last, k_before_limit, k_step_start, k_before_limit);
    add_limit_work(works[2], buffer::limit_works_before, k_before_limit, k_before_limit, k_state);
    add_limit_work(works[3], buffer::limit_works_after, k_state, k_before_limit, k_state);
    add(sets_.limit_scale, kernels_.limit_scale);
    add(sets_.limit_guard, kernels_.limit_guard,
        {{binding::before_positions, k_before_limit.positions},
         {binding::before_residuals, k_before_limit.residuals},
         {binding::before_velocities, k_before_limit.velocities}});
}

void Describer::add_contact()
{
    for (size_t proposal = 0; proposal < std::size(k_proposals); ++proposal)
    {
        const auto& [earlier, proposed, earlier_predicted, predicted] = k_proposals[proposal];
        add(sets_.contact[proposal], kernels_.contact,
            {{binding::proposed_positions, proposed.positions},
             {binding::proposed_residuals, proposed.residuals},
             {binding::proposed_velocities, proposed.velocities},
             {binding::proposed_predicted, predicted},
             {binding::earlier_positions, earlier.positions},
             {binding::earlier_residuals, earlier.residuals},
             {binding::earlier_velocities, earlier.velocities},
             {binding::earlier_predicted, earlier_predicted}});
        for (size_t votes = 0; votes < 2; ++votes)
        {
            std::vector<RoleBuffer> roles = {{binding::proposed_positions, proposed.positions},
                                             {binding::proposed_residuals, proposed.residuals},
                                             {binding::proposed_velocities, proposed.velocities},
                                             {binding::earlier_positions, earlier.positions},
                                             {binding::earlier_residuals, earlier.residuals},
                                             {binding::step_votes, k_depenetration_votes[votes]}};
            add(sets_.test_features[proposal][votes], kernels_.test_features, roles);
            add(sets_.feature_contact[proposal][votes], kernels_.feature_contact, roles);
        }
    }
    add(sets_.near_features, kernels_.near_features);
    add(sets_.near_colliders, kernels_.near_colliders);
}

void Describer::add_depenetration()
{
    for (size_t i = 0; i < 2; ++i)
        add(sets_.depenetrate[i], kernels_.depenetrate,
            {{binding::next_votes, k_depenetration_votes[i]}, {binding::last_votes, k_depenetration_votes[1 - i]}});
}

void Describer::add_pairs()
{
    for (size_t parity = 0; parity < 2; ++parity)
    {
        const StateBuffers& now = k_proposals[parity].earlier;
        for (const auto& [set, kernel] :
             {std::pair(&sets_.pair_means, &kernels_.pair_means), std::pair(&sets_.pair_clear, &kernels_.pair_clear),
              std::pair(&sets_.pair_sweeps, &kernels_.pair_sweeps)})
            add((*set)[parity], *kernel,
                {{binding::stage_positions, now.positions}, {binding::stage_velocities, now.velocities}});
        for (const auto& [set, kernel] :
             {std::pair(&sets_.index_pairs, &kernels_.index_pairs), std::pair(&sets_.meet_pairs, &kernels_.meet_pairs),
              std::pair(&sets_.respond_to_pairs, &kernels_.respond_to_pairs)})
            add((*set)[parity], *kernel,
                {{binding::stage_positions, now.positions},
                 {binding::stage_residuals, now.residuals},
                 {binding::stage_velocities, now.velocities}});
    }
    add(sets_.find_tangles, kernels_.find_tangles);
    add(sets_.find_islands, kernels_.find_islands);
    add(sets_.pair_boxes, kernels_.pair_boxes);
    add(sets_.find_candidates, kernels_.find_candidates);
    add(sets_.sift_candidates, kernels_.sift_candidates);
    add(sets_.find_pairs, kernels_.find_pairs);
    add(sets_.match_pairs, kernels_.match_pairs);
    add(sets_.pair_refit, kernels_.refit.levels,
        {{binding::refit_leaves, buffer::padded_leaves},
         {binding::refit_positions, buffer::positions},
         {binding::refit_boxes, buffer::pair_boxes}});
}

void Describer::add_refit()
{
    add(sets_.refit, kernels_.refit.leaves,
        {{binding::refit_leaves, buffer::padded_leaves},
         {binding::refit_positions, buffer::deforming_positions},
         {binding::refit_boxes, buffer::padded_boxes}});
    add(sets_.refit_cloths, kernels_.refit.leaves,
        {{binding::refit_leaves, buffer::cloth_leaves},
         {binding::refit_positions, buffer::positions},
         {binding::refit_boxes, buffer::cloth_boxes}});
}

void Describer::add_intersections()
{
    if (kernels_.count_cloth_pairs.pipeline() == VK_NULL_HANDLE)
        return;
    add(sets_.count_cloth_pairs, kernels_.count_cloth_pairs);
    add(sets_.count_collider_pairs, kernels_.count_collider_pairs);
}

std::vector<SetDescription> Describer::describe()
{
    add_stages();
    add_verlet();
    add_attachments();
    add_strain_limit();
    add_limit_guard();
    add_contact();
    add_depenetration();
    add_pairs();
    add(sets_.deform, kernels_.deform);
    add(sets_.face_features, kernels_.face_features);
    add_refit();
    add_intersections();
    add(sets_.find_reaches, kernels_.find_reaches);
    add(sets_.find_restless, kernels_.find_restless);
    add(sets_.wake_cloths, kernels_.wake_cloths);
    add(sets_.list_awake_patches, kernels_.list_awake_patches);
    add(sets_.find_speeds, kernels_.find_speeds);
    add(sets_.decide_sleep, kernels_.decide_sleep);
    add(sets_.fall_asleep, kernels_.fall_asleep);
    add(sets_.normals, kernels_.normals);
    add(sets_.statistics, kernels_.statistics);
    add(sets_.statistics_reduce, kernels_.statistics_reduce);
    return std::move(descriptions_);
}

} // namespace

std::vector<SetDescription> describe_sets(DescriptorSets& sets, const Kernels& kernels)
{
    return Describer(sets, kernels).describe();
}

// Where no previous positions are kept, the kernel does not read what stands in their place.
SetDescription describe_output(VkDescriptorSet& set, const Kernels& kernels, bool keeps_previous)
{
    SetDescription description{&set, &kernels.output, {}};
    if (!keeps_previous)
        description.roles.push_back({binding::previous_positions, buffer::positions});
    return description;
}

} // namespace voile
