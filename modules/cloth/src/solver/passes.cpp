// What takes part in steps: the lists over active cloths, and the passes that these and the colliders need.
#include "solver/solver_state.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

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
    passes.features |= collider.features && collider.features->set.features > 0;
    passes.mesh_extent = std::max(passes.mesh_extent, record.extent);
}

// The widest level of a cloth's strain limit: half of the longer side and less. A mesh has as many passes as a grid of
// its size.
uint32_t strain_spacing(const shared::ClothRecord& cloth)
{
    if (cloth.strain_limit == 0)
        return 0;
    const uint32_t side = cloth.columns > 0 ? std::max(cloth.columns, cloth.rows)
                                            : static_cast<uint32_t>(std::sqrt(static_cast<double>(cloth.vertices)));
    return std::bit_floor(std::max(side / 2, 1u));
}

} // namespace

bool Solver::State::attachments_fit() const
{
    return device && model.anchors.size() <= device->capacities.anchors &&
           attachment_lists.attachments.size() <= device->capacities.attachments;
}

bool Solver::State::tethers_fit() const
{
    return device && attachment_lists.tethers.size() <= device->capacities.tethers;
}

void Solver::State::update_patches()
{
    if (!device)
        return;
    patches = make_patches(model, options.tuning.workgroup_size);
    edits.patches = true;
    update_attachments();
}

void Solver::State::update_attachments()
{
    edits.attachments = edits.tethers = edits.pins = true;
    if (!device)
        return;
    attachment_lists = make_attachment_lists(model);
    dirty |= !attachments_fit() || !tethers_fit();
    update_passes();
}

void Solver::State::update_passes()
{
    if (!device)
        return;
    Passes next;
    next.pins = passes.pins;
    next.attachments = passes.attachments;
    next.tethers = passes.tethers;
    if (attachments_fit()) // else the list in the buffer is that of before
    {
        next.pins = attachment_lists.pins;
        next.attachments = static_cast<uint32_t>(attachment_lists.attachments.size()) - attachment_lists.pins;
    }
    if (tethers_fit())
        next.tethers = static_cast<uint32_t>(attachment_lists.tethers.size());
    for (const auto [index, collider] : collider_models.colliders)
        if (is_active(collider))
        {
            next.colliders = index + 1;
            add_passes(next, collider);
        }
    next.depenetration = next.depenetration && options.depenetration;
    for (const auto [index, cloth] : model.cloths)
        if (is_active(cloth))
            next.strain_spacing = std::max(next.strain_spacing, strain_spacing(cloth.record));
    next.contact = next.colliders > 0 || next.attachments > 0 || next.tethers > 0 || next.strain_spacing > 0;
    passes = next;
}

void Solver::State::update_collider(ColliderId collider, bool meets_others)
{
    edits.colliders.push_back(collider.index);
    edits.candidates |= meets_others;
    const ColliderModel* model_of = find(collider);
    if (options.feature_contact && model_of != nullptr && needs_features(*model_of, model))
        dirty = true;
    update_passes();
}

} // namespace voile
