// Limits of devices: each is obeyed, or exceeding it is an error. Limits that the test device does not have are tested
// on a fake device.
#include "support/backward_jobs.hpp"
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"

#include "solver/kernels.hpp"

#include <string>
#include <string_view>
#include <utility>

namespace
{

using tests::ClothHarness;
using tests::reason;

// The minimum that Vulkan guarantees.
VkPhysicalDeviceLimits least_limits()
{
    VkPhysicalDeviceLimits limits{};
    limits.maxPushConstantsSize = 128;
    limits.maxComputeSharedMemorySize = 16384;
    limits.maxComputeWorkGroupInvocations = 128;
    limits.maxComputeWorkGroupSize[0] = 128;
    limits.maxComputeWorkGroupCount[0] = 65535;
    limits.maxPerStageDescriptorStorageBuffers = 4;
    limits.maxDescriptorSetStorageBuffers = 29; // of the contact pass, five more than Vulkan requires
    limits.maxPerStageResources = 128;
    return limits;
}

// The solver's requirements, and otherwise the minimum.
VkPhysicalDeviceLimits required_limits()
{
    VkPhysicalDeviceLimits limits = least_limits();
    limits.maxPerStageDescriptorStorageBuffers = voile::requirements().storage_buffers;
    return limits;
}

} // namespace

TEST_CASE("a device that meets requirements() is enough for the default options")
{
    CHECK(reason(voile::check_limits(required_limits(), {})) == "accepted");
    // No requirement exceeds the need.
    VkPhysicalDeviceLimits limits = required_limits();
    --limits.maxPerStageDescriptorStorageBuffers;
    const std::string most = std::to_string(voile::requirements().storage_buffers);
    CHECK(reason(voile::check_limits(limits, {})) ==
          "kernel \"cloth contact\" binds " + most + " storage buffers, the device allows " +
              std::to_string(voile::requirements().storage_buffers - 1) + " per stage");
}

TEST_CASE_FIXTURE(tests::GpuFixture,
                  "shaders in place of the module's own are used by their file's name, unknown names are refused")
{
    const auto created = [&](const char* file)
    {
        const std::vector<uint32_t> no_spirv{1, 2, 3};
        const voile::ShaderReplacement shader{file, no_spirv};
        return reason(voile::Solver::create(tests::test_handles(), {.shaders = {&shader, 1}}));
    };
    CHECK(created("verlet.comp") == "kernel \"cloth verlet\": its code is not SPIR-V");
    CHECK(created("refit.comp").find("kernel \"cloth refit leaves\"") == 0);
    CHECK(created("velvet.comp") == "SolverOptions: shaders: no shader is called \"velvet.comp\"");
}

namespace
{

PFN_vkGetInstanceProcAddr the_loaders = nullptr;
PFN_vkGetDeviceProcAddr devices_function = nullptr;
std::string_view missing; // a function

VkResult VKAPI_PTR refuse_pipelines(VkDevice, VkPipelineCache, uint32_t, const VkComputePipelineCreateInfo*,
                                    const VkAllocationCallbacks*, VkPipeline*)
{
    return VK_ERROR_OUT_OF_DEVICE_MEMORY;
}

PFN_vkVoidFunction VKAPI_PTR function_of_device(VkDevice device, const char* name)
{
    if (name == missing)
        return nullptr;
    if (std::string_view(name) == "vkCreateComputePipelines")
        return reinterpret_cast<PFN_vkVoidFunction>(&refuse_pipelines);
    return devices_function(device, name);
}

PFN_vkVoidFunction VKAPI_PTR function_without_pipelines(VkInstance instance, const char* name)
{
    if (name == missing)
        return nullptr;
    if (std::string_view(name) != "vkGetDeviceProcAddr")
        return the_loaders(instance, name);
    devices_function = reinterpret_cast<PFN_vkGetDeviceProcAddr>(the_loaders(instance, name));
    return reinterpret_cast<PFN_vkVoidFunction>(&function_of_device);
}

} // namespace

TEST_CASE("the host's jobs compile the kernels, and the error of several is that of the largest")
{
    uint32_t tasks = 0;
    voile::SolverOptions options;
    options.jobs = {.run = tests::run_backwards, .user = &tasks, .workers = 5};
    voile::Handles handles = tests::test_handles();
    CHECK(reason(voile::Solver::create(handles, options)) == "accepted");
    CHECK(tasks == 5);
    the_loaders = std::exchange(handles.get_instance_proc_addr, &function_without_pipelines);
    const std::string_view expected = "kernel \"cloth contact\": pipeline: VK_ERROR_OUT_OF_DEVICE_MEMORY";
    CHECK(reason(voile::Solver::create(handles, options)) == expected);
    CHECK(reason(voile::Solver::create(handles, {})) == expected);
}

TEST_CASE("a function that the device does not have is an error, by name")
{
    voile::Handles handles = tests::test_handles();
    the_loaders = std::exchange(handles.get_instance_proc_addr, &function_without_pipelines);
    for (const char* name : {"vkCmdDispatchIndirect", "vkCreateShaderModule", "vkUpdateDescriptorSets"})
    {
        missing = name;
        CHECK(reason(voile::Solver::create(handles, {})) == "the device has no " + std::string(name));
    }
    missing = "vkGetDeviceProcAddr";
    CHECK(reason(voile::Solver::create(handles, {})) == "Handles: get_instance_proc_addr finds no vkGetDeviceProcAddr");
    missing = {};
}

