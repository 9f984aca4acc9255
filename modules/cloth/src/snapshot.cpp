// Snapshot: the state of all cloths, kept to go back to.
#include "solver_state.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace cloth
{

struct Snapshot::Contents
{
    gpu::Buffer buffer; // one stream after the other
    uint32_t vertices = 0;
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

// Positions, residuals and velocities stand in the first 40 bytes per vertex, one stream after the other.
Result<void> check_finite(std::span<const std::byte> bytes, size_t vertices)
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
        bool finite = std::isfinite(load(residuals + i * sizeof(glm::uvec2) + sizeof(uint32_t))); // what they count in
        for (size_t k = 0; k < 4; ++k)
            finite = finite && std::isfinite(load((4 * i + k) * sizeof(float))) &&
                     std::isfinite(load(velocities + (4 * i + k) * sizeof(float)));
        if (!finite)
            return Error{"snapshot: vertex " + std::to_string(i) + " is not finite"};
    }
    return {};
}

} // namespace

Result<void> Snapshot::assign(std::span<const std::byte> bytes)
{
    const std::span<std::byte> mapped = contents_->buffer.mapped();
    if (bytes.size() != mapped.size())
        return Error{"snapshot: " + std::to_string(bytes.size()) + " bytes, this solver's state has " +
                     std::to_string(mapped.size())};
    if (auto finite = check_finite(bytes, contents_->vertices); !finite)
        return finite;
    std::copy(bytes.begin(), bytes.end(), mapped.begin());
    contents_->buffer.flush();
    contents_->filled = true;
    return {};
}

namespace
{

struct Stream
{
    VkBuffer buffer;
    VkDeviceSize bytes_per_vertex;
};

std::array<Stream, 4> streams_of(const DeviceState& device)
{
    return {{{device.state.positions.handle(), sizeof(glm::vec4)},
             {device.state.residuals.handle(), sizeof(glm::uvec2)},
             {device.state.velocities.handle(), sizeof(glm::vec4)},
             {device.normals.handle(), sizeof(glm::vec4)}}};
}

VkDeviceSize total_bytes(const DeviceState& device)
{
    VkDeviceSize bytes = 0;
    for (const Stream& stream : streams_of(device))
        bytes += stream.bytes_per_vertex * device.vertices;
    return bytes;
}

// Copies wait for compute, vertex input and earlier copies; what follows waits for them.
void barrier(const gpu::Context& context, VkCommandBuffer cmd, bool before)
{
    constexpr VkPipelineStageFlags2KHR k_users =
        VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR | VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT_KHR |
        VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR | VK_PIPELINE_STAGE_2_HOST_BIT_KHR;
    constexpr VkPipelineStageFlags2KHR k_copy = VK_PIPELINE_STAGE_2_COPY_BIT_KHR;
    constexpr VkAccessFlags2KHR k_copies = VK_ACCESS_2_TRANSFER_READ_BIT_KHR | VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR;
    gpu::Recorder recorder(context, cmd);
    if (before)
        recorder.barrier(k_users, VK_ACCESS_2_MEMORY_WRITE_BIT_KHR, k_copy, k_copies);
    else
        recorder.barrier(k_copy, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR, k_users,
                         VK_ACCESS_2_MEMORY_READ_BIT_KHR | VK_ACCESS_2_MEMORY_WRITE_BIT_KHR);
}

} // namespace

Result<Snapshot> Solver::create_snapshot() const
{
    if (!state_->device || state_->device->vertices == 0)
        return Error{"snapshot: nothing has been uploaded yet"};
    auto contents = std::make_unique<Snapshot::Contents>();
    contents->vertices = state_->device->vertices;
    auto buffer =
        gpu::create_buffer(state_->context, "cloth snapshot", total_bytes(*state_->device),
                           VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::readback);
    if (!buffer)
        return buffer.error();
    contents->buffer = std::move(buffer.value());
    return Snapshot(std::move(contents));
}

Result<void> Solver::record_save(VkCommandBuffer cmd, const Snapshot& snapshot) const
{
    const uint32_t vertices = snapshot.contents_->vertices;
    if (!state_->device || state_->device->vertices != vertices)
        return Error{"snapshot: it was made for another number of vertices"};
    snapshot.contents_->filled = true;
    state_->lifetime.begin(cmd);
    barrier(state_->context, cmd, true);
    VkDeviceSize offset = 0;
    for (const Stream& stream : streams_of(*state_->device))
    {
        const VkBufferCopy region{0, offset, stream.bytes_per_vertex * vertices};
        state_->context.fn.vkCmdCopyBuffer(cmd, stream.buffer, snapshot.contents_->buffer.handle(), 1, &region);
        offset += region.size;
    }
    barrier(state_->context, cmd, false);
    state_->lifetime.end(cmd);
    return {};
}

Result<void> Solver::record_restore(VkCommandBuffer cmd, const Snapshot& snapshot)
{
    const uint32_t vertices = snapshot.contents_->vertices;
    if (!state_->device || state_->device->vertices != vertices)
        return Error{"snapshot: it was made for another number of vertices"};
    if (!snapshot.contents_->filled)
        return Error{"snapshot: nothing was saved in it"};
    state_->lifetime.begin(cmd);
    barrier(state_->context, cmd, true);
    VkDeviceSize offset = 0;
    for (const Stream& stream : streams_of(*state_->device))
    {
        const VkBufferCopy region{offset, 0, stream.bytes_per_vertex * vertices};
        state_->context.fn.vkCmdCopyBuffer(cmd, snapshot.contents_->buffer.handle(), stream.buffer, 1, &region);
        offset += region.size;
    }
    barrier(state_->context, cmd, false);
    state_->lifetime.end(cmd);
    state_->recovery_due = true;
    return {};
}

} // namespace cloth
