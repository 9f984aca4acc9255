// Kernel and BindingPool: compute pipelines over storage buffers, and their descriptor sets.
#include "voile/gpu/kernel.hpp"

#include "shared_memory.hpp"

#include <algorithm>
#include <utility>

namespace voile::gpu
{

namespace
{

Error failed(const KernelDescription& description, const char* what, VkResult status)
{
    return Error{std::string("kernel \"") + description.name + "\": " + what + ": " + to_string(status)};
}

VkResult create_layouts(const Context& context, const KernelDescription& description, VkDescriptorSetLayout* set_layout,
                        VkPipelineLayout* layout)
{
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (uint32_t i = 0; i < description.buffers; ++i)
        bindings.push_back({i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    VkDescriptorSetLayoutCreateInfo set_info{};
    set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set_info.bindingCount = description.buffers;
    set_info.pBindings = bindings.data();
    const VkResult status = context.fn.vkCreateDescriptorSetLayout(context.device(), &set_info, nullptr, set_layout);
    if (status != VK_SUCCESS)
        return status;

    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, description.push_bytes};
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = 1;
    info.pSetLayouts = set_layout;
    info.pushConstantRangeCount = description.push_bytes > 0 ? 1 : 0;
    info.pPushConstantRanges = &range;
    return context.fn.vkCreatePipelineLayout(context.device(), &info, nullptr, layout);
}

VkResult create_pipeline(const Context& context, const KernelDescription& description, VkPipelineLayout layout,
                         VkPipeline* pipeline)
{
    VkShaderModuleCreateInfo module_info{};
    module_info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    module_info.codeSize = description.spirv.size_bytes();
    module_info.pCode = description.spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    VkResult status = context.fn.vkCreateShaderModule(context.device(), &module_info, nullptr, &module);
    if (status != VK_SUCCESS)
        return status;

    std::vector<VkSpecializationMapEntry> entries;
    for (uint32_t i = 0; i < description.specialization.size(); ++i)
        entries.push_back({i, i * 4, 4});
    const VkSpecializationInfo specialization{static_cast<uint32_t>(entries.size()), entries.data(),
                                              description.specialization.size() * 4, description.specialization.data()};
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &specialization;
    info.layout = layout;
    status = context.fn.vkCreateComputePipelines(context.device(), context.handles.pipeline_cache, 1, &info, nullptr,
                                                 pipeline);
    context.fn.vkDestroyShaderModule(context.device(), module, nullptr);
    return status;
}

} // namespace

Result<void> check_limits(const VkPhysicalDeviceLimits& limits, const KernelDescription& description)
{
    const std::string name = std::string("kernel \"") + description.name + "\" ";
    if (description.push_bytes > limits.maxPushConstantsSize)
        return Error{name + "has " + std::to_string(description.push_bytes) +
                     " bytes of push constants, the device has " + std::to_string(limits.maxPushConstantsSize)};
    const uint32_t group = description.specialization.empty() ? 1 : description.specialization[0];
    const uint32_t most_threads = std::min(limits.maxComputeWorkGroupSize[0], limits.maxComputeWorkGroupInvocations);
    if (group == 0 || group > most_threads)
        return Error{name + "has a workgroup of " + std::to_string(group) + ", the device allows 1 to " +
                     std::to_string(most_threads)};
    const uint64_t shared = shared_memory_bytes(description.spirv, description.specialization);
    if (shared > limits.maxComputeSharedMemorySize)
        return Error{name + "takes " + std::to_string(shared) + " bytes of shared memory with a workgroup of " +
                     std::to_string(group) + ", the device has " + std::to_string(limits.maxComputeSharedMemorySize)};
    const std::string binds =
        name + "binds " + std::to_string(description.buffers) + " storage buffers, the device allows ";
    if (description.buffers > limits.maxPerStageDescriptorStorageBuffers)
        return Error{binds + std::to_string(limits.maxPerStageDescriptorStorageBuffers) + " per stage"};
    if (description.buffers > limits.maxDescriptorSetStorageBuffers)
        return Error{binds + std::to_string(limits.maxDescriptorSetStorageBuffers) + " per set"};
    if (description.buffers > limits.maxPerStageResources)
        return Error{binds + std::to_string(limits.maxPerStageResources) + " resources per stage"};
    return {};
}

Kernel::~Kernel()
{
    release();
}

Kernel::Kernel(Kernel&& other) noexcept
{
    *this = std::move(other);
}

Kernel& Kernel::operator=(Kernel&& other) noexcept
{
    std::swap(context_, other.context_);
    std::swap(name_, other.name_);
    std::swap(set_layout_, other.set_layout_);
    std::swap(layout_, other.layout_);
    std::swap(pipeline_, other.pipeline_);
    std::swap(buffers_, other.buffers_);
    std::swap(push_bytes_, other.push_bytes_);
    return *this;
}

void Kernel::release()
{
    if (context_.device() == VK_NULL_HANDLE)
        return;
    context_.fn.vkDestroyPipeline(context_.device(), pipeline_, nullptr);
    context_.fn.vkDestroyPipelineLayout(context_.device(), layout_, nullptr);
    context_.fn.vkDestroyDescriptorSetLayout(context_.device(), set_layout_, nullptr);
}

Result<Kernel> Kernel::create(const Context& context, const KernelDescription& description)
{
    if (auto limits = check_limits(context.limits, description); !limits)
        return limits.error();
    Kernel kernel;
    kernel.context_ = context;
    kernel.name_ = description.name;
    kernel.buffers_ = description.buffers;
    kernel.push_bytes_ = description.push_bytes;
    VkResult status = create_layouts(context, description, &kernel.set_layout_, &kernel.layout_);
    if (status != VK_SUCCESS)
        return failed(description, "layout", status);
    status = create_pipeline(context, description, kernel.layout_, &kernel.pipeline_);
    if (status != VK_SUCCESS)
        return failed(description, "pipeline", status);
    set_name(context, VK_OBJECT_TYPE_PIPELINE, kernel.pipeline_, description.name);
    return kernel;
}

BindingPool::~BindingPool()
{
    if (pool_ != VK_NULL_HANDLE)
        context_.fn.vkDestroyDescriptorPool(context_.device(), pool_, nullptr);
}

BindingPool::BindingPool(BindingPool&& other) noexcept
{
    *this = std::move(other);
}

BindingPool& BindingPool::operator=(BindingPool&& other) noexcept
{
    std::swap(context_, other.context_);
    std::swap(pool_, other.pool_);
    std::swap(sets_left_, other.sets_left_);
    std::swap(buffers_left_, other.buffers_left_);
    return *this;
}

Result<BindingPool> BindingPool::create(const Context& context, uint32_t max_sets, uint32_t max_buffers)
{
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, max_buffers};
    VkDescriptorPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    info.maxSets = max_sets;
    info.poolSizeCount = 1;
    info.pPoolSizes = &size;
    BindingPool result;
    result.context_ = context;
    result.sets_left_ = max_sets;
    result.buffers_left_ = max_buffers;
    const VkResult status = context.fn.vkCreateDescriptorPool(context.device(), &info, nullptr, &result.pool_);
    if (status != VK_SUCCESS)
        return Error{"descriptor pool cannot be made: " + to_string(status)};
    return result;
}

Result<VkDescriptorSet> BindingPool::bind(const Kernel& kernel, std::initializer_list<VkBuffer> buffers)
{
    if (buffers.size() != kernel.buffers())
        return Error{std::string("kernel \"") + kernel.name() + "\" has " + std::to_string(kernel.buffers()) +
                     " bindings, " + std::to_string(buffers.size()) + " buffers were given"};
    if (sets_left_ == 0 || buffers_left_ < kernel.buffers())
        return Error{std::string("descriptor set of kernel \"") + kernel.name() + "\": the pool is used up"};
    const VkDescriptorSetLayout layout = kernel.set_layout();
    VkDescriptorSetAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    info.descriptorPool = pool_;
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    const VkResult status = context_.fn.vkAllocateDescriptorSets(context_.device(), &info, &set);
    if (status != VK_SUCCESS)
        return Error{std::string("descriptor set of kernel \"") + kernel.name() + "\": " + to_string(status)};
    --sets_left_;
    buffers_left_ -= kernel.buffers();

    std::vector<VkDescriptorBufferInfo> infos;
    infos.reserve(buffers.size());
    std::vector<VkWriteDescriptorSet> writes;
    for (const VkBuffer buffer : buffers)
    {
        infos.push_back({buffer, 0, VK_WHOLE_SIZE});
        VkWriteDescriptorSet write{};
        write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        write.dstSet = set;
        write.dstBinding = static_cast<uint32_t>(writes.size());
        write.descriptorCount = 1;
        write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        write.pBufferInfo = &infos.back();
        writes.push_back(write);
    }
    context_.fn.vkUpdateDescriptorSets(context_.device(), static_cast<uint32_t>(writes.size()), writes.data(), 0,
                                       nullptr);
    return set;
}

} // namespace voile::gpu
