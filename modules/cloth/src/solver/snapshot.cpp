// Snapshot: a copy of the state of all cloths.
#include "solver/solver_state.hpp"

#include "shared/sleep_layout.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>

namespace voile
{

struct Snapshot::Contents
{
    gpu::Buffer buffer;  // one stream after the other, then depenetration's step
    uint64_t solver = 0; // its number
    std::vector<ClothId> cloths;
    uint32_t vertices = 0;           // of these
    uint32_t depenetration_step = 0; // modulo its period
    std::optional<uint64_t> changes; // of what may wake cloths, when it was saved; none: not known
    bool filled = false;
};

Snapshot::Snapshot(std::unique_ptr<Contents> contents) : contents_(std::move(contents)) {}
Snapshot::~Snapshot() = default;
Snapshot::Snapshot(Snapshot&&) noexcept = default;
Snapshot& Snapshot::operator=(Snapshot&&) noexcept = default;

std::span<const std::byte> Snapshot::bytes() const
{
    contents_->buffer.invalidate();
    return contents_->buffer.mapped();
}

namespace
{

// Positions, residuals and velocities are the first 40 bytes per vertex, one stream after the other. The scales of
// strain limits come last, before depenetration's step.
Result<void> check_finite(std::span<const std::byte> bytes, size_t vertices, size_t cloths)
{
    const auto load = [&](size_t offset)
    {
        float value = 0;
        std::memcpy(&value, bytes.data() + offset, sizeof(value));
        return value;
    };
    const size_t residuals = vertices * sizeof(glm::vec4);
    const size_t velocities = residuals + vertices * sizeof(glm::uvec2);
    for (size_t i = 0; i < vertices; ++i)
    {
        bool finite = std::isfinite(load(residuals + i * sizeof(glm::uvec2) + sizeof(uint32_t))); // their unit
        for (size_t k = 0; k < 4; ++k)
            finite = finite && std::isfinite(load((4 * i + k) * sizeof(float))) &&
                     std::isfinite(load(velocities + (4 * i + k) * sizeof(float)));
        if (!finite)
            return Error{"snapshot: vertex " + std::to_string(i) + " is not finite"};
    }
    const size_t scales = bytes.size() - sizeof(uint32_t) - scales_bytes(cloths);
    for (size_t offset = scales; offset + sizeof(uint32_t) < bytes.size(); offset += sizeof(float))
        if (!std::isfinite(load(offset)))
            return Error{"snapshot: what it has of the strain limit is not finite"};
    return {};
}

} // namespace

Result<void> Snapshot::assign(std::span<const std::byte> bytes)
{
    const std::span<std::byte> mapped = contents_->buffer.mapped();
    if (bytes.size() != mapped.size())
        return Error{"snapshot: " + std::to_string(bytes.size()) + " bytes, this solver's state has " +
                     std::to_string(mapped.size())};
    if (auto finite = check_finite(bytes, contents_->vertices, contents_->cloths.size()); !finite)
        return finite;
    std::copy(bytes.begin(), bytes.end(), mapped.begin());
    contents_->buffer.flush();
    std::memcpy(&contents_->depenetration_step, bytes.data() + bytes.size() - sizeof(uint32_t), sizeof(uint32_t));
    contents_->depenetration_step %= k_depenetration_period;
    contents_->changes.reset();
    contents_->filled = true;
    return {};
}

namespace
{

// A stream of the state: what one cloth has of it.
struct Stream
{
    buffer::Name buffer;
    VkDeviceSize bytes; // per vertex, or per cloth
    bool per_vertex;
};

// The streams of all vertices, and the data of depenetration and the strain limit that the next step needs.
std::array<Stream, 7> streams_of(uint32_t depenetration_step)
{
    return {{{buffer::positions, sizeof(glm::vec4), true},
             {buffer::residuals, sizeof(glm::uvec2), true},
             {buffer::velocities, sizeof(glm::vec4), true},
             {buffer::normals, sizeof(glm::vec4), true},
             {k_depenetration_votes[depenetration_step % 2], votes_bytes(1), false},
             {buffer::sleeps, sizeof(shared::SleepRecord), false},
             {buffer::limit_scales, scales_bytes(1), false}}};
}

// A part of the snapshot, and where it is on the device.
struct Region
{
    VkBuffer buffer;
    VkDeviceSize offset;          // bytes
    VkDeviceSize snapshot_offset; // bytes
    VkDeviceSize bytes;
};

// Stream by stream, and cloth by cloth; neighbors are one region.
std::vector<Region> regions_of(const Solver::State& solver, std::span<const ClothId> cloths,
                               uint32_t depenetration_step)
{
    std::vector<Region> regions;
    VkDeviceSize end = 0;
    for (const Stream& stream : streams_of(depenetration_step))
        for (const ClothId id : cloths)
        {
            const shared::ClothRecord& record = solver.find(id)->record;
            const VkBuffer buffer = (*solver.device)[stream.buffer].handle();
            const VkDeviceSize offset = stream.bytes * (stream.per_vertex ? record.first_vertex : id.index);
            const VkDeviceSize bytes = stream.bytes * (stream.per_vertex ? record.vertices : 1);
            if (!regions.empty() && regions.back().buffer == buffer &&
                regions.back().offset + regions.back().bytes == offset)
                regions.back().bytes += bytes;
            else
                regions.push_back({buffer, offset, end, bytes});
            end += bytes;
        }
    return regions;
}

VkDeviceSize total_bytes(uint32_t vertices, size_t cloths)
{
    VkDeviceSize bytes = sizeof(uint32_t);
    for (const Stream& stream : streams_of(0))
        bytes += stream.bytes * (stream.per_vertex ? vertices : cloths);
    return bytes;
}

std::vector<ClothId> uploaded_cloths(const Model& model)
{
    std::vector<ClothId> ids;
    for (const auto [index, cloth] : model.cloths)
        if (cloth.uploaded)
            ids.push_back(model.cloths.id_at(index));
    return ids;
}

// `number`: of the solver that made the snapshot, for `cloths`. Errors: another solver; cloths were uploaded or removed
// since.
Result<void> check_cloths(const Solver::State& solver, uint64_t number, std::span<const ClothId> cloths)
{
    if (solver.number != number)
        return Error{"snapshot: it was made by another solver"};
    if (!std::ranges::equal(uploaded_cloths(solver.model), cloths))
        return Error{"snapshot: it was made for other cloths: some were uploaded or removed since"};
    return {};
}

// Copies wait for compute, the host's stages and earlier copies; what follows waits for them.
void barrier(const gpu::Context& context, const SolverOptions& options, VkCommandBuffer cmd, bool before)
{
    const HostScopes scopes = host_scopes(options);
    const VkPipelineStageFlags2KHR users = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR |
                                           VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR | VK_PIPELINE_STAGE_2_HOST_BIT_KHR |
                                           (before ? scopes.before.stages : scopes.after.stages);
    constexpr VkPipelineStageFlags2KHR k_copy = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR;
    constexpr VkAccessFlags2KHR k_copies = VK_ACCESS_2_TRANSFER_READ_BIT_KHR | VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR;
    gpu::Recorder recorder(context, cmd);
    if (before)
        recorder.barrier(users, VK_ACCESS_2_MEMORY_WRITE_BIT_KHR, k_copy, k_copies);
    else
        recorder.barrier(k_copy, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR, users,
                         VK_ACCESS_2_MEMORY_READ_BIT_KHR | VK_ACCESS_2_MEMORY_WRITE_BIT_KHR);
}

} // namespace

uint64_t Solver::State::next_number()
{
    static std::atomic<uint64_t> numbers = 0;
    return ++numbers;
}

Result<Snapshot> Solver::create_snapshot() const
{
    auto contents = std::make_unique<Snapshot::Contents>();
    contents->solver = state_->number;
    contents->cloths = uploaded_cloths(state_->model);
    if (contents->cloths.empty())
        return Error{"snapshot: nothing has been uploaded yet"};
    for (const ClothId cloth : contents->cloths)
        contents->vertices += state_->find(cloth)->record.vertices;
    auto buffer =
        gpu::create_buffer(state_->context, "cloth snapshot", total_bytes(contents->vertices, contents->cloths.size()),
                           VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::readback);
    if (!buffer)
        return buffer.error();
    contents->buffer = std::move(buffer.value());
    return Snapshot(std::move(contents));
}

Result<void> Solver::record_save(VkCommandBuffer cmd, const Snapshot& snapshot) const
{
    if (auto same = check_cloths(*state_, snapshot.contents_->solver, snapshot.contents_->cloths); !same)
        return same;
    const uint32_t step = state_->history.depenetration_step % k_depenetration_period;
    const VkBuffer buffer = snapshot.contents_->buffer.handle();
    snapshot.contents_->filled = true;
    snapshot.contents_->depenetration_step = step;
    snapshot.contents_->changes = state_->changes;
    state_->lifetime.begin(cmd);
    barrier(state_->context, state_->options, cmd, true);
    VkDeviceSize end = 0;
    for (const Region& region : regions_of(*state_, snapshot.contents_->cloths, step))
    {
        const VkBufferCopy copy{region.offset, region.snapshot_offset, region.bytes};
        state_->context.fn.vkCmdCopyBuffer(cmd, region.buffer, buffer, 1, &copy);
        end = region.snapshot_offset + region.bytes;
    }
    state_->context.fn.vkCmdUpdateBuffer(cmd, buffer, end, sizeof(step), &step);
    barrier(state_->context, state_->options, cmd, false);
    state_->lifetime.end(cmd);
    state_->history.depenetration_due = true; // as after restoring, so that both continue the same way
    state_->history.forget_pairs();
    return {};
}

Result<void> Solver::record_restore(VkCommandBuffer cmd, const Snapshot& snapshot)
{
    if (auto same = check_cloths(*state_, snapshot.contents_->solver, snapshot.contents_->cloths); !same)
        return same;
    if (!snapshot.contents_->filled)
        return Error{"snapshot: nothing was saved in it"};
    state_->lifetime.begin(cmd);
    barrier(state_->context, state_->options, cmd, true);
    const DeviceState& device = *state_->device;
    const bool keeps_previous = state_->options.output.previous_positions;
    for (const Region& region : regions_of(*state_, snapshot.contents_->cloths, snapshot.contents_->depenetration_step))
    {
        const VkBufferCopy copy{region.snapshot_offset, region.offset, region.bytes};
        state_->context.fn.vkCmdCopyBuffer(cmd, snapshot.contents_->buffer.handle(), region.buffer, 1, &copy);
        if (keeps_previous && region.buffer == device[buffer::positions].handle())
            state_->context.fn.vkCmdCopyBuffer(cmd, snapshot.contents_->buffer.handle(),
                                               device[buffer::previous_positions].handle(), 1, &copy);
    }
    barrier(state_->context, state_->options, cmd, false);
    state_->lifetime.end(cmd);
    state_->history.depenetration_step = snapshot.contents_->depenetration_step;
    state_->history.depenetration_due = true;
    state_->history.forget_pairs();
    if (snapshot.contents_->changes != state_->changes)
        for (auto [index, cloth] : state_->model.cloths)
            state_->wake(cloth);
    state_->edits.masses = state_->edits.pins = true; // materials and pins may have changed since it was saved
    return {};
}

} // namespace voile
