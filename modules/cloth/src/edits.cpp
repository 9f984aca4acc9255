// Edits: what the host changes between steps, recorded at the beginning of the next one.
#include "solver_state.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace cloth
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
    for (size_t i = 0; i < solver.anchors.size(); ++i)
    {
        const Anchor& anchor = solver.anchors[i];
        const glm::mat4 motion = anchor.to == anchor.from ? glm::mat4(1) : anchor.to * glm::inverse(anchor.from);
        const shared::AnchorRecord record{anchor.from, anchor.to, motion};
        update(recorder, solver.device->anchors, i * sizeof(record), std::as_bytes(std::span(&record, 1)));
    }
}

void update_colliders(gpu::Recorder& recorder, const Solver::State& solver)
{
    for (uint32_t i = 0; i < solver.colliders.size(); ++i)
    {
        if (!is_moving(solver.model.colliders[i]))
            continue;
        const shared::ColliderMotion motion = make_motion(solver.model, i, solver.colliders[i], solver.deformations);
        update(recorder, solver.device->collider_motions, i * sizeof(motion), std::as_bytes(std::span(&motion, 1)));
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
        update(recorder, device.cloths, cloth * sizeof(shared::ClothRecord),
               std::as_bytes(std::span(&solver.model.records[cloth], 1)));
    if (solver.edits.holds)
        update(recorder, device.holds, 0, bytes_of(solver.hold_lists.holds));
    if (solver.edits.tethers)
        update(recorder, device.tethers, 0, bytes_of(solver.hold_lists.tethers));
    for (const uint32_t collider : solver.edits.colliders)
        update(recorder, device.colliders, collider * sizeof(shared::ColliderRecord),
               std::as_bytes(std::span(&solver.model.colliders[collider], 1)));
    if (moved.anchors)
        update_anchors(recorder, solver);
    if (moved.colliders)
        update_colliders(recorder, solver);
}

// m, at most: how far a pose takes what lies within `radius` of `center`.
float way_of(const glm::mat4& from, const glm::mat4& to, const glm::vec3& center, float radius)
{
    const glm::mat4 change = to - from;
    float squares = 0;
    for (int column = 0; column < 3; ++column)
        squares += glm::dot(glm::vec3(change[column]), glm::vec3(change[column]));
    return glm::length(glm::vec3(change * glm::vec4(center, 1))) + std::sqrt(squares) * radius;
}

// Of anchors, and of colliders that have no box, what lies within a metre of their origin counts.
float farthest_motion(const Solver::State& solver)
{
    float farthest = 0;
    for (const Anchor& anchor : solver.anchors)
        farthest = std::max(farthest, way_of(anchor.from, anchor.to, glm::vec3(0), 1));
    for (size_t i = 0; i < solver.colliders.size(); ++i)
    {
        const ColliderPose& pose = solver.colliders[i];
        const shared::ColliderRecord& record = solver.model.colliders[i];
        const bool has_box = record.kind == VOILE_COLLIDER_MESH;
        const glm::vec3 center = has_box ? 0.5f * (record.box_min + record.box_max) : glm::vec3(0);
        const float radius = has_box ? 0.5f * glm::distance(record.box_min, record.box_max) : 1;
        farthest = std::max(farthest, way_of(pose.from, pose.to, center, radius));
    }
    return farthest;
}

} // namespace

void update(gpu::Recorder& recorder, const gpu::Buffer& buffer, VkDeviceSize offset, std::span<const std::byte> bytes)
{
    constexpr size_t k_most = 65536;
    while (!bytes.empty())
    {
        const auto piece = bytes.first(std::min(bytes.size(), k_most));
        recorder.context().fn.vkCmdUpdateBuffer(recorder.cmd(), buffer.handle(), offset, piece.size(), piece.data());
        offset += piece.size();
        bytes = bytes.subspan(piece.size());
    }
}

