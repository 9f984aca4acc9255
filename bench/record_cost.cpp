// Recording costs: loops over one kind of command, then dispatches as the solver records them, and ways to record less.
#include "record_cost.hpp"

#include "cloth_bench_shaders.hpp"
#include "voile/gpu/recorder.hpp"

#include <array>
#include <chrono>
#include <functional>

namespace bench
{

namespace
{

constexpr uint32_t k_commands = 400; // about as many as a frame has
constexpr uint32_t k_group = 64;
constexpr uint32_t k_push_bytes = 112;
constexpr uint32_t k_repetitions = 41;

// Two kernels with a set each, as two passes that take turns.
class Passes
{
public:
    explicit Passes(const voile::gpu::Context& context)
        : buffer_(voile::engine::take(voile::gpu::create_buffer(
              context, "unused", 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, voile::Memory::device))),
          pool_(voile::engine::take(voile::gpu::BindingPool::create(context, 2, 2)))
    {
        for (uint32_t i = 0; i < 2; ++i)
        {
            kernels[i] = voile::engine::take(
                voile::gpu::Kernel::create(context, {"bench push", shaders::k_push_comp, {{0, k_group}}}));
            sets[i] = voile::engine::take(pool_.bind(kernels[i], {{0, buffer_.handle()}}));
        }
    }

    std::array<voile::gpu::Kernel, 2> kernels;
    std::array<VkDescriptorSet, 2> sets{};
    std::array<std::byte, k_push_bytes> push{};

    void dispatch(voile::gpu::Recorder& recorder, uint32_t i) const
    {
        recorder.dispatch(kernels[i % 2], sets[i % 2], k_group, k_group, std::span<const std::byte>(push));
    }

private:
    voile::gpu::Buffer buffer_;
    voile::gpu::BindingPool pool_;
};

// One secondary command buffer, recorded once.
class Secondary
{
public:
    Secondary(const voile::engine::Device& device, const TimedQueue::Record& record)
        : context_(device.context()), execute_(load(device.context(), "vkCmdExecuteCommands"))
    {
        VkCommandPoolCreateInfo pool{};
        pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        pool.queueFamilyIndex = device.queue_family();
        voile::engine::check(context_.fn.vkCreateCommandPool(context_.device(), &pool, nullptr, &pool_), "pool");
        VkCommandBufferAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        allocate.commandPool = pool_;
        allocate.level = VK_COMMAND_BUFFER_LEVEL_SECONDARY;
        allocate.commandBufferCount = 1;
        voile::engine::check(context_.fn.vkAllocateCommandBuffers(context_.device(), &allocate, &cmd_), "commands");
        VkCommandBufferInheritanceInfo inheritance{};
        inheritance.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO;
        VkCommandBufferBeginInfo begin{};
        begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        begin.flags = VK_COMMAND_BUFFER_USAGE_SIMULTANEOUS_USE_BIT;
        begin.pInheritanceInfo = &inheritance;
        voile::engine::check(context_.fn.vkBeginCommandBuffer(cmd_, &begin), "commands");
        record(cmd_);
        voile::engine::check(context_.fn.vkEndCommandBuffer(cmd_), "commands");
    }
    ~Secondary()
    {
        (void)context_.fn.vkDeviceWaitIdle(context_.device());
        context_.fn.vkDestroyCommandPool(context_.device(), pool_, nullptr);
    }
    Secondary(const Secondary&) = delete;
    Secondary& operator=(const Secondary&) = delete;

    void execute(VkCommandBuffer primary) const { execute_(primary, 1, &cmd_); }

private:
    static PFN_vkCmdExecuteCommands load(const voile::gpu::Context& context, const char* name)
    {
        const auto get = reinterpret_cast<PFN_vkGetDeviceProcAddr>(
            context.handles.get_instance_proc_addr(context.handles.instance, "vkGetDeviceProcAddr"));
        return reinterpret_cast<PFN_vkCmdExecuteCommands>(get(context.device(), name));
    }

