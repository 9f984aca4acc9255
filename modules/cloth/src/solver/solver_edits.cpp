// Changes of cloths and anchors by the host. Each is validated here and recorded by edits.cpp.
#include "solver/solver_state.hpp"

#include <cmath>
#include <utility>

namespace voile
{

namespace
{

// A cloth keeps its kind of masses: the measure that the density multiplies is fixed when the cloth is added.
Result<void> check_kind(const ClothModel& cloth, const ClothMaterial& material)
{
    if (cloth.material.index() != material.index())
        return invalid("cloth", cloth.name,
                       cloth.material.index() == 0 ? "it was added with a Fabric and stays one"
                                                   : "it was added with a Material and keeps masses of its own");
    if (cloth.mesh && bends_isometrically(material) && !cloth.mesh->isometric)
        return invalid("cloth", cloth.name, "isometric bending of a mesh must be there when the mesh is added");
    if (auto valid = std::visit([](const auto& m) { return validate(m); }, material); !valid)
        return invalid("cloth", cloth.name, valid.error().message);
    return {};
}

Result<void> check_frame(const std::string& what, const glm::mat4& world_from_anchor)
{
    if (auto valid = check_bounded(what, world_from_anchor, k_most_coordinate); !valid)
        return valid;
    const float volume = std::abs(glm::determinant(glm::mat3(world_from_anchor)));
    return check(what, {"its transform's determinant", volume, k_least_anchor_volume, std::pow(k_most_scale, 3.f)});
}

void add_state_edit(Edits& edits, ClothId cloth, uint32_t kind, const glm::mat4& transform, const glm::vec3& velocity)
{
    edits.state_edits.push_back({transform, velocity, kind, cloth.index});
}

} // namespace

Result<void> Solver::set_material(ClothId cloth, const ClothMaterial& material)
{
    State& s = *state_;
    if (auto exists = s.check(cloth); !exists)
        return exists;
    ClothModel& model = *s.model.cloths.find(cloth);
    if (auto valid = check_kind(model, material); !valid)
        return valid;
    const bool heavier = density(material) != density(model.material);
    const bool was_limited = model.record.strain_limit > 0;
    model.material = material;
    apply_material(model);
    s.edits.records.insert(cloth.index);
    if (!was_limited && model.record.strain_limit > 0)
        s.edits.limits.insert(cloth.index);
    if (heavier)
        add_state_edit(s.edits, cloth, VOILE_EDIT_MASSES, glm::mat4(1), glm::vec3(0));
    s.update_passes();
    return {};
}

const ClothMaterial& Solver::material(ClothId cloth) const
{
    static const ClothMaterial k_none;
    const ClothModel* model = state_->find(cloth);
    return model != nullptr ? model->material : k_none;
}

Result<void> Solver::set_attachments(ClothId cloth, std::span<const Attachment> attachments)
{
    State& s = *state_;
    if (auto exists = s.check(cloth); !exists)
        return exists;
    ClothModel& model = *s.model.cloths.find(cloth);
    if (auto valid = validate_attachments(s.model, model, attachments); !valid)
        return valid;
    std::vector<Attachment> before =
        std::exchange(model.attachments, std::vector<Attachment>(attachments.begin(), attachments.end()));
    if (auto applied = s.apply_attachments(cloth); !applied)
    {
        model.attachments = std::move(before);
        return applied;
    }
    add_state_edit(s.edits, cloth, VOILE_EDIT_MASSES, glm::mat4(1),
                   glm::vec3(0)); // of vertices that are no longer pinned
    return {};
}

Result<void> Solver::set_attachments(ClothId cloth, std::initializer_list<Attachment> attachments)
{
    return set_attachments(cloth, std::span(attachments.begin(), attachments.size()));
}

const std::vector<Attachment>& Solver::attachments(ClothId cloth) const
{
    static const std::vector<Attachment> k_none;
    const ClothModel* model = state_->find(cloth);
    return model != nullptr ? model->attachments : k_none;
}

Result<void> Solver::set_tethers(ClothId cloth, const std::optional<Tethers>& tethers)
{
    State& s = *state_;
    if (auto exists = s.check(cloth); !exists)
        return exists;
    ClothModel& model = *s.model.cloths.find(cloth);
    if (tethers && !has_pin(model))
        return invalid("cloth", model.name, "tethers need a pin, and it has none");
    const std::optional<Tethers> before = std::exchange(model.tether_options, tethers);
    auto applied = s.apply_attachments(cloth);
    if (!applied)
        model.tether_options = before;
    return applied;
}

Result<void> Solver::State::apply_attachments(ClothId id)
{
    ClothModel& cloth = *model.cloths.find(id);
    std::vector<shared::TetherRecord> tethers;
    if (cloth.tether_options)
    {
        auto made = make_tethers(cloth, id.index, *cloth.tether_options);
        if (!made)
            return made.error();
        tethers = std::move(made.value());
    }
    if (auto room = reserve_attachments(); !room)
        return room;
    cloth.tethers = std::move(tethers);
    wake(cloth);
    update_attachments();
    return {};
}

Result<void> Solver::State::reserve_attachments()
{
    if (!device)
        return {};
    const AttachmentCounts attached = count_attachments(model);
    BufferCounts needed = device->capacities;
    needed.vertices = device->vertices;
    needed.colliders = device->collider_count;
    needed.anchors = attached.anchors;
    needed.attachments = attached.attachments;
    needed.tethers = attached.tethers;
    auto growth = grow(context, kernels, &*device, needed, statistics, options.output.usage);
    if (!growth)
        return growth.error();
    if (growth.value().any)
        replace_buffers(std::move(growth.value()));
    return {};
}

Result<AnchorId> Solver::add_anchor(const glm::mat4& world_from_anchor)
{
    State& s = *state_;
    if (auto valid = check_frame("anchor", world_from_anchor); !valid)
        return valid.error();
    const AnchorId id = s.model.anchors.add({world_from_anchor, world_from_anchor, world_from_anchor});
    if (auto room = s.reserve_attachments(); !room)
    {
        s.model.anchors.remove(id);
        return room.error();
    }
    s.edits.pins = true;
    return id;
}

Result<void> Solver::move_anchor(AnchorId anchor, const glm::mat4& world_from_anchor)
{
    State& s = *state_;
    if (auto exists = check_anchor(s.model, anchor); !exists)
        return exists;
    if (auto valid = check_frame("anchor " + std::to_string(anchor.index), world_from_anchor); !valid)
        return valid;
    s.model.anchors.find(anchor)->to = world_from_anchor;
    return {};
}

Result<void> Solver::teleport(AnchorId anchor, const glm::mat4& world_from_anchor)
{
    if (auto moved = move_anchor(anchor, world_from_anchor); !moved)
        return moved;
    jump(*state_->model.anchors.find(anchor));
    return {};
}

Result<void> Solver::reset(ClothId cloth)
{
    if (auto exists = state_->check(cloth); !exists)
        return exists;
    add_state_edit(state_->edits, cloth, VOILE_EDIT_RESET, glm::mat4(1), state_->find(cloth)->velocity);
    state_->edits.limits.insert(cloth.index); // no reserve of energy
    return {};
}

Result<void> Solver::teleport(ClothId cloth, const glm::mat4& transform)
{
    if (auto exists = state_->check(cloth); !exists)
        return exists;
    if (auto valid = check_bounded(subject("cloth", name(cloth)), transform, 2 * k_most_coordinate); !valid)
        return valid;
    add_state_edit(state_->edits, cloth, VOILE_EDIT_TRANSFORM, transform, glm::vec3(0));
    return {};
}

Result<void> Solver::set_velocity(ClothId cloth, const glm::vec3& velocity)
{
    if (auto exists = state_->check(cloth); !exists)
        return exists;
    if (auto valid = check(subject("cloth", name(cloth)), "velocity", velocity, k_most_speed, " m/s"); !valid)
        return valid;
    add_state_edit(state_->edits, cloth, VOILE_EDIT_VELOCITY, glm::mat4(1), velocity);
    return {};
}

} // namespace voile