namespace
{

int asked = 0;

PFN_vkVoidFunction VKAPI_PTR counting(VkInstance instance, const char* name)
{
    ++asked;
    return the_loaders(instance, name);
}

} // namespace

TEST_CASE("each solver loads its functions from its own handles, independent of earlier solvers")
{
    voile::Handles handles = tests::test_handles();
    the_loaders = handles.get_instance_proc_addr;
    REQUIRE(voile::Solver::create(handles, {}));
    handles.get_instance_proc_addr = counting;
    REQUIRE(voile::Solver::create(handles, {}));
    CHECK(asked > 0);
    const auto context = voile::gpu::create_context(handles);
    REQUIRE(context);
    CHECK((context.value().fn.vkCmdDispatch != nullptr));
}

TEST_CASE("each limit of a device has an error message")
{
    const auto refused = [](const auto& lower, const voile::SolverOptions& options = {})
    {
        VkPhysicalDeviceLimits limits = required_limits();
        lower(limits);
        return reason(voile::check_limits(limits, options));
    };
    CHECK(refused([](auto& limits) { limits.maxPerStageDescriptorStorageBuffers = 4; })
              .ends_with("storage buffers, the device allows 4 per stage"));
    CHECK(refused([](auto& limits) { limits.maxDescriptorSetStorageBuffers = 8; })
              .ends_with("storage buffers, the device allows 8 per set"));
    CHECK(refused([](auto& limits) { limits.maxPerStageResources = 9; })
              .ends_with("buffers, the device allows 9 resources per stage"));
    CHECK(refused([](auto& limits) { limits.maxPushConstantsSize = 16; })
              .ends_with("bytes of push constants, the device has 16"));
    CHECK(refused([](auto&) {}, {.tuning = {.workgroup_size = 256}})
              .ends_with("has a workgroup of 256, the device allows 1 to 128"));
    CHECK(refused([](auto& limits) { limits.maxComputeSharedMemorySize = 15027; }) ==
          "kernel \"cloth wide strain limit\" takes 15028 bytes of shared memory with a workgroup of 128, the "
          "device has 15027");
    const auto large = [](auto& limits)
    {
        limits.maxComputeWorkGroupInvocations = limits.maxComputeWorkGroupSize[0] = 1024;
        limits.maxComputeSharedMemorySize = 24 * 1024;
    };
    CHECK(refused(large, {.tuning = {.workgroup_size = 256}}) == "accepted");
    CHECK(refused(large, {.tuning = {.workgroup_size = 512}}).find(" bytes of shared memory") != std::string::npos);
}

TEST_CASE("every workgroup size works without a validation message or is refused with an error")
{
    const VkPhysicalDeviceLimits& limits = tests::device().context().limits;
    for (const uint32_t size : {1u, 512u, 1024u, 2048u})
    {
        CAPTURE(size);
        const tests::GpuFixture fixture; // fails on a validation message
        const voile::SolverOptions options{.tuning = {.workgroup_size = size}};
        const auto solver = voile::Solver::create(tests::device().context().handles, options);
        CHECK(reason(solver) == reason(voile::check_limits(limits, options)));
        if (size <= 128)
            CHECK(solver.has_value());
        if (uint64_t{48} * size > limits.maxComputeSharedMemorySize || size > limits.maxComputeWorkGroupInvocations)
            CHECK_FALSE(solver.has_value());
    }
}

TEST_CASE("objects that need more workgroups than a dispatch may have are refused when they are added")
{
    const uint32_t most = tests::device().context().limits.maxComputeWorkGroupCount[0];
    if (most > 1'000'000)
        return; // no sheet of the test's size reaches it
    ClothHarness harness({.tuning = {.workgroup_size = 1}});
    voile::GridCloth grid = tests::flat_sheet(2, 1, 0);
    grid.columns = 256;
    grid.rows = (most + 1) / 256;
    CHECK(reason(harness.solver.add_cloth(grid)) ==
          "cloth \"cloth\": with it the solver has 65536 workgroups of 1, the device dispatches at most 65535; a "
          "larger Tuning::workgroup_size needs fewer");
    CHECK(harness.solver.vertex_count() == 0);
    --grid.rows;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    CHECK(reason(harness.solver.add_cloth(tests::flat_sheet(16, 1, 0))).find("65536 workgroups") != std::string::npos);
    // The vertices of a deforming mesh have their own dispatch.
    std::vector<glm::vec3> positions(most + 1);
    positions[1] = {1, 0, 0};
    positions[2] = {0, 0, 1};
    const std::vector<glm::uvec3> triangle{{0, 1, 2}};
    const voile::MeshCollider mesh{.positions = positions, .triangles = triangle, .deforms = true};
    CHECK(reason(harness.solver.add_collider(mesh)) ==
          "collider \"mesh\": its vertices need 65536 workgroups of 1, the device dispatches at most 65535; a larger "
          "Tuning::workgroup_size needs fewer");
    CHECK(harness.solver.vertices(id).vertices == 0); // nothing is uploaded
}
