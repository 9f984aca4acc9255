// Kernel: compute pipelines over buffers.
#include "voile/gpu/kernel.hpp"

#include "descriptors.hpp"
#include "texel_reads.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace voile::gpu
{

namespace
{

Error failed(const KernelDescription& description, const char* what, VkResult status)
{
    return Error{std::string("kernel \"") + description.name + "\": " + what + ": " + to_string(status)};
}

VkResult create_layouts(const Context& context, const ShaderInterface& shader, VkDescriptorSetLayout* set_layout,
                        VkPipelineLayout* layout)
{
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const ShaderBinding& binding : shader.bindings)
    {
        if (has_buffer(binding))
            bindings.push_back({binding.number, type_of(binding), 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
        if (binding.texel_bytes > 0)
            bindings.push_back({binding.texel_number, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 1,
                                VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo set_info{};
    set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set_info.bindingCount = static_cast<uint32_t>(bindings.size());
    set_info.pBindings = bindings.data();
    const VkResult status = context.fn.vkCreateDescriptorSetLayout(context.device(), &set_info, nullptr, set_layout);
    if (status != VK_SUCCESS)
        return status;

    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, shader.push_bytes};
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = 1;
    info.pSetLayouts = set_layout;
    info.pushConstantRangeCount = shader.push_bytes > 0 ? 1 : 0;
    info.pPushConstantRanges = &range;
    return context.fn.vkCreatePipelineLayout(context.device(), &info, nullptr, layout);
}

VkResult create_pipeline(const Context& context, const KernelDescription& description, std::span<const uint32_t> spirv,
                         VkPipelineLayout layout, VkPipeline* pipeline)
{
    VkShaderModuleCreateInfo module_info{};
    module_info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    module_info.codeSize = spirv.size_bytes();
    module_info.pCode = spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    VkResult status = context.fn.vkCreateShaderModule(context.device(), &module_info, nullptr, &module);
    if (status != VK_SUCCESS)
        return status;
    set_name(context, VK_OBJECT_TYPE_SHADER_MODULE, module, description.name);

    std::vector<VkSpecializationMapEntry> entries;
    for (uint32_t i = 0; i < description.specialization.size(); ++i)
        entries.push_back(
            {description.specialization[i].id,
             static_cast<uint32_t>(i * sizeof(SpecializationConstant) + offsetof(SpecializationConstant, value)),
             sizeof(uint32_t)});
    const VkSpecializationInfo specialization{static_cast<uint32_t>(entries.size()), entries.data(),
                                              description.specialization.size() * sizeof(SpecializationConstant),
                                              description.specialization.data()};
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

// "64", "8 x 8 x 1".
std::string described(const std::array<uint32_t, 3>& workgroup)
{
    std::string text = std::to_string(workgroup[0]);
    for (size_t axis = 1; axis < 3 && (workgroup[1] > 1 || workgroup[2] > 1); ++axis)
        text += " x " + std::to_string(workgroup[axis]);
    return text;
}

// `name`: of the kernel, the start of a message.
Result<void> check_workgroup(const VkPhysicalDeviceLimits& limits, const std::string& name,
                             const std::array<uint32_t, 3>& workgroup)
{
    uint64_t threads = 1;
    for (size_t axis = 0; axis < 3; ++axis)
    {
        threads *= workgroup[axis];
        const uint32_t most = std::min(limits.maxComputeWorkGroupSize[axis], limits.maxComputeWorkGroupInvocations);
        if (workgroup[axis] == 0 || (workgroup[axis] > most && (axis == 0 || workgroup[axis] > 1)))
            return Error{name + "has a workgroup of " + described(workgroup) + ", the device allows 1 to " +
                         std::to_string(most) +
                         (axis == 0   ? ""
                          : axis == 1 ? " in y"
                                      : " in z")};
    }
    if (threads > limits.maxComputeWorkGroupInvocations)
        return Error{name + "has a workgroup of " + described(workgroup) + ", " + std::to_string(threads) +
                     " threads, the device allows " + std::to_string(limits.maxComputeWorkGroupInvocations)};
    return {};
}

Result<void> check(const VkPhysicalDeviceLimits& limits, const KernelDescription& description,
                   const ShaderInterface& shader)
{
    const std::string name = std::string("kernel \"") + description.name + "\" ";
    if (shader.push_bytes > limits.maxPushConstantsSize)
        return Error{name + "has " + std::to_string(shader.push_bytes) + " bytes of push constants, the device has " +
                     std::to_string(limits.maxPushConstantsSize)};
    if (auto fits = check_workgroup(limits, name, shader.workgroup); !fits)
        return fits;
    if (shader.shared_bytes > limits.maxComputeSharedMemorySize)
        return Error{name + "takes " + std::to_string(shader.shared_bytes) +
                     " bytes of shared memory with a workgroup of " + described(shader.workgroup) +
                     ", the device has " + std::to_string(limits.maxComputeSharedMemorySize)};
    const uint32_t buffers = count_storage_buffers(shader.bindings);
    const std::string binds = name + "binds " + std::to_string(buffers) + " storage buffers, the device allows ";
    if (buffers > limits.maxPerStageDescriptorStorageBuffers)
        return Error{binds + std::to_string(limits.maxPerStageDescriptorStorageBuffers) + " per stage"};
    if (buffers > limits.maxDescriptorSetStorageBuffers)
        return Error{binds + std::to_string(limits.maxDescriptorSetStorageBuffers) + " per set"};
    if (shader.bindings.size() > limits.maxPerStageResources)
        return Error{name + "binds " + std::to_string(shader.bindings.size()) + " buffers, the device allows " +
                     std::to_string(limits.maxPerStageResources) + " resources per stage"};
    return {};
}

} // namespace

Result<ShaderInterface> reflect(const KernelDescription& description)
{
    constexpr uint32_t k_magic = 0x07230203;
    const std::string name = std::string("kernel \"") + description.name + "\"";
    if (description.spirv.empty() || description.spirv[0] != k_magic)
        return Error{name + ": its code is not SPIR-V"};
    auto shader = reflect(description.spirv, description.specialization);
    if (!shader)
        return Error{name + ": " + shader.error().message};
    const std::vector<SpecializationConstant>& given = description.specialization;
    const std::vector<ShaderConstant>& declared = shader.value().constants;
    for (const ShaderConstant& constant : declared)
        if (std::ranges::find(given, constant.id, &SpecializationConstant::id) == given.end())
            return Error{name + ": specialization constant " + described(constant.id, constant.name) + " has no value"};
    for (const SpecializationConstant& constant : given)
        if (std::ranges::find(declared, constant.id, &ShaderConstant::id) == declared.end())
            return Error{name + " has no specialization constant " + std::to_string(constant.id)};
    return shader;
}

Result<void> check_limits(const VkPhysicalDeviceLimits& limits, const KernelDescription& description)
{
    const auto shader = reflect(description);
    if (!shader)
        return shader.error();
    return check(limits, description, shader.value());
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
    std::swap(bindings_, other.bindings_);
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
    auto shader = reflect(description);
    if (!shader)
        return shader.error();
    if (auto limits = check(context.limits, description, shader.value()); !limits)
        return limits.error();
    const TexelReads texels = context.texel_reads ? texel_reads(description.spirv) : TexelReads{};
    for (ShaderBinding& binding : shader.value().bindings)
        if (const auto found = texels.bindings.find(binding.number); found != texels.bindings.end())
        {
            binding.texel_bytes = found->second.texel_bytes;
            binding.texel_number = found->second.number;
        }
    Kernel kernel;
    kernel.context_ = context;
    kernel.name_ = description.name;
    kernel.push_bytes_ = shader.value().push_bytes;
    VkResult status = create_layouts(context, shader.value(), &kernel.set_layout_, &kernel.layout_);
    kernel.bindings_ = std::move(shader.value().bindings);
    if (status != VK_SUCCESS)
        return failed(description, "layout", status);
    status = create_pipeline(context, description, texels.spirv.empty() ? description.spirv : texels.spirv,
                             kernel.layout_, &kernel.pipeline_);
    if (status != VK_SUCCESS)
        return failed(description, "pipeline", status);
    set_name(context, VK_OBJECT_TYPE_PIPELINE, kernel.pipeline_, description.name);
    set_name(context, VK_OBJECT_TYPE_PIPELINE_LAYOUT, kernel.layout_, description.name);
    set_name(context, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, kernel.set_layout_, description.name);
    return kernel;
}

} // namespace voile::gpu
