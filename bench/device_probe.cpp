// Device probe: medians of a few runs after a warm-up.
#include "device_probe.hpp"

#include "cloth_bench_shaders.hpp"
#include "voile/gpu/recorder.hpp"

#include <algorithm>

namespace bench
{

namespace
{

constexpr int k_runs = 9;

double median_time(TimedQueue& queue, const TimedQueue::Record& record)
{
    queue.run(record); // pages and caches
    std::vector<double> times;
    for (int i = 0; i < k_runs; ++i)
        times.push_back(queue.time(record));
    return quantile(times, 0.5);
}

// Copies far more than any cache holds, to measure memory. Takes the faster of a kernel and vkCmdCopyBuffer: a software
// device is faster with the latter, and a driver may map it to a copy engine that is slower than the shader cores.
double copy_bandwidth(TimedQueue& queue)
{
    constexpr uint32_t k_group = 256;
    constexpr VkDeviceSize k_group_bytes = VkDeviceSize{16} * k_group;
    const voile::gpu::Context& context = queue.context();
    const VkDeviceSize wanted = queue.device().is_cpu() ? VkDeviceSize{128} << 20 : VkDeviceSize{1} << 30;
    // One workgroup per unit of the dispatch's x. Every device accepts 65,535.
    const VkDeviceSize groups = std::min<VkDeviceSize>(std::min(wanted, context.max_buffer_bytes) / k_group_bytes,
                                                       context.limits.maxComputeWorkGroupCount[0]);
    const VkDeviceSize bytes = groups * k_group_bytes;
    const auto buffer = [&](const char* name)
    {
        return voile::engine::take(voile::gpu::create_buffer(
            context, name, bytes,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
            voile::Memory::device));
    };
    const voile::gpu::Buffer source = buffer("copy source");
    const voile::gpu::Buffer destination = buffer("copy destination");
    // The source is written once: untouched pages may all map to the same page of zeros.
    queue.run(
        [&](VkCommandBuffer cmd)
        {
            for (const voile::gpu::Buffer* target : {&source, &destination})
                context.fn.vkCmdFillBuffer(cmd, target->handle(), 0, VK_WHOLE_SIZE, 0x3f800000);
            voile::gpu::Recorder(context, cmd)
                .barrier(VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR,
                         VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR,
                         VK_ACCESS_2_SHADER_STORAGE_READ_BIT_KHR | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR);
        });
    const voile::gpu::Kernel kernel =
        voile::engine::take(voile::gpu::Kernel::create(context, {"bench copy", shaders::k_copy_comp, {{0, k_group}}}));
    voile::gpu::BindingPool pool = voile::engine::take(voile::gpu::BindingPool::create(context, 1, 2));
    const VkDescriptorSet set =
        voile::engine::take(pool.bind(kernel, {{0, source.handle()}, {1, destination.handle()}}));
    const double by_kernel = median_time(queue,
                                         [&](VkCommandBuffer cmd)
                                         {
                                             voile::gpu::Recorder recorder(context, cmd);
                                             recorder.dispatch(kernel, set, static_cast<uint32_t>(groups) * k_group,
                                                               k_group, std::span<const std::byte>{});
                                         });
    const double by_copy =
        median_time(queue,
                    [&](VkCommandBuffer cmd)
                    {
                        const VkBufferCopy region{0, 0, bytes};
                        context.fn.vkCmdCopyBuffer(cmd, source.handle(), destination.handle(), 1, &region);
                    });
    return 2.0 * static_cast<double>(bytes) / (std::min(by_kernel, by_copy) * 1e-6);
}

double empty_dispatch(TimedQueue& queue)
{
    constexpr uint32_t k_dispatches = 1000;
    constexpr uint32_t k_group = 64;
    const voile::gpu::Context& context = queue.context();
    const voile::gpu::Kernel kernel = voile::engine::take(
        voile::gpu::Kernel::create(context, {"bench empty", shaders::k_empty_comp, {{0, k_group}}}));
    const voile::gpu::Buffer unused = voile::engine::take(
        voile::gpu::create_buffer(context, "unused", 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, voile::Memory::device));
    voile::gpu::BindingPool pool = voile::engine::take(voile::gpu::BindingPool::create(context, 1, 1));
    const VkDescriptorSet set = voile::engine::take(pool.bind(kernel, {{0, unused.handle()}}));
    const double microseconds =
        median_time(queue,
                    [&](VkCommandBuffer cmd)
                    {
                        voile::gpu::Recorder recorder(context, cmd);
                        for (uint32_t i = 0; i < k_dispatches; ++i)
                            recorder.dispatch(kernel, set, k_group, k_group, std::span<const std::byte>{});
                    });
    return microseconds / k_dispatches;
}

} // namespace

DeviceProbe probe_device(TimedQueue& queue)
{
    return {copy_bandwidth(queue), empty_dispatch(queue)};
}

} // namespace bench