    const voile::gpu::Context& context_;
    PFN_vkCmdExecuteCommands execute_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer cmd_ = VK_NULL_HANDLE;
};

// Measures `record`, which has `count` commands.
RecordCost time_record(TimedQueue& queue, const char* what, uint32_t count, bool runs, const TimedQueue::Record& record)
{
    using Clock = std::chrono::steady_clock;
    std::vector<double> host;
    std::vector<double> gpu;
    queue.run(record); // warms up
    for (uint32_t i = 0; i < k_repetitions; ++i)
    {
        double time = 0;
        const TimedQueue::Record timed = [&](VkCommandBuffer cmd)
        {
            const Clock::time_point begin = Clock::now();
            record(cmd);
            time = std::chrono::duration<double, std::nano>(Clock::now() - begin).count();
        };
        if (runs)
            gpu.push_back(queue.time(timed) / count);
        else
            queue.run(timed);
        host.push_back(time / count);
    }
    return {what, quantile(host, 0.5), quantile(gpu, 0.5)};
}

void measure_commands(TimedQueue& queue, const Passes& passes, std::vector<RecordCost>& costs)
{
    const voile::gpu::Context& context = queue.context();
    const voile::gpu::DeviceFunctions& fn = context.fn;
    const auto bind = [&](VkCommandBuffer cmd, uint32_t i)
    { fn.vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, passes.kernels[i % 2].pipeline()); };
    const auto bind_set = [&](VkCommandBuffer cmd, uint32_t i)
    {
        fn.vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, passes.kernels[i % 2].layout(), 0, 1,
                                   &passes.sets[i % 2], 0, nullptr);
    };
    const auto push = [&](VkCommandBuffer cmd, uint32_t bytes) {
        fn.vkCmdPushConstants(cmd, passes.kernels[0].layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, bytes,
                              passes.push.data());
    };
    const auto loop = [&](const char* what, const std::function<void(VkCommandBuffer, uint32_t)>& command)
    {
        costs.push_back(time_record(queue, what, k_commands, false,
                                    [&](VkCommandBuffer cmd)
                                    {
                                        bind(cmd, 0);
                                        bind_set(cmd, 0);
                                        push(cmd, k_push_bytes);
                                        for (uint32_t i = 0; i < k_commands; ++i)
                                            command(cmd, i);
                                    }));
    };
    loop("nothing", [](VkCommandBuffer, uint32_t) {});
    loop("label, begin and end",
         [&](VkCommandBuffer cmd, uint32_t) { const voile::gpu::LabelScope scope(context, cmd, "cloth verlet"); });
    loop("group, begin and end",
         [&](VkCommandBuffer cmd, uint32_t i)
         {
             voile::gpu::Recorder recorder(context, cmd);
             const voile::gpu::GroupScope group(recorder, "substep", i, k_commands);
         });
    loop("bind a pipeline, two in turn", bind);
    loop("bind a pipeline, the same", [&](VkCommandBuffer cmd, uint32_t) { bind(cmd, 0); });
    loop("bind a set, two in turn", bind_set);
    loop("push 16 bytes", [&](VkCommandBuffer cmd, uint32_t) { push(cmd, 16); });
    loop("push 112 bytes", [&](VkCommandBuffer cmd, uint32_t) { push(cmd, k_push_bytes); });
    loop("dispatch", [&](VkCommandBuffer cmd, uint32_t) { fn.vkCmdDispatch(cmd, 1, 1, 1); });
    loop("push 16 bytes, dispatch",
         [&](VkCommandBuffer cmd, uint32_t)
         {
             push(cmd, 16);
             fn.vkCmdDispatch(cmd, 1, 1, 1);
         });
    loop("push 112 bytes, dispatch",
         [&](VkCommandBuffer cmd, uint32_t)
         {
             push(cmd, k_push_bytes);
             fn.vkCmdDispatch(cmd, 1, 1, 1);
         });
    loop("bind a set, dispatch",
         [&](VkCommandBuffer cmd, uint32_t i)
         {
             bind_set(cmd, i);
             fn.vkCmdDispatch(cmd, 1, 1, 1);
         });
    loop("bind pipeline and set, dispatch",
         [&](VkCommandBuffer cmd, uint32_t i)
         {
             bind(cmd, i);
             bind_set(cmd, i);
             fn.vkCmdDispatch(cmd, 1, 1, 1);
         });
    loop("barrier",
         [&](VkCommandBuffer cmd, uint32_t)
         {
             voile::gpu::Recorder(context, cmd)
                 .barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR,
                          VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR,
                          VK_ACCESS_2_SHADER_STORAGE_READ_BIT_KHR | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR);
         });
}

void measure_dispatches(TimedQueue& queue, const Passes& passes, std::vector<RecordCost>& costs)
{
    const voile::gpu::Context& context = queue.context();
    voile::gpu::Context plain = context;
    plain.begin_label = nullptr;
    plain.end_label = nullptr;
    const auto dispatches = [&](const voile::gpu::Context& with, uint32_t period)
    {
        return [&passes, &with, period](VkCommandBuffer cmd)
        {
            voile::gpu::Recorder recorder(with, cmd);
            for (uint32_t i = 0; i < k_commands; ++i)
                passes.dispatch(recorder, i / period);
        };
    };
    costs.push_back(time_record(queue, "pass", k_commands, true, dispatches(context, 1)));
    costs.push_back(time_record(queue, "pass without labels", k_commands, true, dispatches(plain, 1)));
    costs.push_back(
        time_record(queue, "pass without labels, one kernel", k_commands, true, dispatches(plain, k_commands)));
    for (const voile::gpu::Context* with : {&context, static_cast<const voile::gpu::Context*>(&plain)})
    {
        const Secondary secondary(queue.device(), dispatches(*with, 1));
        costs.push_back(time_record(queue,
                                    with == &plain ? "pass, recorded before, without labels" : "pass, recorded before",
                                    k_commands, true, [&](VkCommandBuffer cmd) { secondary.execute(cmd); }));
    }
}

} // namespace

std::vector<RecordCost> measure_record_cost(TimedQueue& queue)
{
    const Passes passes(queue.context());
    std::vector<RecordCost> costs;
    measure_commands(queue, passes, costs);
    measure_dispatches(queue, passes, costs);
    return costs;
}

} // namespace bench
