// The lists of active cloths, their levels of substeps, and the passes that they and the colliders need.
#include "model/stability.hpp"
#include "solver/solver_state.hpp"

#include "shared/pair_layout.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace voile
{

namespace
{

// The passes that one collider needs.
void add_passes(Passes& passes, const ColliderModel& collider)
{
    constexpr uint32_t k_solid = VOILE_COLLIDER_CLOSED | VOILE_COLLIDER_ONE_SIDED;
    const shared::ColliderRecord& record = collider.record;
    const bool convex = record.kind != VOILE_COLLIDER_MESH && record.kind != VOILE_COLLIDER_PLANE;
    passes.moving |= is_moving(record);
    passes.convex |= convex;
    passes.depenetration |= convex || (record.flags & k_solid) == k_solid;
    passes.features += collider.features ? collider.features->set.features : 0;
    passes.mesh_extent = std::max(passes.mesh_extent, record.extent);
}

} // namespace

void Solver::State::update_patches()
{
    if (!device)
        return;
    list_patches(model, assigned_level, options.tuning.workgroup_size, lists);
    list_trees(model, lists);
    needs.reserve(model.cloths.size());
    edits.patches = true;
    update_attachments();
}

void Solver::State::update_attachments()
{
    edits.attachments = edits.pins = true;
    if (!device)
        return;
    list_attachments(model, assigned_level, lists);
    update_passes();
}

SubstepPlan Solver::State::plan(const Step& step, std::vector<SubstepNeed>& needed, const ClothModel* other) const
{
    if (step.substeps > 0)
        return uniform_plan(step.substeps);
    needed.clear();
    const auto duration = static_cast<double>(step.duration);
    for (const auto [index, cloth] : model.cloths)
        if (is_active(cloth) || &cloth == other)
            needed.push_back({voile::stable_substeps(cloth.record, duration), cloth.record.vertices});
    return plan_substeps(needed, {.substeps = step.max_substeps,
                                  .vertex_substeps = step.max_vertex_substeps,
                                  .dispatch_vertices = options.tuning.dispatch_vertices,
                                  .levels = passes.pairs ? 1u : VOILE_SUBSTEP_LEVELS});
}

void Solver::State::assign_levels(const SubstepPlan& next, const Step& step)
{
    bool levels_change = false;
    for (auto [index, cloth] : model.cloths)
    {
        if (!is_active(cloth))
            continue;
        uint32_t level = 0;
        if (next.levels > 1)
            level = next.level_of(voile::stable_substeps(cloth.record, static_cast<double>(step.duration)));
        levels_change |= std::exchange(cloth.level, level) != level;
        const Softening softening = softening_of(cloth, step, next);
        cloth.softened_substep = softening.substep;
        if (const StrainLimit limit = strain_limit(cloth, step, softening); limit != strain_limit(cloth.record))
        {
            cloth.record.strain_limit = limit.most;
            cloth.record.strain_passes = limit.passes;
            cloth.limit_due = edits.softened = true;
        }
        if (std::exchange(cloth.record.softened_substep, softening.softened_substep) != softening.softened_substep)
            cloth.softening_due = edits.softened = true;
    }
    if (edits.softened)
        update_passes();
    if (!levels_change)
        return;
    list_patches(model, assigned_level, options.tuning.workgroup_size, lists);
    list_attachments(model, assigned_level, lists);
    edits.patches = edits.attachments = true;
}

void Solver::State::update_passes()
{
    if (device)
        passes = passes_with([](const ClothModel& cloth) { return strain_limit(cloth.record); });
}

Passes Solver::State::passes_with(const StrainLimitOf& limit_of) const
{
    Passes next;
    for (const auto [index, collider] : collider_models.colliders)
        if (is_active(collider))
        {
            next.colliders = index + 1;
            add_passes(next, collider);
        }
    next.depenetration = next.depenetration && options.depenetration;
    for (const auto [index, cloth] : model.cloths)
    {
        if (!is_active(cloth))
            continue;
        if (const StrainLimit limit = limit_of(cloth); limit.most > 0)
        {
            next.strain_spacing = std::max(next.strain_spacing, cloth.record.strain_spacing);
            next.strain_passes = std::max(next.strain_passes, limit.passes);
            next.smooths |= limit.passes == VOILE_SOFTENED_STRAIN_PASSES;
        }
        next.sleep |= cloth.record.sleep_speed > 0;
        if (!cloth.self_collision)
            continue;
        const float reach = VOILE_PAIR_APPROACH * cloth.record.pair_range;
        next.pair_reach = next.pairs ? std::min(next.pair_reach, reach) : reach;
        next.pairs = true;
    }
    const bool attached = lists.resting_pins.first > lists.pins || !lists.tethers.empty();
    next.contact = next.colliders > 0 || attached || next.pairs;
    return next;
}

void Solver::State::update_collider(ColliderId collider, bool meets_others)
{
    edits.colliders.insert(collider.index);
    edits.candidates |= meets_others;
    const ColliderModel* model_of = find(collider);
    if (model_of != nullptr)
        wake_near(model_of->record.layers);
    if (options.feature_contact && model_of != nullptr && needs_features(*model_of, model))
        dirty = true;
    update_passes();
}

} // namespace voile
