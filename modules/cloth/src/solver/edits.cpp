// Edits: what the host changes between steps, recorded at the beginning of the next one.
#include "solver/solver_state.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace voile
{

namespace
{

constexpr VkPipelineStageFlags2KHR k_compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR;
constexpr VkAccessFlags2KHR k_storage =
    VK_ACCESS_2_SHADER_STORAGE_READ_BIT_KHR | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR;

constexpr uint32_t k_recovering_flags = VOILE_COLLIDER_CLOSED | VOILE_COLLIDER_ONE_SIDED;

template <typename T>
std::span<const std::byte> bytes_of(const std::vector<T>& values)
{
    return std::as_bytes(std::span(values));
}

// The anchors as the GPU sees them, one at a time: recording allocates nothing.
void update_anchors(gpu::Recorder& recorder, const Solver::State& solver)
{
    const DeviceState& device = *solver.device;
    const size_t count = std::min<size_t>(solver.anchors.size(), device.anchor_capacity);
    for (size_t i = 0; i < count; ++i)
    {
        const shared::AnchorRecord record = make_record(solver.anchors[i]);
        recorder.update(device[buffer::anchors].handle(), i * sizeof(record), std::as_bytes(std::span(&record, 1)));
    }
}

void update_colliders(gpu::Recorder& recorder, const Solver::State& solver)
{
    const DeviceState& device = *solver.device;
    for (uint32_t i = 0; i < device.collider_count; ++i)
    {
        if (!is_moving(solver.collider_models.colliders[i].record))
            continue;
        const shared::ColliderMotion motion =
            make_motion(solver.collider_models, i, solver.colliders[i], solver.deformations);
        recorder.update(device[buffer::collider_motions].handle(), i * sizeof(motion),
                        std::as_bytes(std::span(&motion, 1)));
    }
}

// What moves in a step, or did in the one before and must come to rest.
struct Moved
{
    bool anchors = false;
    bool colliders = false;
};

void update_buffers(gpu::Recorder& recorder, const Solver::State& solver, const Moved& moved)
{
    const DeviceState& device = *solver.device;
    for (const uint32_t cloth : solver.edits.records)
        if (cloth < device.cloth_count)
            recorder.update(device[buffer::cloths].handle(), cloth * sizeof(shared::ClothRecord),
                            std::as_bytes(std::span(&solver.model.cloths[cloth].record, 1)));
    if (solver.edits.attachments && !solver.dirty)
        recorder.update(device[buffer::attachments].handle(), 0, bytes_of(solver.attachment_lists.attachments));
    if (solver.edits.tethers && !solver.dirty)
        recorder.update(device[buffer::tethers].handle(), 0, bytes_of(solver.attachment_lists.tethers));
    for (const uint32_t collider : solver.edits.colliders)
        if (collider < device.collider_count)
            recorder.update(device[buffer::colliders].handle(), collider * sizeof(shared::ColliderRecord),
                            std::as_bytes(std::span(&solver.collider_models.colliders[collider].record, 1)));
    if (moved.anchors)
        update_anchors(recorder, solver);
    if (moved.colliders)
        update_colliders(recorder, solver);
}

// m, at most: how far a pose takes what lies within `radius` of `center`.
float way_of(const glm::mat4& from, const glm::mat4& to, const glm::dvec3& center, double radius)
{
    const glm::dmat4 change = glm::dmat4(to) - glm::dmat4(from);
    double squares = 0;
    for (int column = 0; column < 3; ++column)
        squares += glm::dot(glm::dvec3(change[column]), glm::dvec3(change[column]));
    return static_cast<float>(glm::length(glm::dvec3(change * glm::dvec4(center, 1))) + std::sqrt(squares) * radius);
}

// Of anchors, and of colliders that have no box, what lies within a meter of their origin counts.
float farthest_motion(const Solver::State& solver)
{
    float farthest = 0;
    for (const Anchor& anchor : solver.anchors)
        farthest = std::max(farthest, way_of(anchor.from, anchor.to, glm::dvec3(0), 1));
    for (size_t i = 0; i < solver.colliders.size(); ++i)
    {
        const ColliderPose& pose = solver.colliders[i];
        const shared::ColliderRecord& record = solver.collider_models.colliders[i].record;
        const bool has_box = record.kind == VOILE_COLLIDER_MESH;
        const glm::dvec3 center = has_box ? solver.collider_models.colliders[i].origin : glm::dvec3(0);
        const double radius = has_box ? static_cast<double>(0.5f * glm::distance(record.box_min, record.box_max)) : 1;
        farthest = std::max(farthest, way_of(pose.from, pose.to, center, radius));
    }
    return farthest;
}

} // namespace

shared::AnchorRecord make_record(const Anchor& anchor)
{
    const glm::mat4 motion = anchor.to == anchor.from ? glm::mat4(1) : anchor.to * glm::inverse(anchor.from);
    return {anchor.from, anchor.to, motion};
}

bool Solver::State::changes_due() const
{
    const bool lists = !dirty && (edits.attachments || edits.tethers);
    return lists || edits.pins || !edits.records.empty() || !edits.colliders.empty() ||
           std::any_of(edits.places.begin(), edits.places.end(),
                       [&](const shared::EditPush& edit) { return edit.cloth < device->cloth_count; });
}

bool Solver::State::fits() const
{
    return device && anchors.size() <= device->anchor_capacity &&
           attachment_lists.attachments.size() <= device->attachment_capacity &&
           attachment_lists.tethers.size() <= device->tether_capacity;
}

void Solver::State::update_attachments()
{
    edits.attachments = edits.tethers = edits.pins = true;
    if (dirty)
        return; // the next upload makes the lists: once, however many cloths are added before it
    attachment_lists = make_attachment_lists(model);
    if (!fits())
        dirty = true;
    update_passes();
}

void Solver::State::update_passes()
{
    if (!device)
        return;
    if (!dirty) // else the lists in the buffers are those of before
    {
        passes.pins = attachment_lists.pins;
        passes.attachments = static_cast<uint32_t>(attachment_lists.attachments.size()) - attachment_lists.pins;
        passes.tethers = static_cast<uint32_t>(attachment_lists.tethers.size());
    }
    const std::span present = std::span(collider_models.colliders).first(device->collider_count);
    const auto any_collider = [&](auto&& predicate)
    { return std::ranges::any_of(present, predicate, &ColliderModel::record); };
    passes.moving = any_collider(is_moving);
    passes.convex =
        any_collider([](const auto& collider)
                     { return collider.kind != VOILE_COLLIDER_MESH && collider.kind != VOILE_COLLIDER_PLANE; });
    passes.mesh_extent = 0;
    for (const ColliderModel& collider : present)
        passes.mesh_extent = std::max(passes.mesh_extent, collider.record.extent);
    passes.features = device->feature_count > 0;
    passes.recover =
        options.recovery &&
        (passes.convex || any_collider([](const auto& collider)
                                       { return (collider.flags & k_recovering_flags) == k_recovering_flags; }));
    passes.strain_spacing = 0;
    for (const ClothModel& cloth : std::span(model.cloths).first(device->cloth_count))
    {
        const shared::ClothRecord& record = cloth.record;
        if (record.strain_limit == 0)
            continue;
        // Half of the longer side and less; a mesh has as many passes as a grid of its size.
        const uint32_t side = record.columns > 0
                                  ? std::max(record.columns, record.rows)
                                  : static_cast<uint32_t>(std::sqrt(static_cast<double>(record.vertices)));
        passes.strain_spacing = std::max(passes.strain_spacing, std::bit_floor(std::max(side / 2, 1u)));
    }
    passes.commit = !present.empty() || passes.attachments > 0 || passes.tethers > 0 || passes.strain_spacing > 0;
}

void record_edits(gpu::Recorder& recorder, Solver::State& solver, const Step& step)
{
    if (solver.passes.features)
        solver.farthest_motion = farthest_motion(solver);
    const DeviceState& device = *solver.device;
    const uint32_t group = solver.options.tuning.workgroup_size;
    const auto moves = [](const auto& poses)
    { return std::any_of(poses.begin(), poses.end(), [](const auto& pose) { return pose.from != pose.to; }); };
    const bool deforms = std::ranges::any_of(std::span(solver.deformations).first(device.deforming_count),
                                             [](const Deformation& deformation) { return deformation.due; });
    const Moved now{moves(solver.anchors), moves(solver.colliders) || deforms};
    // Anchors that came to rest leave their pins with the velocity of the last step, colliders their surfaces.
    const Moved due{now.anchors || solver.anchors_moved || solver.edits.pins,
                    now.colliders || solver.colliders_moved || solver.refit_due || !solver.edits.colliders.empty()};
    if (!due.anchors && !due.colliders && !solver.changes_due())
        return;
    recorder.barrier(k_compute | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR,
                     VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR,
                     VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR,
                     VK_ACCESS_2_TRANSFER_READ_BIT_KHR | VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR);
    update_buffers(recorder, solver, due);
    record_deforming_input(recorder, solver);
    recorder.barrier(VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR, k_compute,
                     k_storage);
    record_deforming_passes(recorder, solver);
    const auto uploaded = [&](const shared::EditPush& edit) { return edit.cloth < device.cloth_count; };
    for (const shared::EditPush& edit : solver.edits.places)
        if (uploaded(edit))
            recorder.dispatch(solver.kernels.edit, device.sets.edit, solver.model.cloths[edit.cloth].record.vertices,
                              group, edit);
    const size_t edited = std::erase_if(solver.edits.places, uploaded);
    if (due.anchors || edited > 0)
        recorder.dispatch(solver.kernels.pins, device.sets.pins, solver.passes.pins, group,
                          shared::AttachmentPush{0, solver.passes.pins, step.duration, 0, 0});
    solver.history.normals_due |= edited > 0;
    solver.anchors_moved = now.anchors;
    solver.colliders_moved = now.colliders;
    for (Anchor& anchor : solver.anchors)
        anchor.from = anchor.to;
    for (ColliderPose& pose : solver.colliders)
        pose.from = pose.to;
    solver.edits.records.clear();
    solver.edits.colliders.clear();
    solver.edits.pins = false;
    if (!solver.dirty)
        solver.edits.attachments = solver.edits.tethers = false;
}

} // namespace voile
