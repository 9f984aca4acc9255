// Edits: changes by the host, recorded at the beginning of the next step.
#include "solver/sleep.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace voile
{

namespace
{

template <typename T>
std::span<const std::byte> bytes_of(const std::vector<T>& values)
{
    return std::as_bytes(std::span(values));
}

// Updates records of a buffer, neighbors with one command: thousands of commands take a GPU milliseconds. It allocates
// nothing.
template <typename Record>
class RecordWriter
{
public:
    RecordWriter(gpu::Recorder& recorder, VkBuffer buffer) : recorder_(recorder), buffer_(buffer) {}
    ~RecordWriter() { flush(); }
    RecordWriter(const RecordWriter&) = delete;
    RecordWriter& operator=(const RecordWriter&) = delete;

    void write(uint32_t index, const Record& record)
    {
        if (count_ == records_.size() || index != first_ + count_)
            flush();
        if (count_ == 0)
            first_ = index;
        records_[count_++] = record;
    }

private:
    void flush()
    {
        if (count_ == 0)
            return;
        recorder_.update(buffer_, first_ * sizeof(Record), std::as_bytes(std::span(records_).first(count_)));
        count_ = 0;
    }

    static constexpr size_t k_bytes = 16384; // on the stack
    gpu::Recorder& recorder_;
    VkBuffer buffer_;
    std::array<Record, k_bytes / sizeof(Record)> records_;
    uint32_t first_ = 0;
    uint32_t count_ = 0;
};

void update_anchors(gpu::Recorder& recorder, const Solver::State& solver)
{
    RecordWriter<shared::AnchorRecord> writer(recorder, (*solver.device)[buffer::anchors].handle());
    for (const auto [index, anchor] : solver.model.anchors)
        writer.write(index, make_record(anchor));
}

void update_motions(gpu::Recorder& recorder, const Solver::State& solver)
{
    RecordWriter<shared::ColliderMotion> writer(recorder, (*solver.device)[buffer::collider_motions].handle());
    for (const auto [index, collider] : solver.collider_models.colliders)
        if (collider.uploaded && is_moving(collider.record))
            writer.write(index, make_motion(collider));
}

// Records of cloths whose strain limit changed with the step. A new limit has no reserve of energy.
void update_softened(gpu::Recorder& recorder, Solver::State& solver)
{
    const DeviceState& device = *solver.device;
    for (auto [index, cloth] : solver.model.cloths)
    {
        const bool limit = std::exchange(cloth.limit_due, false);
        if ((!std::exchange(cloth.softening_due, false) && !limit) || !cloth.uploaded)
            continue;
        if (!solver.edits.records.contains(index)) // else it is written already
            recorder.update(device[buffer::cloths].handle(), index * sizeof(shared::ClothRecord),
                            std::as_bytes(std::span(&cloth.record, 1)));
        if (limit && !solver.edits.limits.contains(index))
            recorder.update(device[buffer::limit_scales].handle(), index * sizeof(k_first_scale),
                            std::as_bytes(std::span(&k_first_scale, 1)));
    }
}

void update_records(gpu::Recorder& recorder, Solver::State& solver)
{
    const DeviceState& device = *solver.device;
    for (const uint32_t index : solver.edits.records)
        if (const ClothModel* cloth = solver.model.cloths.at(index); cloth != nullptr && cloth->uploaded)
            recorder.update(device[buffer::cloths].handle(), index * sizeof(shared::ClothRecord),
                            std::as_bytes(std::span(&cloth->record, 1)));
    for (const uint32_t index : solver.edits.limits)
        if (const ClothModel* cloth = solver.model.cloths.at(index); cloth != nullptr && cloth->uploaded)
            recorder.update(device[buffer::limit_scales].handle(), index * sizeof(k_first_scale),
                            std::as_bytes(std::span(&k_first_scale, 1)));
    if (solver.edits.softened)
        update_softened(recorder, solver);
    RecordWriter<shared::ColliderRecord> colliders(recorder, device[buffer::colliders].handle());
    for (const uint32_t index : solver.edits.colliders)
    {
        if (index >= device.collider_count)
            continue;
        const ColliderModel* collider = solver.collider_models.colliders.at(index);
        colliders.write(index,
                        collider != nullptr && collider->uploaded ? shown_record(*collider) : shared::ColliderRecord{});
    }
}

// What moves in this step, or moved in the step before and must be set to rest.
struct Moved
{
    bool anchors = false;
    bool colliders = false;
};

bool is_uploaded(const Solver::State& solver, const shared::EditPush& edit)
{
    const ClothModel* cloth = solver.model.cloths.at(edit.cloth);
    return cloth != nullptr && cloth->uploaded;
}

bool jumps(const shared::EditPush& edit)
{
    return edit.kind == VOILE_EDIT_RESET || edit.kind == VOILE_EDIT_TRANSFORM;
}

// Vertices of a cloth that jumps may begin inside solids. A word is written once, however often its cloth jumps.
void update_votes(gpu::Recorder& recorder, const Solver::State& solver)
{
    constexpr uint32_t k_began = 1;
    const VkBuffer votes = (*solver.device)[k_depenetration_votes[solver.history.depenetration_step % 2]].handle();
    const std::span edits(solver.edits.state_edits);
    for (size_t i = 0; i < edits.size(); ++i)
    {
        const uint32_t cloth = edits[i].cloth;
        const auto is_jump = [&](const shared::EditPush& edit) { return edit.cloth == cloth && jumps(edit); };
        if (is_jump(edits[i]) && is_uploaded(solver, edits[i]) && std::ranges::none_of(edits.first(i), is_jump))
            recorder.update(votes, (cloth * VOILE_VOTE_WORDS + VOILE_VOTE_BEGAN) * sizeof(k_began),
                            std::as_bytes(std::span(&k_began, 1)));
    }
}

void update_buffers(gpu::Recorder& recorder, Solver::State& solver, const Moved& moved)
{
    const DeviceState& device = *solver.device;
    update_records(recorder, solver);
    update_votes(recorder, solver);
    record_woken(recorder, solver);
    if (solver.edits.patches)
        record_patches(recorder, solver);
    if (solver.edits.attachments)
    {
        recorder.update(device[buffer::attachments].handle(), 0, bytes_of(solver.lists.attachments));
        recorder.update(device[buffer::tethers].handle(), 0, bytes_of(solver.lists.tethers));
    }
    if (moved.anchors)
        update_anchors(recorder, solver);
    if (moved.colliders)
        update_motions(recorder, solver);
}

// m: a bound for the displacement of points within `radius` of `center`.
float displacement_bound(const glm::mat4& from, const glm::mat4& to, const glm::dvec3& center, double radius)
{
    const glm::dmat4 change = glm::dmat4(to) - glm::dmat4(from);
    double squares = 0;
    for (int column = 0; column < 3; ++column)
        squares += glm::dot(glm::dvec3(change[column]), glm::dvec3(change[column]));
    return static_cast<float>(glm::length(glm::dvec3(change * glm::dvec4(center, 1))) + std::sqrt(squares) * radius);
}

// m, of the anchors that hold a cloth.
float farthest_anchor_motion(const Model& model)
{
    float farthest = 0;
    const Anchor* last = nullptr; // most cloths hang from few anchors
    for (const auto [index, cloth] : model.cloths)
        for (const Attachment& attachment : cloth.attachments)
        {
            const Anchor* anchor =
                cloth.enabled && attachment.anchor ? model.anchors.find(*attachment.anchor) : nullptr;
            if (anchor == last || anchor == nullptr)
                continue;
            last = anchor;
            if (anchor->from != anchor->to)
                farthest = std::max(farthest, displacement_bound(anchor->from, anchor->to, glm::dvec3(0), 1));
        }
    return farthest;
}

Moved find_moved(const Solver::State& solver)
{
    Moved moved;
    moved.anchors = anchors_move(solver.model);
    for (const auto [index, collider] : solver.collider_models.colliders)
        moved.colliders |= collider.pose.jumped || collider.pose.from != collider.pose.to ||
                           (collider.uploaded && collider.deforming && collider.deforming->due);
    return moved;
}

bool refit_due(const Solver::State& solver)
{
    for (const auto [index, collider] : solver.collider_models.colliders)
        if (collider.uploaded && collider.deforming && collider.deforming->refit_due)
            return true;
    return false;
}

// Anchors and colliders rest at the end of their motion, unless they are moved again.
void finish_motions(Solver::State& solver)
{
    for (auto [index, anchor] : solver.model.anchors)
    {
        anchor.from = anchor.to;
        anchor.jumped = false;
    }
    for (auto [index, collider] : solver.collider_models.colliders)
    {
        collider.pose.from = collider.pose.to;
        collider.pose.jumped = false;
    }
}

void finish_edits(Solver::State& solver)
{
    Edits& edits = solver.edits;
    edits.records.clear();
    edits.limits.clear();
    edits.colliders.clear();
    edits.softened = edits.attachments = edits.pins = edits.masses = edits.candidates = false;
}

// A vertex that kept its mass is left as it is, to the bit.
void record_masses(gpu::Recorder& recorder, const Solver::State& solver)
{
    for (const auto [index, cloth] : solver.model.cloths)
        if (cloth.uploaded)
            recorder.dispatch(solver.kernels.edit, solver.device->sets.edit, cloth.record.vertices,
                              solver.options.tuning.workgroup_size,
                              shared::EditPush{glm::mat4(1), glm::vec3(0), VOILE_EDIT_MASSES, index});
}

// The edits of uploaded cloths. Returns how many there were.
size_t record_state_edits(gpu::Recorder& recorder, Solver::State& solver)
{
    const auto uploaded = [&](const shared::EditPush& edit) { return is_uploaded(solver, edit); };
    for (const shared::EditPush& edit : solver.edits.state_edits)
        if (uploaded(edit))
        {
            ClothModel& cloth = *solver.model.cloths.at(edit.cloth);
            cloth.jumped |= jumps(edit);
            recorder.dispatch(solver.kernels.edit, solver.device->sets.edit, cloth.record.vertices,
                              solver.options.tuning.workgroup_size, edit);
        }
    return std::erase_if(solver.edits.state_edits, uploaded);
}

// `duration`: s, of the step; 0: the pins do not move.
void record_pins(gpu::Recorder& recorder, const Solver::State& solver, EntryRange pins, float duration)
{
    if (pins.count > 0)
        recorder.dispatch(solver.kernels.pins, solver.device->sets.pins, pins.count,
                          solver.options.tuning.workgroup_size, shared::PinPush{pins.first, pins.count, duration});
}

} // namespace

shared::AnchorRecord make_record(const Anchor& anchor)
{
    const glm::mat4 motion = anchor.to == anchor.from ? glm::mat4(1) : anchor.to * glm::inverse(anchor.from);
    return {anchor.from, anchor.to, motion};
}

void Edits::forget(ClothId cloth)
{
    records.erase(cloth.index);
    limits.erase(cloth.index);
    std::erase_if(state_edits, [&](const shared::EditPush& edit) { return edit.cloth == cloth.index; });
}

bool Solver::State::changes_due() const
{
    return edits.softened || edits.attachments || edits.woken || edits.patches || edits.pins || edits.candidates ||
           !edits.records.empty() || !edits.colliders.empty() ||
           std::ranges::any_of(edits.state_edits,
                               [&](const shared::EditPush& edit) { return is_uploaded(*this, edit); });
}

void record_patches(gpu::Recorder& recorder, Solver::State& solver)
{
    DeviceState& device = *solver.device;
    recorder.update(device[buffer::patches].handle(), 0, bytes_of(solver.lists.patches));
    device.patch_count = static_cast<uint32_t>(solver.lists.patches.size());
    recorder.update(device[buffer::cloth_trees].handle(), 0, bytes_of(solver.lists.trees));
    device.tree_counts = solver.lists.tree_counts;
    solver.edits.patches = false;
}

bool anchors_move(const Model& model)
{
    for (const auto [index, anchor] : model.anchors)
        if (anchor.jumped || anchor.from != anchor.to)
            return true;
    return false;
}

float farthest_motion(const Solver::State& solver)
{
    if (!solver.passes.features && !solver.passes.pairs)
        return 0; // nothing asks for it
    float farthest = anchors_move(solver.model) ? farthest_anchor_motion(solver.model) : 0;
    for (const auto [index, collider] : solver.collider_models.colliders)
    {
        const shared::ColliderRecord& record = collider.record;
        const bool has_box = record.kind == VOILE_COLLIDER_MESH;
        const glm::dvec3 center = has_box ? collider.origin : glm::dvec3(0);
        const double radius = has_box ? static_cast<double>(0.5f * glm::distance(record.box_min, record.box_max)) : 1;
        farthest = std::max(farthest, displacement_bound(collider.pose.from, collider.pose.to, center, radius));
        if (collider.deforming && collider.deforming->due)
            farthest = std::max(farthest, collider.deforming->farthest);
    }
    return farthest;
}

void record_edits(gpu::Recorder& recorder, Solver::State& solver, const Step& step)
{
    const DeviceState& device = *solver.device;
    const Moved now = find_moved(solver);
    // Anchors that came to rest leave their pins with the velocity of the last step, colliders their surfaces.
    const Moved due{now.anchors || solver.anchors_moved || solver.edits.pins,
                    now.colliders || solver.colliders_moved || refit_due(solver) || !solver.edits.colliders.empty()};
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
    if (solver.edits.candidates)
        forget_candidates(recorder, device);
    record_deforming_passes(recorder, solver);
    if (solver.edits.masses)
        record_masses(recorder, solver);
    const size_t edited = record_state_edits(recorder, solver);
    if (due.anchors || edited > 0)
        record_pins(recorder, solver, {0, solver.lists.pins}, step.duration);
    if (solver.edits.pins || solver.edits.masses || edited > 0)
        record_pins(recorder, solver, solver.lists.resting_pins, 0);
    solver.history.normals_due |= edited > 0;
    if (edited > 0)
        solver.history.forget_pairs();
    solver.anchors_moved = now.anchors;
    solver.colliders_moved = now.colliders;
    finish_motions(solver);
    finish_edits(solver);
}

} // namespace voile