bool Solver::State::fits() const
{
    return device && anchors.size() <= device->anchor_capacity && hold_lists.holds.size() <= device->hold_capacity &&
           hold_lists.tethers.size() <= device->tether_capacity;
}

void Solver::State::update_holds()
{
    hold_lists = make_hold_lists(model);
    edits.holds = edits.tethers = edits.pins = true;
    if (!fits())
        dirty = true;
    update_passes();
}

void Solver::State::update_passes()
{
    if (dirty)
        return; // the next upload does it: until then the buffers are those of before
    passes.pins = hold_lists.pins;
    passes.holds = static_cast<uint32_t>(hold_lists.holds.size()) - hold_lists.pins;
    passes.tethers = static_cast<uint32_t>(hold_lists.tethers.size());
    passes.moving = std::any_of(model.colliders.begin(), model.colliders.end(), is_moving);
    passes.convex =
        std::any_of(model.colliders.begin(), model.colliders.end(),
                    [](const auto& collider)
                    { return collider.kind != VOILE_COLLIDER_MESH && collider.kind != VOILE_COLLIDER_PLANE; });
    passes.features = device && device->feature_count > 0;
    passes.recover =
        options.recovery &&
        (passes.convex ||
         std::any_of(model.colliders.begin(), model.colliders.end(),
                     [](const auto& collider) { return (collider.flags & k_recovering_flags) == k_recovering_flags; }));
    passes.strain_spacing = 0;
    for (const shared::ClothRecord& record : model.records)
    {
        if (record.strain_limit == 0)
            continue;
        // Half of the longer side and less; a mesh has as many passes as a grid of its size.
        const uint32_t side = record.columns > 0
                                  ? std::max(record.columns, record.rows)
                                  : static_cast<uint32_t>(std::sqrt(static_cast<double>(record.vertices)));
        passes.strain_spacing = std::max(passes.strain_spacing, std::bit_floor(std::max(side / 2, 1u)));
    }
    passes.commit = !model.colliders.empty() || passes.holds > 0 || passes.tethers > 0 || passes.strain_spacing > 0;
}

void record_edits(gpu::Recorder& recorder, Solver::State& solver, const Step& step)
{
    if (solver.passes.features)
        solver.farthest_motion = farthest_motion(solver);
    if (solver.dirty)
        return;
    const DeviceState& device = *solver.device;
    const uint32_t group = solver.options.workgroup_size;
    const auto moves = [](const auto& poses)
    { return std::any_of(poses.begin(), poses.end(), [](const auto& pose) { return pose.from != pose.to; }); };
    const bool deforms = std::any_of(solver.deformations.begin(), solver.deformations.end(),
                                     [](const Deformation& deformation) { return deformation.due; });
    const Moved now{moves(solver.anchors), moves(solver.colliders) || deforms};
    // Anchors that came to rest leave their pins with the velocity of the last step, colliders their surfaces.
    const Moved due{now.anchors || solver.anchors_moved || solver.edits.holds || solver.edits.pins,
                    now.colliders || solver.colliders_moved || solver.refit_due || !solver.edits.colliders.empty()};
    if (!due.anchors && !due.colliders && !solver.edits.any())
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
    for (const shared::EditPush& edit : solver.edits.places)
        recorder.dispatch(solver.kernels.edit, device.edit, solver.model.records[edit.cloth].vertices, group, edit);
    if (due.anchors || !solver.edits.places.empty())
        recorder.dispatch(solver.kernels.pins, device.pins, solver.passes.pins, group,
                          shared::HoldPush{0, solver.passes.pins, step.duration, 0, 0});
    solver.normals_due |= !solver.edits.places.empty();
    solver.anchors_moved = now.anchors;
    solver.colliders_moved = now.colliders;
    for (Anchor& anchor : solver.anchors)
        anchor.from = anchor.to;
    for (ColliderPose& pose : solver.colliders)
        pose.from = pose.to;
    solver.edits = {};
}

} // namespace cloth
