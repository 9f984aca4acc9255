// Meshes, and grids with pins anywhere, that take fewer substeps than they need: they keep their size, come to rest,
// and gain no energy.
#include "support/cloth_harness.hpp"
#include "support/cloth_meshes.hpp"
#include "support/collider_scenes.hpp"

#include "voile/fabrics.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>

namespace
{

using tests::ClothHarness;
using tests::ClothMesh;
using voile::engine::take;

// 1 m, in rows.
ClothMesh sheet(uint32_t side)
{
    return tests::sheet(side, side, 1 / static_cast<float>(side - 1));
}

// Irregular triangles, and vertices in no order.
ClothMesh shuffled(uint32_t side)
{
    ClothMesh mesh = sheet(side);
    std::mt19937 random(11);
    std::uniform_real_distribution<float> offset(-0.2f / static_cast<float>(side), 0.2f / static_cast<float>(side));
    for (glm::vec3& p : mesh.positions)
        p += glm::vec3(offset(random), 0, offset(random));
    std::vector<uint32_t> order(mesh.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), random);
    ClothMesh result = mesh;
    for (size_t i = 0; i < order.size(); ++i)
        result.positions[order[i]] = mesh.positions[i];
    for (glm::uvec3& t : result.triangles)
        t = {order[t.x], order[t.y], order[t.z]};
    return result;
}

uint32_t nearest(const ClothMesh& mesh, const glm::vec3& at)
{
    const auto found =
        std::ranges::min_element(mesh.positions, {}, [&](const glm::vec3& p) { return glm::distance(p, at); });
    return static_cast<uint32_t>(found - mesh.positions.begin());
}

voile::MeshCloth cloth_of(const ClothMesh& mesh, std::vector<uint32_t> pins)
{
    voile::MeshCloth cloth = mesh.cloth();
    cloth.material = voile::cotton();
    cloth.integrator = voile::Integrator::verlet;
    cloth.pins = std::move(pins);
    return cloth;
}

// |F d| - 1 along the axes x and z of a flat mesh, in each triangle: below it are 99 %.
double stretch_99(const ClothMesh& mesh, const std::vector<glm::vec4>& x)
{
    std::vector<double> stretches;
    for (const glm::uvec3& t : mesh.triangles)
    {
        const glm::dvec3 b(mesh.positions[t.y] - mesh.positions[t.x]);
        const glm::dvec3 c(mesh.positions[t.z] - mesh.positions[t.x]);
        const double area = b.x * c.z - b.z * c.x;
        const glm::dvec3 to_b = glm::dvec3(x[t.y]) - glm::dvec3(x[t.x]);
        const glm::dvec3 to_c = glm::dvec3(x[t.z]) - glm::dvec3(x[t.x]);
        stretches.push_back(glm::length((to_b * c.z - to_c * b.z) / area) - 1);
        stretches.push_back(glm::length((to_c * b.x - to_b * c.x) / area) - 1);
    }
    const auto at = stretches.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(stretches.size()));
    std::nth_element(stretches.begin(), at, stretches.end());
    return *at;
}

// The largest over a second. `distance`: m, within which each of `held` is kept; none: they are pinned.
double worst_stretch(const ClothMesh& mesh, const std::vector<uint32_t>& held, const voile::Step& step,
                     std::optional<float> distance = {})
{
    ClothHarness harness;
    const voile::ClothId id = take(harness.solver.add_cloth(cloth_of(mesh, distance ? std::vector<uint32_t>() : held)));
    if (distance)
    {
        const voile::AnchorId anchor = take(harness.solver.add_anchor(glm::mat4(1)));
        std::vector<voile::Attachment> attachments;
        for (const uint32_t vertex : held)
            attachments.push_back(voile::max_distance(vertex, *distance).to(anchor));
        take(harness.solver.set_attachments(id, attachments));
    }
    harness.upload();
    CHECK(harness.solver.stability(id, step).stiffness_scale < 0.1f);
    double worst = 0;
    for (int frame = 0; frame < 60; ++frame)
    {
        harness.step(step);
        worst = std::max(worst, stretch_99(mesh, harness.positions(id)));
    }
    return worst;
}

double rms_speed(const std::vector<glm::vec4>& velocities)
{
    double sum = 0;
    for (const glm::vec4& v : velocities)
        sum += glm::dot(glm::dvec3(v), glm::dvec3(v));
    return std::sqrt(sum / static_cast<double>(velocities.size()));
}

