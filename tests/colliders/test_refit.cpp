// Padded BVHs: every triangle has one slot, and a refit on the GPU equals the recursive union on the host.
#include "support/gpu_fixture.hpp"

#include "colliders/refit.hpp"
#include "geometry/padded_tree.hpp"

#include "shared/bindings.h"

#include "colliders/visit_padded_layout.h"
#include "test_refit_shaders.hpp"
#include "voile/engine/gpu/upload.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace
{

using voile::shared::PaddedBox;

constexpr std::array k_counts{1u, 2u, 3u, 4u, 5u, 7u, 31u, 32u, 33u, 1000u, 65537u};

struct Soup
{
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
};

// Small triangles that share vertices, in a cube.
Soup random_soup(uint32_t count)
{
    std::mt19937 random(count);
    std::uniform_real_distribution<float> coordinate(-1, 1);
    const float size = 1 / std::cbrt(static_cast<float>(count));
    Soup soup;
    for (uint32_t i = 0; i < count; ++i)
    {
        const glm::vec3 center(coordinate(random), coordinate(random), coordinate(random));
        const auto first = static_cast<uint32_t>(soup.positions.size());
        for (int corner = 0; corner < (i == 0 ? 3 : 2); ++corner)
            soup.positions.push_back(center +
                                     size * glm::vec3(coordinate(random), coordinate(random), coordinate(random)));
        soup.triangles.emplace_back(first, first + 1, i == 0 ? first + 2 : first - 1);
    }
    return soup;
}

// The layout of a vertex buffer; w is padding and must not matter.
std::vector<glm::vec4> moved(const std::vector<glm::vec3>& positions, uint32_t seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> push(-0.3f, 0.3f);
    std::vector<glm::vec4> result;
    result.reserve(positions.size());
    for (const glm::vec3& p : positions)
        result.emplace_back(p + glm::vec3(push(random), push(random), push(random)), 1e6f);
    return result;
}

PaddedBox merge(const PaddedBox& a, const PaddedBox& b)
{
    return {glm::min(a.min, b.min), 0, glm::max(a.max, b.max), 0};
}

// The recursive union: fills the boxes below box `box` of a level and returns it.
PaddedBox expect(const voile::PaddedTree& tree, const glm::vec4* from, const glm::vec4* to, uint32_t level,
                 uint32_t box, std::vector<PaddedBox>& boxes)
{
    PaddedBox result{};
    const uint32_t count = 1u << level;
    if (level == tree.levels)
    {
        const float far = std::numeric_limits<float>::infinity();
        result = {glm::vec3(far), 0, glm::vec3(-far), 0};
        const glm::uvec3& corners = tree.leaves.at(box).corners;
        for (int corner = 0; corner < 3; ++corner)
            for (const glm::vec4* positions : {from, to})
            {
                const glm::vec3 p(positions[corners[corner]]);
                result = merge(result, {p, 0, p, 0});
            }
    }
    else
        result =
            merge(expect(tree, from, to, level + 1, box, boxes), expect(tree, from, to, level + 1, box + count, boxes));
    return boxes.at(count - 1 + box) = result;
}

// Buffers around one tree, which starts at an offset in each of them.
class RefitFixture : public tests::GpuFixture
{
public:
    static constexpr uint32_t k_first_leaf = 3;
    static constexpr uint32_t k_first_from = 5;

    void upload(const voile::PaddedTree& tree, const std::vector<glm::vec4>& from, const std::vector<glm::vec4>& to)
    {
        refit_tree_ = {};
        refit_tree_.first_box = voile::aligned_first_box(2);
        refit_tree_.first_leaf = k_first_leaf;
        refit_tree_.first_from = k_first_from;
        refit_tree_.first_to = k_first_from + static_cast<uint32_t>(from.size());
        refit_tree_.triangles = tree.triangles;
        std::vector<voile::shared::PaddedLeaf> leaves(k_first_leaf);
        leaves.insert(leaves.end(), tree.leaves.begin(), tree.leaves.end());
        std::vector<glm::vec4> positions(k_first_from, glm::vec4(1e9f));
        positions.insert(positions.end(), from.begin(), from.end());
        positions.insert(positions.end(), to.begin(), to.end());
        const PaddedBox untouched{glm::vec3(7), 7, glm::vec3(7), 7};
        const std::vector<PaddedBox> boxes(refit_tree_.first_box + tree.boxes() + 1, untouched);
        voile::engine::UploadBatch batch(context());
        trees_ = batch.buffer("trees", std::vector{refit_tree_}, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
        leaves_ = batch.buffer("leaves", leaves, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
        positions_ = batch.buffer("positions", positions, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
        boxes_ = batch.buffer("boxes", boxes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
        run([&](VkCommandBuffer cmd) { batch.record(cmd); });
    }

    // The tree's boxes after a refit with the given workgroup size.
    std::vector<PaddedBox> refit(const voile::PaddedTree& tree, uint32_t workgroup_size)
    {
        const voile::RefitKernels kernels = voile::engine::take(voile::create_refit_kernels(context(), workgroup_size));
        voile::gpu::BindingPool pool = voile::engine::take(voile::gpu::BindingPool::create(context(), 1, 4));
        const VkDescriptorSet set =
            voile::engine::take(pool.bind(kernels.leaves, {{voile::binding::cloth_trees, trees_.handle()},
                                                           {voile::binding::refit_leaves, leaves_.handle()},
                                                           {voile::binding::refit_positions, positions_.handle()},
                                                           {voile::binding::refit_boxes, boxes_.handle()}}));
        run(
            [&](VkCommandBuffer cmd)
            {
                voile::gpu::Recorder recorder(context(), cmd);
                voile::record_refit(recorder, kernels, set, refit_tree_);
                voile::gpu::Recorder dry(context());
                voile::record_refit(dry, kernels, set, refit_tree_);
                CHECK(dry.dispatches() == recorder.dispatches());
                const uint32_t levels = std::max(1u, voile::padded_levels(tree.triangles));
                CHECK(recorder.dispatches() ==
                      (levels + kernels.levels_per_dispatch - 1) / kernels.levels_per_dispatch);
            });
        std::vector<PaddedBox> boxes = read<PaddedBox>(boxes_.handle(), refit_tree_.first_box + tree.boxes() + 1);
        CHECK(boxes.at(refit_tree_.first_box - 1).min.x == 7); // data around the tree is untouched
        CHECK(boxes.back().min.x == 7);
        boxes.pop_back();
        boxes.erase(boxes.begin(), boxes.begin() + refit_tree_.first_box);
        return boxes;
    }

    // For each query box the slots that a traversal of the refitted boxes visits, in its order.
    std::vector<std::vector<uint32_t>> visit(const std::vector<PaddedBox>& queries, uint32_t triangles)
    {
        constexpr uint32_t k_group = 64;
        const auto count = static_cast<uint32_t>(queries.size());
        const tests::shared::VisitPush push{refit_tree_.first_box, k_first_leaf, triangles, count, triangles + 2};
        voile::engine::UploadBatch batch(context());
        const voile::gpu::Buffer asked = batch.buffer("queries", queries, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
        const size_t words = size_t{count} * push.room;
        const voile::gpu::Buffer answers = voile::engine::take(voile::gpu::create_buffer(
            context(), "answers", words * sizeof(uint32_t),
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT, voile::Memory::device));
        const voile::gpu::Kernel kernel = voile::engine::take(voile::gpu::Kernel::create(
            context(), {"visit padded", tests::shaders::k_visit_padded_comp, {{0, k_group}}}));
        voile::gpu::BindingPool pool = voile::engine::take(voile::gpu::BindingPool::create(context(), 1, 3));
        const VkDescriptorSet set = voile::engine::take(pool.bind(
            kernel,
            {{VISIT_BOXES, boxes_.handle()}, {VISIT_QUERIES, asked.handle()}, {VISIT_ANSWERS, answers.handle()}}));
        run(
            [&](VkCommandBuffer cmd)
            {
                batch.record(cmd);
                voile::gpu::Recorder(context(), cmd).dispatch(kernel, set, count, k_group, push);
            });
        const std::vector<uint32_t> found = read<uint32_t>(answers.handle(), words);
        std::vector<std::vector<uint32_t>> result;
        for (auto answer = found.begin(); answer != found.end(); answer += push.room)
        {
            REQUIRE(*answer < push.room);
            result.emplace_back(answer + 1, answer + 1 + *answer);
        }
        return result;
    }

private:
    voile::shared::TreeRecord refit_tree_;
    voile::gpu::Buffer trees_;
    voile::gpu::Buffer leaves_;
    voile::gpu::Buffer positions_;
    voile::gpu::Buffer boxes_;
};

// Boxes of all sizes, from points to one around everything; some overlap nothing.
std::vector<PaddedBox> random_queries(size_t count)
{
    std::mt19937 random(9);
    std::uniform_real_distribution<float> coordinate(-1.5f, 1.5f);
    std::uniform_real_distribution<float> exponent(-12, 1);
    std::vector<PaddedBox> queries{{glm::vec3(-10), 0, glm::vec3(10), 0}};
    while (queries.size() < count)
    {
        const glm::vec3 center(coordinate(random), coordinate(random), coordinate(random));
        const float size = std::exp2(exponent(random));
        queries.push_back({center - size, 0, center + size, 0});
    }
    return queries;
}

bool overlap(const PaddedBox& a, const PaddedBox& b)
{
    return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

bool same_bits(const std::vector<PaddedBox>& a, const std::vector<PaddedBox>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(PaddedBox)) == 0;
}

} // namespace

TEST_CASE("every triangle has exactly one slot of a padded BVH that is not a repeat")
{
    for (const uint32_t count : k_counts)
    {
        CAPTURE(count);
        const Soup soup = random_soup(count);
        const voile::PaddedTree tree = voile::build_padded_tree(soup.positions, soup.triangles);
        REQUIRE(tree.leaves.size() == size_t{1} << tree.levels);
        CHECK(tree.levels == voile::padded_levels(count));
        CHECK((count == 1 || tree.leaves.size() / 2 < count));
        std::vector<uint32_t> seen(count);
        for (uint32_t slot = 0; slot < tree.leaves.size(); ++slot)
        {
            const voile::shared::PaddedLeaf& leaf = tree.leaves[slot];
            const uint32_t triangle = leaf.triangle & VOILE_PADDED_TRIANGLE_MASK;
            const bool repeat = (leaf.triangle & VOILE_PADDED_REPEAT) != 0;
            REQUIRE(triangle < count);
            REQUIRE(leaf.corners == soup.triangles[triangle]);
            REQUIRE(repeat == (slot >= count));
            if (repeat)
                REQUIRE((leaf.triangle ^ tree.leaves[slot - tree.leaves.size() / 2].triangle) == VOILE_PADDED_REPEAT);
            else
                ++seen[triangle];
        }
        CHECK(seen == std::vector<uint32_t>(count, 1));
    }
}

TEST_CASE("identical triangles are split evenly, too")
{
    const std::vector<glm::vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<glm::uvec3> triangles(100, {0, 1, 2});
    const voile::PaddedTree tree = voile::build_padded_tree(positions, triangles);
    std::vector<uint32_t> found;
    for (uint32_t slot = 0; slot < 100; ++slot)
        found.push_back(tree.leaves.at(slot).triangle & VOILE_PADDED_TRIANGLE_MASK);
    std::sort(found.begin(), found.end());
    for (uint32_t t = 0; t < 100; ++t)
        CHECK(found[t] == t);
}

TEST_CASE_FIXTURE(RefitFixture, "a refit equals the recursive union of boxes to the bit")
{
    for (const uint32_t count : k_counts)
    {
        const Soup soup = random_soup(count);
        const voile::PaddedTree tree = voile::build_padded_tree(soup.positions, soup.triangles);
        const std::vector<glm::vec4> from = moved(soup.positions, 1); // not the vertices that the tree was built from
        for (const uint32_t end : {1u, 2u})                           // at rest, and moving
        {
            const std::vector<glm::vec4> to = moved(soup.positions, end);
            std::vector<PaddedBox> expected(tree.boxes());
            expect(tree, from.data(), to.data(), 0, 0, expected);
            for (const uint32_t group : {2u, 8u, 16u, 32u, 64u, 128u, 256u, 512u})
            {
                CAPTURE(count);
                CAPTURE(end);
                CAPTURE(group);
                upload(tree, from, to);
                CHECK(same_bits(refit(tree, group), expected));
            }
        }
    }
}

TEST_CASE_FIXTURE(RefitFixture,
                  "a refit follows changed vertices, and two refits of the same vertices are equal to the bit")
{
    const Soup soup = random_soup(1000);
    const voile::PaddedTree tree = voile::build_padded_tree(soup.positions, soup.triangles);
    std::vector<PaddedBox> before;
    for (uint32_t step = 0; step < 4; ++step)
    {
        const std::vector<glm::vec4> from = moved(soup.positions, step);
        const std::vector<glm::vec4> to = moved(soup.positions, step + 1);
        upload(tree, from, to);
        const std::vector<PaddedBox> boxes = refit(tree, 256);
        CHECK(same_bits(boxes, refit(tree, 256)));
        CHECK_FALSE(same_bits(boxes, before));
        std::vector<PaddedBox> expected(tree.boxes());
        expect(tree, from.data(), to.data(), 0, 0, expected);
        CHECK(same_bits(boxes, expected));
        before = boxes;
    }
}

TEST_CASE_FIXTURE(RefitFixture, "a traversal visits every triangle whose box overlaps the query exactly once")
{
    // Few triangles: a query that overlaps them all must end within 65,535 iterations, counted over all its loops. Then
    // llvmpipe ends a shader's loops.
    for (const uint32_t count : {1u, 2u, 3u, 5u, 7u, 8u, 33u, 1000u, 4097u})
    {
        CAPTURE(count);
        const Soup soup = random_soup(count);
        const voile::PaddedTree tree = voile::build_padded_tree(soup.positions, soup.triangles);
        upload(tree, moved(soup.positions, 1), moved(soup.positions, 2));
        const std::vector<PaddedBox> boxes = refit(tree, 256);
        const std::vector<PaddedBox> queries = random_queries(300);
        const auto answers = visit(queries, count);
        for (size_t i = 0; i < queries.size(); ++i)
        {
            std::vector<uint32_t> expected;
            for (uint32_t slot = 0; slot < count; ++slot)
                if (overlap(queries[i], boxes[tree.leaves.size() - 1 + slot]))
                    expected.push_back(k_first_leaf + slot);
            std::vector<uint32_t> found = answers[i];
            std::sort(found.begin(), found.end());
            CHECK(found == expected);
        }
    }
}
