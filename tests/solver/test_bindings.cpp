// Buffers and constants are bound to kernels by name. A wrong or missing one is an error with the kernel and the name.
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"
#include "support/test_paths.hpp"

#include "buffer_table.hpp"
#include "solver/buffer_declarations.hpp"
#include "solver/descriptor_sets.hpp"
#include "test_lifetime_shaders.hpp"
#include "test_new_shaders_shaders.hpp"

#include "shared/contact_layout.h"

#include <cctype>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

namespace voile::shaders
{
extern const std::span<const uint32_t> k_contact_comp; // of the module
} // namespace voile::shaders

namespace
{

using tests::reason;
namespace binding = voile::binding;
namespace buffer = voile::buffer;

class Bindings : public tests::GpuFixture
{
public:
    Bindings() : kernels(voile::engine::take(voile::create_kernels(tests::solver_context(), {.intersections = true})))
    {
    }

    voile::Kernels kernels;
};

using Roles = std::vector<voile::RoleBuffer>;

} // namespace

TEST_CASE_FIXTURE(Bindings, "a wrong or missing name in a set is an error that names kernel and binding")
{
    CHECK(reason(voile::check_sets(kernels)) == "accepted");
    const auto tethers = [&](buffer::Name positions, buffer::Name residuals, const Roles& more = {})
    {
        Roles roles{{binding::proposed_positions, positions},
                    {binding::proposed_residuals, residuals},
                    {binding::proposed_velocities, buffer::velocities},
                    {binding::proposed_predicted, buffer::stage_a_velocities}};
        roles.insert(roles.end(), more.begin(), more.end());
        return reason(voile::resolve(kernels.tethers, roles));
    };
    const voile::RoleBuffer earlier{binding::earlier_positions, buffer::stage_b_positions};
    CHECK(tethers(buffer::positions, buffer::residuals, {earlier}) == "accepted");
    CHECK(tethers(buffer::positions, buffer::residuals) ==
          "kernel \"cloth tethers\": binding \"earlier_positions\" has no buffer");
    CHECK(tethers(buffer::positions, buffer::residuals, {earlier, earlier}) ==
          "kernel \"cloth tethers\": binding \"earlier_positions\" has more than one buffer");
    CHECK(tethers(buffer::residuals, buffer::positions, {earlier}) ==
          "kernel \"cloth tethers\": binding \"proposed_positions\" has entries of type vec4, buffer \"residuals\" of "
          "type uvec2");
    CHECK(tethers(buffer::positions, buffer::residuals,
                  {earlier, {binding::step_votes, buffer::depenetration_votes_even}}) ==
          "kernel \"cloth tethers\" has no binding \"step_votes\"");
}

TEST_CASE_FIXTURE(Bindings, "a set of a pool has one buffer for each binding of its kernel")
{
    const voile::gpu::Buffer any = voile::engine::take(
        voile::gpu::create_buffer(context(), "any", 256, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, voile::Memory::device));
    voile::gpu::BindingPool pool = voile::engine::take(voile::gpu::BindingPool::create(context(), 1, 3));
    const auto bound = [&](std::initializer_list<uint32_t> numbers)
    {
        std::vector<voile::gpu::BufferBinding> buffers;
        for (const uint32_t number : numbers)
            buffers.push_back({number, any.handle()});
        return reason(pool.bind(kernels.statistics_reduce, buffers));
    };
    CHECK(bound({binding::partials}) == "kernel \"cloth statistics reduce\": binding 53 \"Statistics\" has no buffer");
    CHECK(bound({binding::partials, binding::statistics, binding::pair_bounds, binding::partials}) ==
          "kernel \"cloth statistics reduce\": binding 52 \"Partials\" has more than one buffer");
    CHECK(bound({binding::partials, binding::statistics, binding::pair_bounds, binding::cloths}) ==
          "kernel \"cloth statistics reduce\" has no binding 0");
    CHECK(bound({binding::pair_bounds, binding::statistics, binding::partials}) == "accepted");
    CHECK(bound({binding::pair_bounds, binding::statistics, binding::partials}) ==
          "descriptor set of kernel \"cloth statistics reduce\": the pool is used up");
}

namespace
{

std::vector<voile::gpu::SpecializationConstant> contact_constants()
{
    return {{0, 128}, {1, 1}, {2, 1}, {3, 0}, {4, 0}, {5, 0}, {7, 0}};
}

voile::gpu::KernelDescription contact()
{
    return {"contact", voile::shaders::k_contact_comp, contact_constants()};
}

// The words without OpName and OpMemberName.
std::vector<uint32_t> strip_names(std::span<const uint32_t> spirv)
{
    std::vector<uint32_t> stripped(spirv.begin(), spirv.begin() + 5);
    for (size_t at = 5; at < spirv.size(); at += spirv[at] >> 16)
        if (const uint32_t opcode = spirv[at] & 0xffff; opcode != 5 && opcode != 6)
            stripped.insert(stripped.end(), spirv.begin() + static_cast<std::ptrdiff_t>(at),
                            spirv.begin() + static_cast<std::ptrdiff_t>(at + (spirv[at] >> 16)));
    return stripped;
}

} // namespace

TEST_CASE("a specialization constant without a value, or with a value and no constant, is an error")
{
    CHECK(reason(voile::gpu::reflect(contact())) == "accepted");
    voile::gpu::KernelDescription description = contact();
    description.specialization.pop_back();
    CHECK(reason(voile::gpu::reflect(description)) ==
          "kernel \"contact\": specialization constant 7 \"PAIRS\" has no value");
    description.specialization = contact_constants();
    description.specialization.push_back({6, 1});
    CHECK(reason(voile::gpu::reflect(description)) == "kernel \"contact\" has no specialization constant 6");
}

