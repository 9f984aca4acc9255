#include "buffer_table.hpp"

#include "solver/buffer_declarations.hpp"
#include "solver/descriptor_sets.hpp"

#include "voile/engine/gpu/device.hpp"

#include <map>
#include <set>

namespace tests
{

namespace
{

// By number: the kernels that read and that write a buffer, and the buffers that have a role.
struct Uses
{
    std::map<uint32_t, std::set<std::string>> readers;
    std::map<uint32_t, std::set<std::string>> writers;
    std::map<uint32_t, std::set<std::string>> buffers;
};

Uses find_uses(const voile::Kernels& kernels)
{
    Uses uses;
    voile::DescriptorSets sets;
    std::vector<voile::SetDescription> descriptions = voile::describe_sets(sets, kernels);
    VkDescriptorSet output = VK_NULL_HANDLE;
    descriptions.push_back(voile::describe_output(output, kernels, true));
    for (const voile::SetDescription& set : descriptions)
    {
        const auto buffers = voile::engine::take(voile::resolve(*set.kernel, set.roles));
        const std::string kernel = std::string(set.kernel->name()).substr(std::string("cloth ").size());
        for (size_t i = 0; i < buffers.size(); ++i)
        {
            const voile::gpu::ShaderBinding& binding = set.kernel->bindings()[i];
            for (const uint32_t number : {static_cast<uint32_t>(buffers[i]), binding.number})
            {
                if (binding.read)
                    uses.readers[number].insert(kernel);
                if (binding.written)
                    uses.writers[number].insert(kernel);
            }
            uses.buffers[binding.number].insert(voile::find_declaration(buffers[i])->name);
        }
    }
    return uses;
}

std::string list(const std::set<std::string>& names)
{
    std::string text;
    for (const std::string& name : names)
        text += (text.empty() ? "" : ", ") + name;
    return text;
}

std::string code(const std::string& text)
{
    return '`' + text + '`';
}

} // namespace

std::string buffer_table(const voile::Kernels& kernels)
{
    Uses uses = find_uses(kernels);
    std::string buffers =
        "| buffer | entry | count | holds | read by | written by |\n| --- | --- | --- | --- | --- | --- |\n";
    std::string roles =
        "| role | entry | is | buffers | read by | written by |\n| --- | --- | --- | --- | --- | --- |\n";
    for (const voile::BufferDeclaration& declared : voile::buffer_declarations())
    {
        const bool role = declared.kind == voile::BufferKind::role;
        const bool hosts = declared.kind == voile::BufferKind::hosts;
        const std::string count = declared.count != nullptr ? code(declared.count) : hosts ? "the host's" : "per slot";
        const std::string middle =
            role ? declared.meaning + (" | " + list(uses.buffers[declared.number])) : count + " | " + declared.meaning;
        (role ? roles : buffers) += "| " + code(declared.name) + " | " + declared.entry + " | " + middle + " | " +
                                    list(uses.readers[declared.number]) + " | " + list(uses.writers[declared.number]) +
                                    " |\n";
    }
    return "# The buffers of the solver\n\n"
           "Written by `VOILE_WRITE_DOCS=1 build/release/bin/test_lifetime -tc=\"docs/buffers.md*\"` from\n"
           "[buffers.h](../shaders/cloth/shared/buffers.h), the descriptor sets and the SPIR-V of the kernels; do not "
           "edit.\n\n"
           "Counts are expressions over BufferCounts (modules/cloth/src/solver/device_state.cpp). Readers and writers "
           "are\n"
           "kernels. Uploads, edits and copies write buffers besides, and the host draws from "
           "some.\nARCHITECTURE.md lists the passes in their order.\n\n"
           "## Buffers\n" +
           buffers +
           "\n## Roles\nWhat kernels call buffers that change from set to set "
           "([set_descriptions.cpp](../modules/cloth/src/solver/set_descriptions.cpp)).\n\n" +
           roles;
}

} // namespace tests
