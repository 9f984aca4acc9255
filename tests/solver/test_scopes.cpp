// The barriers at the beginning and the end of what a solver records: which of the host's stages they name.
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"

#include "voile/cloth.hpp"
#include "voile/engine/assets/shapes.hpp"

#include <string_view>

namespace
{

VkPipelineStageFlags2 stages_before; // of all barriers that were recorded
VkPipelineStageFlags2 stages_after;
VkAccessFlags2 accesses_before;
VkAccessFlags2 accesses_after;
PFN_vkGetDeviceProcAddr the_drivers;
PFN_vkCmdPipelineBarrier2KHR pipeline_barrier;

VKAPI_ATTR void VKAPI_CALL note_barrier(VkCommandBuffer cmd, const VkDependencyInfoKHR* dependency)
{
    for (uint32_t i = 0; i < dependency->memoryBarrierCount; ++i)
    {
        const VkMemoryBarrier2KHR& barrier = dependency->pMemoryBarriers[i];
        stages_before |= barrier.srcStageMask;
        accesses_before |= barrier.srcAccessMask;
        stages_after |= barrier.dstStageMask;
        accesses_after |= barrier.dstAccessMask;
    }
    CHECK(dependency->bufferMemoryBarrierCount + dependency->imageMemoryBarrierCount == 0);
    pipeline_barrier(cmd, dependency);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char* name)
{
    const PFN_vkVoidFunction found = the_drivers(device, name);
    if (std::string_view(name) != "vkCmdPipelineBarrier2KHR" || found == nullptr)
        return found;
    pipeline_barrier = reinterpret_cast<PFN_vkCmdPipelineBarrier2KHR>(found);
    return reinterpret_cast<PFN_vkVoidFunction>(note_barrier);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance, const char* name)
{
    const voile::Handles kept = tests::KeptPipelines::handles(tests::device().context());
    const PFN_vkVoidFunction found = kept.get_instance_proc_addr(instance, name);
    if (std::string_view(name) != "vkGetDeviceProcAddr")
        return found;
    the_drivers = reinterpret_cast<PFN_vkGetDeviceProcAddr>(found);
    return reinterpret_cast<PFN_vkVoidFunction>(device_function);
}

// Uploads, two steps with edits and moving and deforming colliders, statistics, an output, a snapshot saved and
// restored.
void record_everything(voile::SolverOptions options)
{
    options.output.previous_positions = true;
    stages_before = stages_after = accesses_before = accesses_after = 0;
    tests::GpuFixture gpu;
    voile::Handles handles = gpu.context().handles;
    handles.get_instance_proc_addr = instance_function;
    voile::Solver solver = voile::engine::take(voile::Solver::create(handles, options));
    voile::GridCloth grid{.columns = 8, .rows = 8, .material = voile::cotton()};
    grid.transform[3] = {0, 1.1f, 0, 1};
    const voile::ClothId sheet = voile::engine::take(solver.add_cloth(grid));
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0, 0}, 1, 8);
    const voile::ColliderId body = voile::engine::take(solver.add_collider(tests::deforming(ball)));
    const voile::ColliderId box = voile::engine::take(solver.add_collider(voile::BoxCollider{}));
    voile::Upload upload;
    gpu.run([&](VkCommandBuffer cmd) { upload = voile::engine::take(solver.record_upload(cmd)); });
    const voile::Snapshot snapshot = voile::engine::take(solver.create_snapshot());
    const voile::gpu::Buffer vertices = voile::engine::take(voile::gpu::create_buffer(
        gpu.context(), "host vertices", 4096, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, voile::Memory::device));
    const voile::OutputId output = voile::engine::take(
        solver.add_output(sheet, {.buffer = vertices.handle(), .size = 4096, .stride = 12, .position = 0}));
    const auto step = [&]
    {
        gpu.run(
            [&](VkCommandBuffer cmd)
            {
                voile::engine::take(solver.record(cmd, {.duration = 1e-3f}));
                voile::engine::take(solver.record_statistics(cmd, 0));
                voile::engine::take(solver.record_outputs(cmd, {output}));
            });
    };
    step();
    voile::engine::take(solver.deform_collider(body, ball.positions));
    voile::engine::take(solver.move_collider(box, glm::mat4(1)));
    voile::engine::take(solver.reset(sheet));
    voile::engine::take(solver.set_material(sheet, voile::silk()));
    step();
    gpu.run([&](VkCommandBuffer cmd) { voile::engine::take(solver.record_save(cmd, snapshot)); });
    gpu.run([&](VkCommandBuffer cmd) { voile::engine::take(solver.record_restore(cmd, snapshot)); });
    step();
}

// Stages of queues that only compute.
constexpr VkPipelineStageFlags2 k_compute_queue = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
                                                  VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_COPY_BIT |
                                                  VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;

} // namespace

TEST_CASE("barriers name vertex input unless the host says otherwise")
{
    record_everything({});
    CHECK((stages_before & ~k_compute_queue) == VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT);
    CHECK((stages_after & ~k_compute_queue) == VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT);
    CHECK((accesses_after & VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT) != 0);
}

TEST_CASE("a host without vertex input gets barriers that are valid on a queue that only computes")
{
    record_everything({.host_scopes = voile::HostScopes{}});
    CHECK(stages_before != 0);
    CHECK((stages_before & ~k_compute_queue) == 0);
    CHECK((stages_after & ~k_compute_queue) == 0);
    CHECK((accesses_after & VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT) == 0);
}

TEST_CASE("barriers name the stages and accesses that the host names")
{
    record_everything({.host_scopes = voile::HostScopes{
                           .before = {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, 0},
                           .after = {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_UNIFORM_READ_BIT}}});
    CHECK((stages_before & ~k_compute_queue) == VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT);
    CHECK((stages_after & ~k_compute_queue) == VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
    CHECK((accesses_after & VK_ACCESS_2_UNIFORM_READ_BIT) != 0);
    CHECK((accesses_after & VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT) == 0);
}
