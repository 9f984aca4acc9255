// Statistics on the GPU against the same sums on the CPU, and their counts of penetration and of values that are not
// finite.
#include "reference/cloth_reference.hpp"
#include "support/close_to.hpp"
#include "support/cloth_harness.hpp"

#include "voile/engine/assets/shapes.hpp"
#include "voile/mesh_checks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

namespace
{

using tests::ClothHarness;

struct Expected
{
    double max_stretch = -1;
    double mean_stretch = 0;
    double kinetic_energy = 0;
};

Expected expected_statistics(const voile::GridCloth& grid)
{
    const reference::Cloth reference(grid);
    Expected result;
    double springs = 0;
    for (const reference::Spring& spring : reference.springs)
    {
        // Structural and shear springs join neighbors, at most a diagonal apart.
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

// The sum of the solid angles of the triangles, seen from a point (Van Oosterom and Strackee 1983), over 4 pi.
double winding_number(const voile::engine::Mesh& mesh, const glm::dvec3& point)
{
    double angles = 0;
    for (const glm::uvec3& t : mesh.triangles)
    {
        const glm::dvec3 a = glm::dvec3(mesh.positions[t.x]) - point;
        const glm::dvec3 b = glm::dvec3(mesh.positions[t.y]) - point;
        const glm::dvec3 c = glm::dvec3(mesh.positions[t.z]) - point;
        const double la = glm::length(a);
        const double lb = glm::length(b);
        const double lc = glm::length(c);
        angles += 2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                 la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return angles / (4 * std::numbers::pi);
}

} // namespace

TEST_CASE("stretch and energy equal the CPU's at awkward sizes")
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
        const voile::GridCloth grid = tests::stretched_sheet(size.columns, size.rows);
        const Expected expected = expected_statistics(grid);
        ClothHarness harness;
        (void)voile::engine::take(harness.solver.add_cloth(grid));
        harness.upload();
        const voile::Statistics found = harness.statistics();
        // A stretch is a difference of float coordinates of up to `extent` over a rest length of 5 cm.
        const double extent = 3 + 0.06 * std::max(size.columns, size.rows);
        const double bound = 4 * std::exp2(-24) * extent / 0.05;
        CHECK(std::abs(static_cast<double>(found.max_stretch) - expected.max_stretch) < bound);
        CHECK(std::abs(static_cast<double>(found.mean_stretch) - expected.mean_stretch) < bound);
        // Sums of equal terms in a tree and over at most 128 patches: some 150 additions.
        CHECK(std::abs(static_cast<double>(found.kinetic_energy) / expected.kinetic_energy - 1) < 150 * std::exp2(-24));
        CHECK(found.nan_vertices == 0);
        CHECK(found.penetrating_vertices == 0);
    }
}

TEST_CASE("vertices under a surface are counted, and the deepest is measured")
{
    ClothHarness harness;
    voile::GridCloth grid = tests::stretched_sheet(40, 30);
    grid.transform = glm::mat4(1.f); // flat at y = 0
    const voile::SphereCollider ball{.center = {0.1f, 0.05f, 0}, .radius = 0.3f};
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    (void)voile::engine::take(harness.solver.add_collider(ball));
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
    const voile::Statistics found = harness.statistics();
    CHECK(found.penetrating_vertices == inside);
    CHECK(static_cast<double>(found.deepest_penetration) == tests::close_to(deepest, 5e-7));
}

TEST_CASE("a vertex is inside a mesh if the mesh winds around it, at any depth")
{
    // A ball with its top pushed down through its bottom: the part below is inside-out and solid nowhere.
    voile::engine::Mesh folded = voile::engine::make_sphere({0, 0, 0}, 0.4f, 16);
    for (glm::vec3& p : folded.positions)
        p.y -= p.y > 0.2f ? 5 * (p.y - 0.2f) : 0;
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0, 0}, 0.4f, 16);
    voile::engine::Mesh parts = ball;
    for (const glm::uvec3& t : voile::engine::make_sphere({0.3f, 0, 0}, 0.3f, 12).triangles)
        parts.triangles.push_back(t + static_cast<uint32_t>(ball.positions.size()));
    for (const glm::vec3& p : voile::engine::make_sphere({0.3f, 0, 0}, 0.3f, 12).positions)
        parts.positions.push_back(p);
    voile::engine::Mesh bowl = ball;
    std::erase_if(bowl.triangles, [&](const glm::uvec3& t) { return ball.positions[t.x].y > 0.1f; });
    voile::engine::Mesh turned_bowl = bowl;
    for (glm::uvec3& t : turned_bowl.triangles)
        std::swap(t.y, t.z);
    struct Case
    {
        std::string name;
        voile::engine::Mesh mesh;
        voile::Sidedness sides;
        bool deforms;
        bool has_inside;
    };
    const Case cases[] = {
        {"ball", ball, voile::Sidedness::automatic, false, true},
        {"ball that may deform", ball, voile::Sidedness::automatic, true, true},
        {"ball with two sides", ball, voile::Sidedness::two_sided, false, false},
        {"ball folded through itself", folded, voile::Sidedness::automatic, false, true},
        {"two parts in each other", parts, voile::Sidedness::automatic, false, true},
        {"bowl", bowl, voile::Sidedness::automatic, false, false},
        {"bowl that may deform", bowl, voile::Sidedness::one_sided, true, true},
        {"bowl with one side", bowl, voile::Sidedness::one_sided, false, true},
        {"bowl turned, with one side", turned_bowl, voile::Sidedness::one_sided, false, true},
        {"bowl with two sides", bowl, voile::Sidedness::two_sided, false, false},
    };
    std::mt19937 random(9);
    std::uniform_real_distribution<float> within(-0.7f, 0.7f);
    // All in one solver, each with a cloth on its own layer. Another solver's kernels would take longer to make than
    // the rest of the test.
    ClothHarness harness;
    std::vector<voile::ClothId> sheets;
    uint32_t layer = 1;
    for (const Case& c : cases)
    {
        (void)voile::engine::take(harness.solver.add_collider(voile::MeshCollider{.positions = c.mesh.positions,
                                                                                  .triangles = c.mesh.triangles,
                                                                                  .sidedness = c.sides,
                                                                                  .deforms = c.deforms,
                                                                                  .layers = layer}));
        voile::GridCloth grid = tests::stretched_sheet(20, 20);
        grid.layers = layer;
        sheets.push_back(voile::engine::take(harness.solver.add_cloth(grid)));
        layer <<= 1;
    }
    harness.upload();
    harness.step({.duration = 1e-6f, .substeps = 1}); // refits the deforming mesh
    const std::vector<glm::vec4> away(400, glm::vec4(5, 0, 0, 1));
    for (const voile::ClothId sheet : sheets)
        harness.set_positions(sheet, away);
    for (size_t i = 0; i < std::size(cases); ++i)
    {
        const Case& c = cases[i];
        CAPTURE(c.name);
        const auto exact = voile::engine::take(
            voile::MeshDistance::create({.positions = c.mesh.positions, .triangles = c.mesh.triangles}));
        std::vector<glm::vec4> points = away;
        uint32_t inside = 0;
        double deepest = 0;
        for (glm::vec4& p : points)
        {
            double distance = 0;
            do
            {
                p = {within(random), within(random), within(random), p.w};
                distance = std::abs(exact.nearest(glm::dvec3(p)).signed_distance);
            } while (distance < 1e-5);
            const double winding = winding_number(c.mesh, glm::dvec3(p));
            CHECK(std::abs(exact.winding_number(glm::dvec3(p)) - winding) < 1e-7); // 2e-8: its corners are floats
            if (!c.has_inside || winding < 0.5)
                continue;
            ++inside;
            deepest = std::max(deepest, distance);
        }
        harness.set_positions(sheets[i], points);
        const voile::Statistics found = harness.statistics();
        CHECK(found.penetrating_vertices == inside);
        CHECK(std::abs(static_cast<double>(found.deepest_penetration) - deepest) <= 5e-7 * deepest); // 0 if it is 0
        CHECK((inside > 5) == (c.has_inside && c.name != "bowl turned, with one side"));
        harness.set_positions(sheets[i], away);
    }
}