std::vector<uint32_t> first_row(uint32_t side)
{
    std::vector<uint32_t> pins(side);
    std::iota(pins.begin(), pins.end(), 0u);
    return pins;
}

} // namespace

// Measured 0.061 and 0.060 in rows, 0.118 and 0.104 shuffled; without the limit 0.3 and more.
TEST_CASE("meshes of 40 x 40 in 16 substeps keep their size as they hang from two vertices, whatever their order")
{
    const ClothMesh rows = sheet(40);
    const double inside =
        worst_stretch(rows, {nearest(rows, {0.2f, 0, 0.15f}), nearest(rows, {0.7f, 0, 0.3f})}, {.max_substeps = 16});
    CHECK(inside < 0.12); // measured: 0.065
    const ClothMesh mesh = shuffled(40);
    const std::vector<uint32_t> corners{nearest(mesh, {0, 0, 0}), nearest(mesh, {1, 0, 0})};
    CHECK(worst_stretch(mesh, corners, {.max_substeps = 16}) < 0.16); // measured: 0.134
    CHECK(worst_stretch(mesh, corners, {.max_substeps = 16, .softened_strain_limit = 0}) > 0.2);
}

// The limit may not move what they hold. Measured: pinned 0.083, with a distance of 1 cm 0.085.
TEST_CASE("a mesh on a budget keeps its size where max-distance constraints hold it instead of pins")
{
    const ClothMesh mesh = shuffled(18);
    const std::vector<uint32_t> corners{nearest(mesh, {0, 0, 0}), nearest(mesh, {1, 0, 0})};
    const voile::Step step{.max_substeps = 8};
    CHECK(worst_stretch(mesh, corners, step, 0.01f) < 1.08 * worst_stretch(mesh, corners, step));
}

// Measured 0.068 and 0.091; with the lines of the grid as levels 0.165, 0.275.
TEST_CASE("a grid of 64 x 64 in 16 substeps keeps its size, whichever vertices are pinned")
{
    constexpr uint32_t k_side = 64;
    for (const std::vector<uint32_t>& pins :
         {std::vector<uint32_t>{5, k_side - 12}, {21 * k_side + 22, 21 * k_side + 44}})
    {
        voile::GridCloth grid;
        grid.columns = grid.rows = k_side;
        grid.material = voile::cotton();
        grid.integrator = voile::Integrator::verlet;
        grid.pins = pins;
        ClothHarness harness;
        const voile::ClothId id = take(harness.solver.add_cloth(grid));
        harness.upload();
        double worst = 0;
        for (int frame = 0; frame < 45; ++frame)
        {
            harness.step({.max_substeps = 16});
            worst = std::max(worst, stretch_99(sheet(k_side), harness.positions(id)));
        }
        MESSAGE("stretch " << worst);
        CHECK(worst < 0.13);
    }
}

// Measured 0.059; in equal frames 0.037. Without the limit 0.15 to 0.49, for ever.
TEST_CASE("a mesh on a budget does not shake in frames of different length")
{
    ClothHarness harness;
    const ClothMesh mesh = sheet(20);
    const voile::ClothId id = take(harness.solver.add_cloth(cloth_of(mesh, first_row(20))));
    harness.upload();
    double most = 0;
    for (int frame = 0; frame < 240; ++frame)
    {
        harness.step({.duration = frame % 2 == 0 ? 1.f / 30 : 1.f / 144, .max_substeps = 16});
        if (frame >= 200)
            most = std::max(most, rms_speed(harness.velocities(id)));
    }
    CAPTURE(most);
    CHECK(most < 0.1);
}

// Measured: its hem ends 0.06 m lower. Without the limit 2.7 m.
TEST_CASE("a mesh on a budget keeps its size in a frame of half a second")
{
    ClothHarness harness;
    const ClothMesh mesh = sheet(20);
    const voile::ClothId id = take(harness.solver.add_cloth(cloth_of(mesh, first_row(20))));
    harness.upload();
    const auto lowest = [&]
    {
        float low = 0;
        for (const glm::vec4& p : harness.positions(id))
            low = std::min(low, p.y);
        return low;
    };
    harness.step({.max_substeps = 16}, 180);
    const float before = lowest();
    float low = 0;
    harness.step({.duration = 0.5f, .max_substeps = 16});
    for (int frame = 0; frame < 60; ++frame)
    {
        low = std::min(low, lowest());
        harness.step({.max_substeps = 16});
    }
    CHECK(low > before - 0.2f);
}