TEST_CASE("a kernel's interface is the same without names in its SPIR-V")
{
    voile::gpu::KernelDescription description = contact();
    const auto named = voile::engine::take(voile::gpu::reflect(description));
    const std::vector<uint32_t> stripped = strip_names(description.spirv);
    REQUIRE(stripped.size() < description.spirv.size());
    description.spirv = stripped;
    const auto nameless = voile::engine::take(voile::gpu::reflect(description));
    CHECK(named.push_bytes == sizeof(voile::shared::ContactPush));
    CHECK(nameless.push_bytes == named.push_bytes);
    CHECK(nameless.shared_bytes == named.shared_bytes);
    REQUIRE(nameless.bindings.size() == named.bindings.size());
    for (size_t i = 0; i < named.bindings.size(); ++i)
    {
        CHECK(nameless.bindings[i].number == named.bindings[i].number);
        CHECK(nameless.bindings[i].stride == named.bindings[i].stride);
        CHECK(nameless.bindings[i].read == named.bindings[i].read);
        CHECK(nameless.bindings[i].written == named.bindings[i].written);
        CHECK(nameless.bindings[i].name.empty());
    }
    description.specialization.pop_back();
    CHECK(reason(voile::gpu::reflect(description)) == "kernel \"contact\": specialization constant 7 has no value");
}

TEST_CASE("an array of buffers, and a shader that is no kernel, are errors")
{
    CHECK(reason(voile::gpu::reflect({"vertices", tests::shaders::k_no_compute_vert, {}})) ==
          "kernel \"vertices\": it has no compute entry point \"main\"");
    CHECK(reason(voile::gpu::reflect({"array", tests::shaders::k_buffer_array_comp, {}})) ==
          "kernel \"array\": binding 3 is an array of buffers");
}

TEST_CASE("literal sizes of a workgroup count, and push constants end at a word")
{
    const voile::gpu::KernelDescription description{"large", tests::shaders::k_large_workgroup_comp, {}};
    const auto shader = voile::engine::take(voile::gpu::reflect(description));
    CHECK(shader.workgroup == std::array<uint32_t, 3>{32, 32, 2});
    CHECK(shader.push_bytes == 8);
    VkPhysicalDeviceLimits limits = tests::solver_context().limits;
    limits.maxComputeWorkGroupInvocations = 2048;
    limits.maxComputeSharedMemorySize = 8192;
    CHECK(reason(voile::gpu::check_limits(limits, description)) == "accepted");
    limits.maxComputeSharedMemorySize = 8191;
    CHECK(reason(voile::gpu::check_limits(limits, description)) ==
          "kernel \"large\" takes 8192 bytes of shared memory with a workgroup of 32 x 32 x 2, the device has 8191");
    limits.maxComputeWorkGroupInvocations = 2047;
    CHECK(reason(voile::gpu::check_limits(limits, description)) ==
          "kernel \"large\" has a workgroup of 32 x 32 x 2, 2048 threads, the device allows 2047");
    limits.maxComputeWorkGroupSize[2] = 1;
    CHECK(reason(voile::gpu::check_limits(limits, description)) ==
          "kernel \"large\" has a workgroup of 32 x 32 x 2, the device allows 1 to 1 in z");
}

TEST_CASE("the specialized workgroup of SPIR-V 1.6 counts")
{
    const voile::gpu::KernelDescription description{"sized", tests::new_shaders::k_sized_workgroup_comp, {{0, 96}}};
    CHECK(voile::engine::take(voile::gpu::reflect(description)).workgroup == std::array<uint32_t, 3>{96, 1, 1});
}

TEST_CASE_FIXTURE(Bindings, "the block of each binding has the binding's name")
{
    voile::DescriptorSets sets;
    std::set<uint32_t> bound;
    std::vector<voile::SetDescription> descriptions = voile::describe_sets(sets, kernels);
    VkDescriptorSet output = VK_NULL_HANDLE;
    descriptions.push_back(voile::describe_output(output, kernels, true));
    for (const voile::SetDescription& set : descriptions)
        for (const voile::gpu::ShaderBinding& declared : set.kernel->bindings())
        {
            std::string name; // snake_case from CamelCase
            for (const char letter : declared.name)
            {
                if (std::isupper(static_cast<unsigned char>(letter)) != 0 && !name.empty())
                    name += '_';
                name += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
            }
            CHECK(name == std::string(voile::find_declaration(declared.number)->name));
            bound.insert(declared.number);
        }
    for (const voile::BufferDeclaration& declared : voile::buffer_declarations())
        if (declared.kind == voile::BufferKind::role)
            CHECK_MESSAGE(bound.contains(declared.number), "no kernel has the role " << declared.name);
}

TEST_CASE_FIXTURE(Bindings, "docs/buffers.md lists who reads and who writes each buffer")
{
    const std::string expected = tests::buffer_table(kernels);
    const std::filesystem::path path = tests::source("docs/buffers.md");
    if (std::getenv("VOILE_WRITE_DOCS") != nullptr)
        std::ofstream(path) << expected;
    std::stringstream found;
    found << std::ifstream(path).rdbuf();
    CHECK_MESSAGE(found.str() == expected, "docs/buffers.md is out of date; its head says how it is written");
}
