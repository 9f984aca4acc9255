// Vertex streams: what they have on request, and where a cloth has its vertices in them.
#include "solver/solver_state.hpp"

#include <utility>

namespace voile
{

namespace
{

constexpr VkPipelineStageFlags2KHR k_transfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR;
constexpr VkAccessFlags2KHR k_writes = VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR;
constexpr VkAccessFlags2KHR k_copies = VK_ACCESS_2_TRANSFER_READ_BIT_KHR | VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR;

bool has_device_addresses(const gpu::Context& context)
{
    const auto get = reinterpret_cast<PFN_vkGetPhysicalDeviceFeatures2>(
        context.handles.get_instance_proc_addr(context.handles.instance, "vkGetPhysicalDeviceFeatures2"));
    VkPhysicalDeviceBufferDeviceAddressFeatures addresses{};
    addresses.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &addresses;
    get(context.handles.physical_device, &features);
    return addresses.bufferDeviceAddress == VK_TRUE;
}

// Functions of extensions that the device was made without are null.
bool builds_acceleration_structures(const gpu::Context& context)
{
    const auto get = reinterpret_cast<PFN_vkGetDeviceProcAddr>(
        context.handles.get_instance_proc_addr(context.handles.instance, "vkGetDeviceProcAddr"));
    return get(context.device(), "vkCmdBuildAccelerationStructuresKHR") != nullptr;
}

} // namespace

bool wants_addresses(const OutputOptions& options)
{
    return (options.usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT) != 0;
}

Result<void> check_output(const gpu::Context& context, const OutputOptions& options)
{
    constexpr VkBufferUsageFlags k_build = VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
    if (wants_addresses(options) && !has_device_addresses(context))
        return Error{"OutputOptions: usage has VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT, the device does not have the "
                     "feature bufferDeviceAddress"};
    if ((options.usage & k_build) != 0 && !builds_acceleration_structures(context))
        return Error{"OutputOptions: usage has VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR, "
                     "the device was made without VK_KHR_acceleration_structure"};
    return {};
}

void record_previous_positions(gpu::Recorder& recorder, const Solver::State& solver)
{
    const DeviceState& device = *solver.device;
    if (!solver.options.output.previous_positions || device.vertices == 0)
        return;
    const Scope before = host_scopes(solver.options).before;
    recorder.barrier(before.stages | k_transfer | k_compute, before.accesses | k_writes, k_transfer, k_copies);
    recorder.copy(device[buffer::positions].handle(), device[buffer::previous_positions].handle(),
                  {0, 0, device.vertices * sizeof(glm::vec4)});
}

void record_jumps(gpu::Recorder& recorder, Solver::State& solver)
{
    const DeviceState& device = *solver.device;
    bool first = true;
    for (auto [index, cloth] : solver.model.cloths)
    {
        if (!std::exchange(cloth.jumped, false) || !solver.options.output.previous_positions)
            continue;
        if (std::exchange(first, false))
            recorder.barrier(k_compute | k_transfer, k_writes, k_transfer, k_copies);
        const VkDeviceSize offset = cloth.record.first_vertex * sizeof(glm::vec4);
        recorder.copy(device[buffer::positions].handle(), device[buffer::previous_positions].handle(),
                      {offset, offset, cloth.record.vertices * sizeof(glm::vec4)});
    }
}

VertexStreams Solver::vertices(ClothId cloth) const
{
    VertexStreams streams;
    const ClothModel* model = state_->find(cloth);
    if (model == nullptr || !model->uploaded)
        return streams;
    const DeviceState& device = *state_->device;
    const shared::ClothRecord& record = model->record;
    streams.positions = device[buffer::positions].handle();
    streams.velocities = device[buffer::velocities].handle();
    streams.normals = device[buffer::normals].handle();
    streams.previous_positions = device[buffer::previous_positions].handle();
    streams.offset = record.first_vertex * sizeof(glm::vec4);
    streams.vertices = record.vertices;
    if (state_->options.output.indices)
    {
        streams.indices = device[buffer::indices].handle();
        streams.index_offset = model->first_triangle * sizeof(glm::uvec3);
        streams.index_count = static_cast<uint32_t>(3 * count_triangles(*model));
    }
    if (state_->options.intersections)
    {
        streams.intersections = device[buffer::intersections].handle();
        streams.intersection_offset = record.first_vertex * sizeof(uint32_t);
    }
    if (!wants_addresses(state_->options.output))
        return streams;
    const auto address = [&](VkBuffer buffer, VkDeviceSize offset)
    { return buffer != VK_NULL_HANDLE ? gpu::device_address(state_->context, buffer) + offset : 0; };
    streams.addresses = {
        address(streams.positions, streams.offset),     address(streams.velocities, streams.offset),
        address(streams.normals, streams.offset),       address(streams.previous_positions, streams.offset),
        address(streams.indices, streams.index_offset), address(streams.intersections, streams.intersection_offset)};
    return streams;
}

} // namespace voile
