// Reads of storage buffers as texels give the same bits, whatever the layout, on every device.
#include "support/gpu_fixture.hpp"

#include "test_lifetime_shaders.hpp"
#include "voile/engine/gpu/upload.hpp"
#include "voile/gpu/kernel.hpp"
#include "voile/gpu/recorder.hpp"

#include <array>
#include <random>
#include <vector>

namespace
{

constexpr uint32_t k_threads = 64;
constexpr uint32_t k_words = 51; // that a thread of read_texels.comp writes

// Of the buffers of read_texels.comp: words per entry, and words before the first one.
struct Layout
{
    uint32_t words = 0;
    uint32_t before = 0;
};
constexpr std::array<Layout, 8> k_layouts{{{28}, {6}, {1}, {16}, {8}, {4, 4}, {4}, {2}}};
using Inputs = std::array<std::vector<uint32_t>, k_layouts.size()>;

Inputs random_inputs()
{
    std::mt19937 random(1);
    Inputs inputs;
    for (size_t b = 0; b < inputs.size(); ++b)
        for (uint32_t i = 0; i < k_layouts[b].before + k_layouts[b].words * k_threads; ++i)
            inputs[b].push_back(random() & 0x3fffffff); // floats without the bits of what is not a number
    return inputs;
}

// What the threads write, from the layouts that std430 gives the buffers.
std::vector<uint32_t> expected_answers(const Inputs& inputs)
{
    std::vector<uint32_t> answers;
    for (uint32_t i = 0; i < k_threads; ++i)
    {
        const auto put = [&](size_t buffer, std::initializer_list<uint32_t> words)
        {
            for (const uint32_t word : words)
                answers.push_back(inputs[buffer][k_layouts[buffer].before + k_layouts[buffer].words * i + word]);
        };
        put(0, {0, 1, 2, 3, 4, 5, 6, 7});
        put(0, {8, 9, 10, 12, 13, 14, 16, 17, 18});
        put(0, {20, 21, 22, 23, 24, 25, 26, 27});
        put(0, {20 + 4 * (i & 1) + 3});
        const uint32_t column = 8 + 4 * (i % 3);
        put(0, {column, column + 1, column + 2, i % 3, 5});
        put(1, {0, 1, 2, 3, 4, 5});
        put(2, {0});
        put(3, {12, 13, 14, 15, 4 + (i & 3)});
        put(4, {0, 1, 2, 3 + i % 5});
        put(5, {2});
        put(6, {1});
        put(7, {0, 1});
    }
    return answers;
}

class TexelReads : public tests::GpuFixture
{
public:
    explicit TexelReads(bool texels) : context_(tests::solver_context())
    {
        context_.texel_reads = texels;
        kernel = voile::engine::take(voile::gpu::Kernel::create(
            context_, {"read texels", tests::shaders::k_read_texels_comp, {{0, k_threads}}}));
    }

    std::vector<uint32_t> answers(const Inputs& inputs)
    {
        voile::engine::UploadBatch batch(context_);
        std::vector<voile::gpu::Buffer> buffers;
        for (const std::vector<uint32_t>& words : inputs)
            buffers.push_back(batch.buffer("input", words, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
        const size_t count = expected_answers(inputs).size();
        buffers.push_back(voile::engine::take(voile::gpu::create_buffer(
            context_, "answers", count * sizeof(uint32_t),
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT, voile::Memory::device)));
        std::vector<voile::gpu::BufferBinding> bound;
        for (const voile::gpu::Buffer& buffer : buffers)
            bound.push_back({static_cast<uint32_t>(bound.size()), buffer.handle()});
        auto pool =
            voile::engine::take(voile::gpu::BindingPool::create(context_, 1, static_cast<uint32_t>(bound.size())));
        const VkDescriptorSet set = voile::engine::take(pool.bind(kernel, bound));
        run(
            [&](VkCommandBuffer cmd)
            {
                batch.record(cmd);
                voile::gpu::Recorder(context_, cmd).dispatch(kernel, set, k_threads, k_threads, k_words);
            });
        return read<uint32_t>(buffers.back().handle(), count);
    }

    voile::gpu::Kernel kernel;

private:
    voile::gpu::Context context_;
};

} // namespace

TEST_CASE("reads as texels give the bits of reads from storage buffers, whatever the layout")
{
    const Inputs inputs = random_inputs();
    const std::vector<uint32_t> expected = expected_answers(inputs);
    REQUIRE(expected.size() == size_t{k_threads} * k_words);
    for (const bool texels : {false, true})
    {
        CAPTURE(texels);
        TexelReads reads(texels);
        CHECK(reads.answers(inputs) == expected);
    }
}

TEST_CASE("texels are as wide as the layout allows; what does not fit, is written or has its length asked for has none")
{
    const TexelReads reads(true);
    std::vector<uint32_t> bytes;
    for (const voile::gpu::ShaderBinding& binding : reads.kernel.bindings())
        bytes.push_back(binding.texel_bytes);
    CHECK(bytes == std::vector<uint32_t>{16, 8, 4, 16, 0, 0, 0, 0, 0});
    const TexelReads without(false);
    for (const voile::gpu::ShaderBinding& binding : without.kernel.bindings())
        CHECK(binding.texel_bytes == 0);
}
