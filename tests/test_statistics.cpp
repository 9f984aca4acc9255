// Statistics on the GPU against the same sums on the CPU, and what they must see: penetration and values that are not
// finite.
#include "cloth_harness.hpp"
#include "reference/cloth_reference.hpp"

#include <algorithm>
#include <cmath>

namespace
{

using tests::ClothHarness;

struct Expected
{
    double max_stretch = -1;
    double mean_stretch = 0;
    double kinetic_energy = 0;
};

Expected expected_statistics(const cloth::Grid& grid)
{
    const reference::Cloth reference(grid);
    Expected result;
    double springs = 0;
    for (const reference::Spring& spring : reference.springs)
    {
        // Structural and shear springs join neighbours: no farther than a diagonal.
        const double diagonal = std::hypot(0.05, 0.06);
        if (spring.rest_length > 1.01 * diagonal)
            continue;
        const double stretch =
            glm::distance(reference.state.x[spring.a], reference.state.x[spring.b]) / spring.rest_length - 1;
        result.max_stretch = std::max(result.max_stretch, stretch);
        result.mean_stretch += stretch;
        ++springs;
    }
    result.mean_stretch /= springs;
    for (const glm::dvec3& v : reference.state.v)
        result.kinetic_energy += 0.5 * static_cast<double>(tests::raw(grid).vertex_mass) * glm::dot(v, v);
    return result;
}

} // namespace

TEST_CASE("stretch and energy equal those of the CPU at awkward sizes")
{
    struct Size
    {
        uint32_t columns;
        uint32_t rows;
    };
    for (const Size& size : {Size{2, 2}, Size{9, 7}, Size{8, 8}, Size{13, 5}, Size{617, 2}, Size{128, 128}})
    {
        CAPTURE(size.columns);
        CAPTURE(size.rows);
        const cloth::Grid grid = tests::stretched_sheet(size.columns, size.rows);
        const Expected expected = expected_statistics(grid);
        ClothHarness harness;
        (void)engine::take(harness.solver.add_cloth(grid));
        harness.upload();
        const cloth::Statistics found = harness.statistics();
        // A stretch is a difference of coordinates of up to `extent` over a rest length of 5 cm, in float.
        const double extent = 3 + 0.06 * std::max(size.columns, size.rows);
        const double bound = 4 * std::exp2(-24) * extent / 0.05;
        CHECK(std::abs(static_cast<double>(found.max_stretch) - expected.max_stretch) < bound);
        CHECK(std::abs(static_cast<double>(found.mean_stretch) - expected.mean_stretch) < bound);
        // Sums of equal terms in a tree and over at most 128 chunks: some 150 additions.
        CHECK(std::abs(static_cast<double>(found.kinetic_energy) / expected.kinetic_energy - 1) < 150 * std::exp2(-24));
        CHECK(found.nan_vertices == 0);
        CHECK(found.penetrating_vertices == 0);
    }
}

TEST_CASE("vertices under a surface are counted, and the deepest is measured")
{
    ClothHarness harness;
    cloth::Grid grid = tests::stretched_sheet(40, 30);
    grid.transform = glm::mat4(1.f); // flat at y = 0
    const cloth::SphereCollider ball{.center = {0.1f, 0.05f, 0}, .radius = 0.3f};
    const cloth::ClothId id = engine::take(harness.solver.add_cloth(grid));
    (void)engine::take(harness.solver.add_collider(ball));
    harness.upload();
    uint32_t inside = 0;
    double deepest = 0;
    for (const glm::vec4& p : harness.positions(id))
    {
        const double depth = 0.3 - glm::distance(glm::dvec3(p), glm::dvec3(ball.center));
        inside += depth > 0;
        deepest = std::max(deepest, depth);
    }
    REQUIRE(inside > 10);
    const cloth::Statistics found = harness.statistics();
    CHECK(found.penetrating_vertices == inside);
    CHECK(static_cast<double>(found.deepest_penetration) == doctest::Approx(deepest).epsilon(1e-5));
}

TEST_CASE("values that are not finite are counted, and do not spoil the other sums")
{
    ClothHarness harness;
    const cloth::ClothId broken = engine::take(harness.solver.add_cloth(tests::stretched_sheet(20, 10)));
    cloth::Grid calm = tests::stretched_sheet(9, 7);
    calm.material = cloth::Material{};
    (void)engine::take(harness.solver.add_cloth(calm));
    harness.upload();
    const cloth::VertexStreams streams = harness.solver.vertices(broken);
    harness.run(
        [&](VkCommandBuffer cmd)
        {
            constexpr uint32_t k_not_a_number = 0xffffffff;
            const auto bytes = streams.vertices * sizeof(glm::vec4);
            harness.solver.context().fn.vkCmdFillBuffer(cmd, streams.positions, streams.offset, bytes, k_not_a_number);
        });
    harness.step({.duration = 0.01f, .substeps = 1, .gravity = {0, 0, 0}});
    const uint32_t not_finite = 20 * 10;
    const cloth::Statistics found = harness.statistics();
    CHECK(found.nan_vertices == not_finite);
    CHECK(static_cast<double>(found.kinetic_energy) ==
          doctest::Approx(63 * 0.5 * 0.01 * glm::dot(calm.velocity, calm.velocity)));
}