// The reserve of energy of the strain limit was that of before.
TEST_CASE("a mesh on a budget moves after a reset as it did at first, to the bit")
{
    ClothHarness harness;
    const ClothMesh mesh = shuffled(13);
    voile::MeshCloth cloth = cloth_of(mesh, {nearest(mesh, {0, 0, 0}), nearest(mesh, {1, 0, 0})});
    cloth.transform = glm::rotate(glm::mat4(1), 1.67f, glm::vec3(1, 0, 0)); // it hangs almost
    const voile::ClothId id = take(harness.solver.add_cloth(cloth));
    harness.upload();
    std::vector<glm::vec4> ends[2];
    for (std::vector<glm::vec4>& end : ends)
    {
        harness.step({.max_substeps = 16}, 40);
        end = harness.positions(id);
        take(harness.solver.reset(id));
    }
    CHECK(tests::same_bits(ends[0], ends[1]));
}

TEST_CASE("a softened mesh that nothing holds keeps its momentum and gains no energy")
{
    for (const bool in_rows : {true, false})
        for (const auto integrator : {voile::Integrator::verlet, voile::Integrator::rk4})
        {
            CAPTURE(in_rows);
            CAPTURE(int(integrator));
            ClothMesh mesh = in_rows ? sheet(24) : shuffled(24);
            voile::MeshCloth cloth = cloth_of(mesh, {});
            voile::Fabric fabric = voile::cotton();
            fabric.air_drag_normal = fabric.air_drag_tangential = 0;
            cloth.material = fabric;
            cloth.integrator = integrator;
            ClothHarness harness;
            const voile::ClothId id = take(harness.solver.add_cloth(cloth));
            harness.upload();
            // Its parts fly apart: 1.5 m/s at the borders.
            std::vector<glm::vec4> v = harness.velocities(id);
            const std::vector<glm::vec4> x = harness.positions(id);
            glm::dvec3 momentum(0);
            double energy = 0;
            double mass = 0;
            for (size_t i = 0; i < v.size(); ++i)
            {
                const glm::vec3 apart = 3.f * (glm::vec3(x[i]) - glm::vec3(0.5f, 0, 0.5f));
                v[i] = glm::vec4(apart, v[i].w);
                const double m = 1 / static_cast<double>(x[i].w);
                momentum += m * glm::dvec3(v[i]);
                energy += 0.5 * m * glm::dot(glm::dvec3(v[i]), glm::dvec3(v[i]));
                mass += m;
            }
            harness.set_velocities(id, v);
            for (int frame = 0; frame < 30; ++frame)
            {
                harness.step({.max_substeps = 16, .gravity = glm::vec3(0)});
                glm::dvec3 now(0);
                double kinetic = 0;
                const std::vector<glm::vec4> w = harness.velocities(id);
                for (size_t i = 0; i < w.size(); ++i)
                {
                    const double m = 1 / static_cast<double>(x[i].w);
                    now += m * glm::dvec3(w[i]);
                    kinetic += 0.5 * m * glm::dot(glm::dvec3(w[i]), glm::dvec3(w[i]));
                }
                CHECK(glm::length(now - momentum) < 1e-5 * mass); // m/s
                CHECK(kinetic < 1.001 * energy);
            }
        }
}

// Cloth lies on a sphere by shearing. Measured 0.006 m/s; it ends within 1.1 mm of the middle.
TEST_CASE("softened meshes come to rest on a sphere that is smaller than they are")
{
    const ClothMesh mesh = shuffled(25);
    voile::MeshCloth cloth = cloth_of(mesh, {});
    cloth.transform = tests::moved({-0.5f, 0.62f, -0.5f});
    ClothHarness harness;
    const voile::ClothId id = take(harness.solver.add_cloth(cloth));
    (void)take(harness.solver.add_collider(voile::SphereCollider{.center = {0, 0.3f, 0}, .radius = 0.3f}));
    harness.upload();
    harness.step({.max_substeps = 16}, 280);
    glm::dvec3 center(0);
    const std::vector<glm::vec4> x = harness.positions(id);
    for (const glm::vec4& p : x)
        center += glm::dvec3(p) / static_cast<double>(x.size());
    const double rms = rms_speed(harness.velocities(id));
    MESSAGE("rms speed " << rms << ", center " << glm::length(glm::dvec2(center.x, center.z)));
    CHECK(rms < 0.01);
    CHECK(glm::length(glm::dvec2(center.x, center.z)) < 0.004);
}
