// Removing, disabling and enabling cloths, colliders and anchors.
#include "solver/solver_state.hpp"

#include <algorithm>

namespace voile
{

Result<void> Solver::remove(ClothId cloth)
{
    State& s = *state_;
    if (auto exists = s.check(cloth); !exists)
        return exists;
    s.remove_outputs(cloth);
    if (s.find(cloth)->self_collision)
        s.wake_paired(); // it may have held others
    s.model.remove(cloth);
    s.edits.forget(cloth);
    s.update_patches();
    return {};
}

Result<void> Solver::remove(ColliderId collider)
{
    State& s = *state_;
    if (auto exists = s.check(collider); !exists)
        return exists;
    const std::optional<AnchorId> anchor = s.find(collider)->pose.anchor;
    s.wake_near(s.find(collider)->record.layers);
    s.collider_models.remove(collider);
    s.update_collider(collider, true);
    if (anchor)
        return remove(*anchor);
    return {};
}

Result<void> Solver::remove(AnchorId anchor)
{
    State& s = *state_;
    if (auto exists = check_anchor(s.model, anchor); !exists)
        return exists;
    for (auto [index, cloth] : s.model.cloths)
        s.remove_attachments(s.model.cloths.id_at(index), anchor);
    for (auto [index, collider] : s.collider_models.colliders)
        if (collider.pose.anchor == anchor)
            collider.pose.anchor.reset();
    s.model.anchors.remove(anchor);
    s.update_attachments();
    return {};
}

void Solver::State::remove_attachments(ClothId id, AnchorId anchor)
{
    ClothModel& cloth = *model.cloths.find(id);
    if (std::erase_if(cloth.attachments, [&](const Attachment& a) { return a.anchor == anchor; }) == 0)
        return;
    edits.state_edits.push_back({glm::mat4(1), glm::vec3(0), VOILE_EDIT_MASSES, id.index});
    if (cloth.tether_options)
        cloth.tethers = *make_tethers(cloth, id.index, *cloth.tether_options); // they were valid before
}

Result<void> Solver::set_enabled(ClothId cloth, bool enabled)
{
    State& s = *state_;
    if (auto exists = s.check(cloth); !exists)
        return exists;
    ClothModel& model = *s.model.cloths.find(cloth);
    if (model.enabled == enabled)
        return {};
    model.enabled = enabled;
    s.wake(model);
    if (model.self_collision)
        s.wake_paired();
    s.update_patches();
    return {};
}

Result<void> Solver::set_enabled(ColliderId collider, bool enabled)
{
    State& s = *state_;
    if (auto exists = s.check(collider); !exists)
        return exists;
    ColliderModel& model = *s.collider_models.colliders.find(collider);
    if (model.enabled == enabled)
        return {};
    model.enabled = enabled;
    s.update_collider(collider, true);
    return {};
}

bool Solver::enabled(ClothId cloth) const
{
    const ClothModel* model = state_->find(cloth);
    return model != nullptr && model->enabled;
}

bool Solver::enabled(ColliderId collider) const
{
    const ColliderModel* model = state_->find(collider);
    return model != nullptr && model->enabled;
}

} // namespace voile
