#include "solver/descriptor_sets.hpp"

#include "solver/buffer_declarations.hpp"
#include "solver/state_buffers.hpp"

#include <algorithm>
#include <cstring>

namespace voile
{

namespace
{

// The declaration of a kernel's binding. Errors: there is none, its entries have another size.
Result<const BufferDeclaration*> declaration_of(const gpu::Kernel& kernel, const gpu::ShaderBinding& binding)
{
    const std::string name = std::string("kernel \"") + kernel.name() + "\": binding ";
    const BufferDeclaration* declared = find_declaration(binding.number);
    if (declared == nullptr)
        return Error{name + std::to_string(binding.number) + " is in no table of buffers"};
    if (binding.stride == 0 || declared->entry_bytes % binding.stride != 0) // it may be read in parts
        return Error{name + '"' + declared->name + "\" has entries of " + std::to_string(binding.stride) +
                     " bytes, a " + declared->entry + " has " + std::to_string(declared->entry_bytes)};
    return declared;
}

Result<buffer::Name> buffer_of(const gpu::Kernel& kernel, const BufferDeclaration& declared,
                               std::span<const RoleBuffer> roles)
{
    const std::string name = std::string("kernel \"") + kernel.name() + "\": binding \"" + declared.name + "\" ";
    const auto count = std::ranges::count(roles, declared.number, &RoleBuffer::binding);
    if (count > 1)
        return Error{name + "has more than one buffer"};
    if (count == 0 && declared.number >= buffer::k_numbers)
        return Error{name + "has no buffer"};
    if (count == 0)
        return static_cast<buffer::Name>(declared.number);
    const buffer::Name given = std::ranges::find(roles, declared.number, &RoleBuffer::binding)->buffer;
    const BufferDeclaration* bound = find_declaration(given);
    if (bound == nullptr || std::strcmp(bound->entry, declared.entry) != 0)
        return Error{name + "has entries of type " + declared.entry + ", buffer \"" +
                     (bound != nullptr ? bound->name : "?") + "\" of type " + (bound != nullptr ? bound->entry : "?")};
    return given;
}

} // namespace

Result<std::vector<buffer::Name>> resolve(const gpu::Kernel& kernel, std::span<const RoleBuffer> roles)
{
    const std::vector<gpu::ShaderBinding>& bindings = kernel.bindings();
    for (const RoleBuffer& role : roles)
        if (std::ranges::find(bindings, role.binding, &gpu::ShaderBinding::number) == bindings.end())
        {
            const BufferDeclaration* declared = find_declaration(role.binding);
            return Error{std::string("kernel \"") + kernel.name() + "\" has no binding \"" +
                         (declared != nullptr ? declared->name : "?") + '"'};
        }
    std::vector<buffer::Name> buffers;
    for (const gpu::ShaderBinding& binding : bindings)
    {
        const auto declared = declaration_of(kernel, binding);
        if (!declared)
            return declared.error();
        const auto buffer = buffer_of(kernel, *declared.value(), roles);
        if (!buffer)
            return buffer.error();
        buffers.push_back(buffer.value());
    }
    return buffers;
}

Result<void> check_sets(const Kernels& kernels)
{
    DescriptorSets none;
    std::vector<SetDescription> descriptions = describe_sets(none, kernels);
    VkDescriptorSet output = VK_NULL_HANDLE;
    for (const bool keeps_previous : {false, true})
        descriptions.push_back(describe_output(output, kernels, keeps_previous));
    for (const SetDescription& description : descriptions)
        if (const auto buffers = resolve(*description.kernel, description.roles); !buffers)
            return buffers.error();
    return {};
}

Result<std::vector<gpu::BufferBinding>> bindings_of(const SetDescription& description, const BufferHandles& buffers)
{
    const auto names = resolve(*description.kernel, description.roles);
    if (!names)
        return names.error();
    std::vector<gpu::BufferBinding> bound;
    for (size_t i = 0; i < names.value().size(); ++i)
        bound.push_back({description.kernel->bindings()[i].number, buffers[names.value()[i]]});
    return bound;
}

Result<gpu::BindingPool> write_sets(DescriptorSets& sets, const gpu::Context& context, const Kernels& kernels,
                                    const BufferHandles& buffers)
{
    const std::vector<SetDescription> descriptions = describe_sets(sets, kernels);
    uint32_t storage = 0;
    uint32_t uniform = 0;
    for (const SetDescription& description : descriptions)
        for (const gpu::ShaderBinding& binding : description.kernel->bindings())
            ++(binding.uniform ? uniform : storage);
    auto pool = gpu::BindingPool::create(context, static_cast<uint32_t>(descriptions.size()), storage, uniform);
    if (!pool)
        return pool.error();
    for (const SetDescription& description : descriptions)
    {
        const auto bound = bindings_of(description, buffers);
        if (!bound)
            return bound.error();
        auto set = pool.value().bind(*description.kernel, bound.value());
        if (!set)
            return set.error();
        *description.set = set.value();
    }
    return pool;
}

} // namespace voile