TEST_CASE("values that are not finite are counted and do not spoil the other sums")
{
    ClothHarness harness;
    const voile::ClothId broken = voile::engine::take(harness.solver.add_cloth(tests::stretched_sheet(20, 10)));
    voile::GridCloth calm = tests::stretched_sheet(9, 7);
    calm.material = voile::Material{};
    (void)voile::engine::take(harness.solver.add_cloth(calm));
    harness.upload();
    const voile::VertexStreams streams = harness.solver.vertices(broken);
    harness.run(
        [&](VkCommandBuffer cmd)
        {
            constexpr uint32_t k_not_a_number = 0xffffffff;
            const auto bytes = streams.vertices * sizeof(glm::vec4);
            harness.solver.context().fn.vkCmdFillBuffer(cmd, streams.positions, streams.offset, bytes, k_not_a_number);
        });
    harness.step({.duration = 0.01f, .substeps = 1, .gravity = {0, 0, 0}});
    harness.expected_nan_vertices = 20 * 10;
    const voile::Statistics found = harness.statistics();
    CHECK(found.nan_vertices == 20 * 10);
    CHECK(static_cast<double>(found.kinetic_energy) ==
          tests::close_to(63 * 0.5 * 0.01 * glm::dot(calm.velocity, calm.velocity), 2e-7));
}

TEST_CASE("a test that reads a vertex that is not finite fails" * doctest::should_fail())
{
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(voile::GridCloth{.columns = 4, .rows = 4}));
    harness.upload();
    auto positions = harness.positions(id);
    positions[7].y = NAN;
    harness.set_positions(id, positions);
    (void)harness.positions(id);
}
