// What the vertex streams have on request: indices, usages, device addresses. And that they have nothing else.
#include "support/cloth_harness.hpp"
#include "support/cloth_meshes.hpp"
#include "support/collider_scenes.hpp"

#include "voile/gpu/allocator.hpp"

#include <map>
#include <string_view>

namespace
{

using tests::ClothHarness;
using tests::flat_sheet;
using tests::reason;
using voile::engine::take;

constexpr VkBufferUsageFlags k_address = VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
constexpr VkBufferUsageFlags k_texels = VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT; // any other

// The host's allocator, which notes what is asked for.
class NotingAllocator final : public voile::BufferAllocator
{
public:
    voile::Result<voile::BufferMemory> create_buffer(const voile::BufferRequest& request) noexcept override
    {
        requests[request.name] = request;
        return tests::device().allocator().create_buffer(request);
    }
    void destroy_buffer(const voile::BufferMemory& memory) noexcept override
    {
        tests::device().allocator().destroy_buffer(memory);
    }
    void flush(const voile::BufferMemory& memory) noexcept override { tests::device().allocator().flush(memory); }
    void invalidate(const voile::BufferMemory& memory) noexcept override
    {
        tests::device().allocator().invalidate(memory);
    }

    std::map<std::string, voile::BufferRequest> requests; // the last of each name
};

// What a solver with these options asks its allocator for, and how many dispatches its step has.
struct Costs
{
    std::map<std::string, voile::BufferRequest> requests;
    uint32_t dispatches = 0;
};
Costs costs_of(const voile::OutputOptions& output)
{
    tests::GpuFixture gpu;
    NotingAllocator allocator;
    voile::Handles handles = tests::KeptPipelines::handles(gpu.context());
    handles.buffer_allocator = &allocator;
    voile::Solver solver = take(voile::Solver::create(handles, {.output = output}));
    (void)take(solver.add_cloth(flat_sheet(9, 0.5f, 1)));
    voile::Upload upload;
    gpu.run(
        [&](VkCommandBuffer cmd)
        {
            upload = take(solver.record_upload(cmd));
            take(solver.record(cmd, {}));
        });
    return {allocator.requests, solver.dispatches({})};
}

// Bytes of a buffer that needs this many. Where kernels read texels, buffers are a little longer.
bool is_size_of(VkDeviceSize bytes, VkDeviceSize needed)
{
    return tests::device().context().texel_reads ? bytes >= needed && bytes < needed + 768 : bytes == needed;
}

std::vector<glm::uvec3> indices(ClothHarness& harness, voile::ClothId cloth)
{
    const voile::VertexStreams streams = harness.solver.vertices(cloth);
    CHECK(streams.index_count % 3 == 0);
    return harness.read<glm::uvec3>(streams.indices, streams.index_count / 3, streams.index_offset);
}

} // namespace

TEST_CASE("without options the vertex streams cost no memory and no dispatch")
{
    const Costs off = costs_of({});
    const Costs on = costs_of({.previous_positions = true, .indices = true, .usage = k_texels});
    CHECK(off.dispatches == on.dispatches);
    CHECK_FALSE(off.requests.contains("cloth previous_positions"));
    CHECK_FALSE(off.requests.contains("cloth indices"));
    CHECK(on.requests.size() == off.requests.size() + 2);
    CHECK(is_size_of(on.requests.at("cloth previous_positions").bytes, 81 * sizeof(glm::vec4)));
    CHECK(is_size_of(on.requests.at("cloth indices").bytes, 128 * sizeof(glm::uvec3)));
    for (const auto& entry : off.requests) // clang 14 captures no structured binding, as CAPTURE does
    {
        const auto& name = entry.first;
        const auto& request = entry.second;
        CAPTURE(name);
        const bool staging = name == "cloth staging"; // has what is new of the two
        CHECK((request.bytes == on.requests.at(name).bytes) == !staging);
        const bool stream = name == "cloth positions" || name == "cloth velocities" || name == "cloth normals" ||
                            name == "cloth intersections";
        CHECK(on.requests.at(name).usage == (request.usage | (stream ? k_texels : 0u)));
    }
    for (const char* name : {"cloth previous_positions", "cloth indices"})
        CHECK((on.requests.at(name).usage & k_texels) != 0);
    CHECK((on.requests.at("cloth indices").usage & VK_BUFFER_USAGE_INDEX_BUFFER_BIT) != 0);

    ClothHarness harness;
    const voile::ClothId sheet = take(harness.solver.add_cloth(flat_sheet(9, 0.5f, 1)));
    harness.upload();
    const voile::VertexStreams streams = harness.solver.vertices(sheet);
    CHECK(streams.previous_positions == VK_NULL_HANDLE);
    CHECK(streams.indices == VK_NULL_HANDLE);
    CHECK(streams.index_count == 0);
    CHECK(streams.addresses.positions == 0);
}

