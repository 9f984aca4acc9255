// BindingPool: descriptor sets of kernels.
#include "descriptors.hpp"
#include "voile/gpu/kernel.hpp"

#include <algorithm>
#include <utility>

namespace voile::gpu
{

BindingPool::~BindingPool()
{
    for (const VkBufferView view : views_)
        context_.fn.vkDestroyBufferView(context_.device(), view, nullptr);
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
    std::swap(views_, other.views_);
    std::swap(sets_left_, other.sets_left_);
    std::swap(buffers_left_, other.buffers_left_);
    std::swap(uniform_buffers_left_, other.uniform_buffers_left_);
    return *this;
}

Result<BindingPool> BindingPool::create(const Context& context, uint32_t max_sets, uint32_t max_buffers,
                                        uint32_t max_uniform_buffers)
{
    std::vector<VkDescriptorPoolSize> sizes{{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, max_buffers}};
    if (max_uniform_buffers > 0) // no size may be 0
        sizes.push_back({VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, max_uniform_buffers});
    if (context.texel_reads) // each buffer may be either
        sizes.push_back({VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, max_buffers});
    VkDescriptorPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    info.maxSets = max_sets;
    info.poolSizeCount = static_cast<uint32_t>(sizes.size());
    info.pPoolSizes = sizes.data();
    BindingPool result;
    result.context_ = context;
    result.sets_left_ = max_sets;
    result.buffers_left_ = max_buffers;
    result.uniform_buffers_left_ = max_uniform_buffers;
    const VkResult status = context.fn.vkCreateDescriptorPool(context.device(), &info, nullptr, &result.pool_);
    if (status != VK_SUCCESS)
        return Error{"descriptor pool cannot be made: " + to_string(status)};
    return result;
}

namespace
{

Result<void> check_buffers(const Kernel& kernel, std::span<const BufferBinding> buffers)
{
    const std::string name = std::string("kernel \"") + kernel.name() + "\"";
    const std::vector<ShaderBinding>& bindings = kernel.bindings();
    for (const BufferBinding& given : buffers)
        if (std::ranges::find(bindings, given.number, &ShaderBinding::number) == bindings.end())
            return Error{name + " has no binding " + std::to_string(given.number)};
    for (const ShaderBinding& binding : bindings)
        if (const auto count = std::ranges::count(buffers, binding.number, &BufferBinding::number); count != 1)
            return Error{name + ": binding " + described(binding.number, binding.name) + " has " +
                         (count == 0 ? "no buffer" : "more than one buffer")};
    return {};
}

} // namespace

Result<VkBufferView> BindingPool::create_view(const BufferBinding& given, uint32_t texel_bytes)
{
    VkBufferViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO;
    info.buffer = given.buffer;
    info.format = texel_bytes == 4   ? VK_FORMAT_R32_UINT
                  : texel_bytes == 8 ? VK_FORMAT_R32G32_UINT
                                     : VK_FORMAT_R32G32B32A32_UINT;
    info.offset = given.offset;
    info.range = given.bytes == VK_WHOLE_SIZE ? given.bytes : given.bytes / texel_bytes * texel_bytes;
    VkBufferView view = VK_NULL_HANDLE;
    const VkResult status = context_.fn.vkCreateBufferView(context_.device(), &info, nullptr, &view);
    if (status != VK_SUCCESS)
        return Error{"view of binding " + std::to_string(given.number) + ": " + to_string(status)};
    views_.push_back(view);
    return view;
}

Result<VkDescriptorSet> BindingPool::bind(const Kernel& kernel, std::span<const BufferBinding> buffers)
{
    if (auto complete = check_buffers(kernel, buffers); !complete)
        return complete.error();
    const std::vector<ShaderBinding>& bindings = kernel.bindings();
    const uint32_t storage = count_storage_buffers(bindings);
    const auto uniform = static_cast<uint32_t>(bindings.size()) - storage;
    if (sets_left_ == 0 || buffers_left_ < storage || uniform_buffers_left_ < uniform)
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
    set_name(context_, VK_OBJECT_TYPE_DESCRIPTOR_SET, set, kernel.name());
    --sets_left_;
    buffers_left_ -= storage;
    uniform_buffers_left_ -= uniform;

    std::vector<VkDescriptorBufferInfo> infos;
    infos.reserve(buffers.size());
    std::vector<VkBufferView> views;
    views.reserve(buffers.size());
    std::vector<VkWriteDescriptorSet> writes;
    const auto add_write = [&](uint32_t number, VkDescriptorType type) -> VkWriteDescriptorSet&
    {
        VkWriteDescriptorSet& write = writes.emplace_back();
        write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        write.dstSet = set;
        write.dstBinding = number;
        write.descriptorCount = 1;
        write.descriptorType = type;
        return write;
    };
    for (const BufferBinding& given : buffers)
    {
        const ShaderBinding& binding = *std::ranges::find(bindings, given.number, &ShaderBinding::number);
        infos.push_back({given.buffer, given.offset, given.bytes});
        if (has_buffer(binding))
            add_write(given.number, type_of(binding)).pBufferInfo = &infos.back();
        if (binding.texel_bytes == 0)
            continue;
        const auto view = create_view(given, binding.texel_bytes);
        if (!view)
            return Error{std::string("kernel \"") + kernel.name() + "\": " + view.error().message};
        views.push_back(view.value());
        add_write(binding.texel_number, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER).pTexelBufferView = &views.back();
    }
    context_.fn.vkUpdateDescriptorSets(context_.device(), static_cast<uint32_t>(writes.size()), writes.data(), 0,
                                       nullptr);
    return set;
}

} // namespace voile::gpu
