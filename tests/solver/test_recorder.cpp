// gpu::Recorder: which commands a dispatch needs.
#include "support/cloth_harness.hpp"

#include "solver/kernels.hpp"

#include "shared/bindings.h"
#include "shared/statistics_layout.h"

#include <array>

namespace
{

// Of what a recorder binds.
struct Counts
{
    int pipelines = 0;
    int sets = 0;
    int pushes = 0;
    bool operator==(const Counts&) const = default;
};

Counts counted; // by functions of Vulkan, which have no place for it

VKAPI_ATTR void VKAPI_CALL count_pipeline(VkCommandBuffer, VkPipelineBindPoint, VkPipeline)
{
    ++counted.pipelines;
}

VKAPI_ATTR void VKAPI_CALL count_sets(VkCommandBuffer, VkPipelineBindPoint, VkPipelineLayout, uint32_t, uint32_t count,
                                      const VkDescriptorSet*, uint32_t, const uint32_t*)
{
    counted.sets += static_cast<int>(count);
}

VKAPI_ATTR void VKAPI_CALL count_push(VkCommandBuffer, VkPipelineLayout, VkShaderStageFlags, uint32_t, uint32_t,
                                      const void*)
{
    ++counted.pushes;
}

// A context whose commands are counted and go nowhere.
voile::gpu::Context counting_context()
{
    voile::gpu::Context context = tests::solver_context();
    context.fn.vkCmdBindPipeline = count_pipeline;
    context.fn.vkCmdBindDescriptorSets = count_sets;
    context.fn.vkCmdPushConstants = count_push;
    context.fn.vkCmdDispatch = [](VkCommandBuffer, uint32_t, uint32_t, uint32_t) {};
    context.fn.vkCmdPipelineBarrier2KHR = [](VkCommandBuffer, const VkDependencyInfoKHR*) {};
    context.begin_label = nullptr;
    context.end_label = nullptr;
    return context;
}

std::string group_name; // the last one

} // namespace

TEST_CASE_FIXTURE(tests::GpuFixture, "a recorder binds what differs from the dispatch before")
{
    const auto kernels = voile::engine::take(voile::create_kernels(tests::solver_context(), {}));
    const voile::gpu::Buffer unused = voile::engine::take(
        voile::gpu::create_buffer(context(), "unused", 256, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, voile::Memory::device));
    auto pool = voile::engine::take(voile::gpu::BindingPool::create(context(), 2, 8));
    const auto bind = [&]
    {
        std::vector<voile::gpu::BufferBinding> buffers;
        for (const voile::gpu::ShaderBinding& binding : kernels.statistics_reduce.bindings())
            buffers.push_back({binding.number, unused.handle()});
        return voile::engine::take(pool.bind(kernels.statistics_reduce, buffers));
    };
    const std::array<VkDescriptorSet, 2> sets{bind(), bind()};

    const voile::gpu::Context context = counting_context();
    voile::gpu::Recorder recorder(context, VK_NULL_HANDLE);
    const auto dispatch = [&](size_t set, uint32_t partials)
    {
        counted = {};
        recorder.dispatch(kernels.statistics_reduce, sets[set], 64, 64,
                          voile::shared::StatisticsReducePush{partials, 0, 0});
        return counted;
    };
    CHECK(dispatch(0, 1) == Counts{1, 1, 1});
    CHECK(dispatch(0, 1) == Counts{0, 0, 0});
    CHECK(dispatch(0, 2) == Counts{0, 0, 1});
    CHECK(dispatch(1, 2) == Counts{0, 1, 0});

    const std::vector<std::byte> push(kernels.limit_scale.push_bytes());
    recorder.dispatch(kernels.limit_scale, sets[0], 64, 64, std::span<const std::byte>(push));
    CHECK(dispatch(1, 2) == Counts{1, 1, 1}); // another kernel's set and push constants took the place
    recorder.forget_bindings();
    CHECK(dispatch(1, 2) == Counts{1, 1, 1});
    recorder.split_with([](void*, VkCommandBuffer cmd) { return cmd; }, nullptr);
    CHECK(dispatch(1, 2) == Counts{0, 0, 0});
    CHECK(dispatch(1, 2) == Counts{1, 1, 1}); // in the next command buffer
}

TEST_CASE("groups are named by their number and their count")
{
    voile::gpu::Context context;
    context.begin_label = [](VkCommandBuffer, const VkDebugUtilsLabelEXT* label) { group_name = label->pLabelName; };
    context.end_label = [](VkCommandBuffer) {};
    voile::gpu::Recorder recorder(context, VK_NULL_HANDLE);
    const auto name_of = [&](const char* name, uint32_t number, uint32_t count)
    {
        const voile::gpu::GroupScope group(recorder, name, number, count);
        return group_name;
    };
    CHECK(name_of("level 4, substep", 17, 280) == "level 4, substep 17/280");
    CHECK(name_of("substep", 4294967295, 4294967295) == "substep 4294967295/4294967295");
    CHECK(name_of(std::string(100, 'x').c_str(), 1, 2) == std::string(63, 'x'));
}