TEST_CASE("the index buffer has the triangles of grids and meshes")
{
    ClothHarness harness({.output = {.indices = true}});
    const tests::ClothMesh shape = tests::jittered_sheet(7, 5);
    const voile::ClothId sheet = take(harness.solver.add_cloth(flat_sheet(6, 0.5f, 1)));
    const voile::ClothId mesh = take(harness.solver.add_cloth(shape.cloth()));
    CHECK(harness.solver.vertices(sheet).index_count == 0);
    harness.upload();
    CHECK(indices(harness, sheet) == harness.solver.triangles(sheet));
    CHECK(indices(harness, mesh) == shape.triangles);
    // Growth keeps them; a removed cloth's place is used again.
    take(harness.solver.remove(sheet));
    const voile::ClothId small = take(harness.solver.add_cloth(flat_sheet(5, 0.5f, 1)));
    const voile::ClothId large = take(harness.solver.add_cloth(flat_sheet(30, 0.5f, 2)));
    harness.upload();
    CHECK(harness.solver.vertices(small).index_offset == 0);
    CHECK(indices(harness, small) == harness.solver.triangles(small));
    CHECK(indices(harness, mesh) == shape.triangles);
    CHECK(indices(harness, large) == harness.solver.triangles(large));
    CHECK(harness.solver.vertices(sheet).indices == VK_NULL_HANDLE);
}

TEST_CASE("the vertex streams have device addresses, from the module's allocator and from the host's")
{
    const VkPhysicalDevice physical = tests::device().context().handles.physical_device;
    VkPhysicalDeviceBufferDeviceAddressFeatures supported{};
    supported.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES;
    VkPhysicalDeviceFeatures2 features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &supported;
    const voile::Handles& any = tests::device().context().handles;
    reinterpret_cast<PFN_vkGetPhysicalDeviceFeatures2>(
        any.get_instance_proc_addr(any.instance, "vkGetPhysicalDeviceFeatures2"))(physical, &features);
    if (supported.bufferDeviceAddress == VK_FALSE)
    {
        MESSAGE("skipped: the device has no buffer device addresses");
        return;
    }
    voile::engine::Device device(
        {.device = {}, .validation = true, .instance_extensions = {}, .swapchain = false, .device_addresses = true});
    tests::KeptPipelines kept(device.context());
    for (const bool hosts : {false, true})
    {
        CAPTURE(hosts);
        voile::Handles handles = kept.handles();
        if (!hosts)
            handles.buffer_allocator = nullptr;
        voile::engine::FrameRing frames(device, 1);
        voile::Upload upload;
        voile::Solver solver = take(voile::Solver::create(
            handles, {.output = {.previous_positions = true, .indices = true, .usage = k_address}}));
        (void)take(solver.add_cloth(flat_sheet(4, 0.5f, 1)));
        const voile::ClothId sheet = take(solver.add_cloth(flat_sheet(6, 0.5f, 2)));
        CHECK(solver.vertices(sheet).addresses.positions == 0);
        const voile::engine::FrameRing::Frame frame = frames.begin();
        upload = take(solver.record_upload(frame.cmd));
        take(solver.record(frame.cmd, {}));
        frames.submit(frame);
        frames.wait(frame.slot);
        const voile::VertexStreams streams = solver.vertices(sheet);
        CHECK(streams.offset == 16 * sizeof(glm::vec4));
        CHECK(streams.index_offset == 18 * sizeof(glm::uvec3));
        const auto check = [&](VkBuffer buffer, VkDeviceAddress address, VkDeviceSize offset)
        {
            VkBufferDeviceAddressInfo info{};
            info.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
            info.buffer = buffer;
            const voile::gpu::Context& context = device.context();
            CHECK(address != 0);
            CHECK(address == context.fn.vkGetBufferDeviceAddress(context.device(), &info) + offset);
        };
        check(streams.positions, streams.addresses.positions, streams.offset);
        check(streams.velocities, streams.addresses.velocities, streams.offset);
        check(streams.normals, streams.addresses.normals, streams.offset);
        check(streams.previous_positions, streams.addresses.previous_positions, streams.offset);
        check(streams.indices, streams.addresses.indices, streams.index_offset);
    }
    device.wait_idle();
    for (const std::string& message : device.validation().messages())
        FAIL_CHECK(message);
}

namespace
{

VKAPI_ATTR void VKAPI_CALL features_of_an_old_device(VkPhysicalDevice, VkPhysicalDeviceFeatures2*) {}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL function_of_an_old_device(VkInstance instance, const char* name)
{
    if (std::string_view(name) == "vkGetPhysicalDeviceFeatures2")
        return reinterpret_cast<PFN_vkVoidFunction>(features_of_an_old_device);
    return tests::device().context().handles.get_instance_proc_addr(instance, name);
}

} // namespace

TEST_CASE("usages that the device or the host's allocator does not have are refused")
{
    const tests::GpuFixture gpu;
    voile::Handles handles = tests::KeptPipelines::handles(gpu.context());
    const voile::SolverOptions addresses{.output = {.usage = k_address}};
    const voile::SolverOptions builds{
        .output = {.usage = VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR}};
    CHECK(reason(voile::Solver::create(handles, builds)) ==
          "OutputOptions: usage has VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR, the device "
          "was made without VK_KHR_acceleration_structure");
    // The allocator of the test device has no addresses. An upload that fails changes nothing.
    voile::Solver solver = take(voile::Solver::create(handles, addresses));
    const voile::ClothId sheet = take(solver.add_cloth(flat_sheet(4, 0.5f, 1)));
    CHECK(reason(solver.record_upload(VK_NULL_HANDLE)) ==
          "buffer \"cloth normals\" of 256 bytes cannot be made: its allocator was made without device addresses");
    CHECK(solver.needs_upload());
    CHECK(solver.vertices(sheet).positions == VK_NULL_HANDLE);
    handles.get_instance_proc_addr = function_of_an_old_device;
    CHECK(reason(voile::Solver::create(handles, addresses)) ==
          "OutputOptions: usage has VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT, the device does not have the feature "
          "bufferDeviceAddress");
}
