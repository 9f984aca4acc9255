// Reads of storage buffers as texels give the same bits, whatever the layout, on every device.
#include "support/gpu_fixture.hpp"

#include "modules/gpu/src/texel_reads.hpp"
#include "test_lifetime_shaders.hpp"
#include "test_old_shaders_shaders.hpp"
#include "voile/engine/gpu/upload.hpp"
#include "voile/gpu/kernel.hpp"
#include "voile/gpu/recorder.hpp"

#include <array>
#include <numeric>
#include <random>
#include <span>
#include <vector>

namespace
{

constexpr uint32_t k_threads = 64;
constexpr uint32_t k_words = 55; // that a thread of read_texels.comp writes

// Of the buffers of read_texels.comp: words per entry, and words before the first one.
struct Layout
{
    uint32_t words = 0;
    uint32_t before = 0;
};
constexpr std::array<Layout, 10> k_layouts{{{28}, {6}, {1}, {16}, {8}, {4, 4}, {4}, {2}, {4}, {4}}};
constexpr size_t k_padded = 9;        // its range ends where the last entry does,
constexpr VkDeviceSize k_padding = 4; // so many bytes before the next one would begin
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
        answers.push_back(inputs[5][3]);
        answers.push_back(inputs[6][4 * (i ^ 1) + 1]);
        put(7, {0, 1});
        answers.push_back(i);
        put(8, {1});
        put(9, {2});
    }
    return answers;
}

// A kernel whose threads each write `words` to its last buffer.
class TexelReads : public tests::GpuFixture
{
public:
    explicit TexelReads(bool texels, std::span<const uint32_t> spirv = tests::shaders::k_read_texels_comp,
                        uint32_t words = k_words)
        : context_(tests::solver_context()), words_(words)
    {
        context_.texel_reads = texels;
        kernel = voile::engine::take(voile::gpu::Kernel::create(context_, {"read texels", spirv, {{0, k_threads}}}));
    }

    std::vector<uint32_t> answers(std::span<const std::vector<uint32_t>> inputs)
    {
        voile::engine::UploadBatch batch(context_);
        std::vector<voile::gpu::Buffer> buffers;
        for (const std::vector<uint32_t>& words : inputs)
            buffers.push_back(batch.buffer("input", words, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
        const size_t count = size_t{k_threads} * words_;
        buffers.push_back(voile::engine::take(voile::gpu::create_buffer(
            context_, "answers", count * sizeof(uint32_t),
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT, voile::Memory::device)));
        std::vector<voile::gpu::BufferBinding> bound;
        for (const voile::gpu::Buffer& buffer : buffers)
            bound.push_back({static_cast<uint32_t>(bound.size()), buffer.handle()});
        if (inputs.size() > k_padded)
            bound[k_padded].bytes = inputs[k_padded].size() * sizeof(uint32_t) - k_padding;
        auto pool =
            voile::engine::take(voile::gpu::BindingPool::create(context_, 1, static_cast<uint32_t>(bound.size())));
        const VkDescriptorSet set = voile::engine::take(pool.bind(kernel, bound));
        run([&](VkCommandBuffer cmd) { batch.record(cmd); });
        run([&](VkCommandBuffer cmd)
            { voile::gpu::Recorder(context_, cmd).dispatch(kernel, set, k_threads, k_threads, words_); });
        return read<uint32_t>(buffers.back().handle(), count);
    }

    voile::gpu::Kernel kernel;

private:
    voile::gpu::Context context_;
    uint32_t words_ = 0;
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

TEST_CASE("texels are as wide as the layout allows, and beside a storage buffer where that is written or has its "
          "length asked for")
{
    const TexelReads reads(true);
    std::vector<uint32_t> bytes;
    for (const voile::gpu::ShaderBinding& binding : reads.kernel.bindings())
        bytes.push_back(binding.texel_bytes);
    CHECK(bytes == std::vector<uint32_t>{16, 8, 4, 16, 0, 16, 16, 8, 16, 0, 0});
    for (const uint32_t number : {0u, 1u, 2u, 3u}) // these have no storage buffer
        CHECK(reads.kernel.bindings()[number].texel_number == number);
    for (const uint32_t number : {5u, 6u, 7u, 8u})
        CHECK(reads.kernel.bindings()[number].texel_number > 10);
    const TexelReads without(false);
    for (const voile::gpu::ShaderBinding& binding : without.kernel.bindings())
        CHECK(binding.texel_bytes == 0);
}

TEST_CASE("storage buffers of SPIR-V 1.0, which it declares in another way, are bound and read")
{
    std::vector<uint32_t> words(k_threads);
    std::iota(words.begin(), words.end(), 7u);
    std::vector<uint32_t> twice;
    for (const uint32_t word : words)
        twice.push_back(2 * word);
    for (const bool texels : {false, true})
    {
        CAPTURE(texels);
        TexelReads reads(texels, tests::old_shaders::k_double_words_comp, 1);
        CHECK(reads.answers({&words, 1}) == twice);
        CHECK(reads.kernel.bindings()[0].texel_bytes == (texels ? 4 : 0));
        CHECK_FALSE(reads.kernel.bindings()[1].uniform);
        CHECK(reads.kernel.bindings()[1].stride == 4);
    }
}

// llvmpipe 22.3 ends the process where a texel's number is made from such an index.
TEST_CASE("entries at an index of 16 bits are read from storage buffers")
{
    CHECK(voile::gpu::texel_reads(tests::shaders::k_narrow_index_comp).bindings.empty());
}
