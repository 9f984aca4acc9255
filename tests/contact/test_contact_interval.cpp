// Short substeps of Verlet share contact passes (Tuning::contact_interval). Cloth must fold, slide and rest as with
// contact in every substep.
#include "support/close_to.hpp"
#include "support/cloth_harness.hpp"

#include "voile/engine/assets/mesh.hpp"
#include "voile/fabrics.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace
{

constexpr uint32_t k_frames = 30;
constexpr uint32_t k_hanging_frames = 150; // less says nothing about friction

// What the cloth falls on.
struct Stage
{
    std::string name;
    std::optional<voile::BoxCollider> box;
    std::optional<voile::SphereCollider> ball;
};

struct Outcome
{
    float most_stretch = 0;   // in any frame
    float kinetic_energy = 0; // J, at the end
    double height = 0;        // m, mean at the end
};

voile::SolverOptions with_interval(float contact_interval)
{
    voile::SolverOptions options;
    options.tuning.contact_interval = contact_interval;
    return options;
}

// Of 12 cm, just above what it falls on.
voile::GridCloth sheet(const voile::Fabric& fabric, float x = 0.01f, float angle = 0.4f)
{
    voile::GridCloth grid;
    grid.integrator = voile::Integrator::verlet;
    grid.columns = grid.rows = 16;
    grid.width = grid.depth = 0.12f;
    grid.material = fabric;
    grid.transform = glm::rotate(glm::translate(glm::mat4(1), {x, 0.085f, 0.01f}), angle, glm::vec3(0, 1, 0));
    return grid;
}

glm::dvec3 mean_of(const std::vector<glm::vec4>& positions)
{
    glm::dvec3 sum(0);
    for (const glm::vec4& x : positions)
        sum += glm::dvec3(x);
    return sum / static_cast<double>(positions.size());
}

// The mean position of leather two thirds of which lie on a box, at the end.
glm::dvec3 hang_over_edge(float contact_interval)
{
    tests::ClothHarness harness(with_interval(contact_interval));
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(sheet(voile::leather(), 0.006f, 0.25f)));
    (void)voile::engine::take(
        harness.solver.add_collider(voile::BoxCollider{.min = {-0.2f, 0, -0.2f}, .max = {0.028f, 0.08f, 0.2f}}));
    harness.upload();
    REQUIRE(harness.solver.stable_substeps(1.f / 60) > 140); // so that two share a pass, or four would
    harness.step({}, k_hanging_frames);
    return mean_of(harness.positions(id));
}

// A grid of triangles at random heights, whose edges and corners protrude everywhere.
voile::engine::Mesh rough_ground()
{
    constexpr uint32_t k_side = 24;
    constexpr float k_spacing = 8e-3f; // m
    std::mt19937 random(7);
    voile::engine::Mesh mesh;
    for (uint32_t row = 0; row <= k_side; ++row)
        for (uint32_t column = 0; column <= k_side; ++column)
            mesh.positions.push_back({k_spacing * (static_cast<float>(column) - 0.5f * k_side),
                                      0.08f - 1e-5f * static_cast<float>(random() % 600),
                                      k_spacing * (static_cast<float>(row) - 0.5f * k_side)});
    for (uint32_t row = 0; row < k_side; ++row)
        for (uint32_t column = 0; column < k_side; ++column)
        {
            const uint32_t corner = row * (k_side + 1) + column;
            mesh.triangles.push_back({corner, corner + k_side + 1, corner + 1});
            mesh.triangles.push_back({corner + 1, corner + k_side + 1, corner + k_side + 2});
        }
    return mesh;
}

// On rough ground. All vertices traverse the features, those of several workgroups next to each other.
std::vector<glm::vec4> lie_on_rough_ground()
{
    voile::SolverOptions options;
    options.tuning.feature_items = 0;
    tests::ClothHarness harness(options);
    voile::GridCloth cloth = sheet(voile::cotton());
    cloth.columns = cloth.rows = 40;
    cloth.width = cloth.depth = 0.3f;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(cloth));
    const voile::engine::Mesh mesh = rough_ground();
    (void)voile::engine::take(
        harness.solver.add_collider(voile::MeshCollider{.positions = mesh.positions, .triangles = mesh.triangles}));
    harness.upload();
    REQUIRE(harness.solver.stable_substeps(1.f / 60) > 140);
    harness.step({}, 2);
    REQUIRE(harness.statistics().contacts > 50);
    return harness.positions(id);
}

Outcome drop(const Stage& stage, const voile::Fabric& fabric, float contact_interval)
{
    tests::ClothHarness harness(with_interval(contact_interval));
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(sheet(fabric)));
    if (stage.box)
        (void)voile::engine::take(harness.solver.add_collider(*stage.box));
    if (stage.ball)
        (void)voile::engine::take(harness.solver.add_collider(*stage.ball));
    (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{}));
    harness.upload();
    REQUIRE(harness.solver.stable_substeps(1.f / 60) > 200); // so that two share a pass
    Outcome result;
    for (uint32_t frame = 0; frame < k_frames; ++frame)
    {
        harness.step({});
        const voile::Statistics now = harness.statistics();
        result.most_stretch = std::max(result.most_stretch, now.max_stretch);
        result.kinetic_energy = now.kinetic_energy;
        CHECK(now.penetrating_vertices == 0);
    }
    result.height = mean_of(harness.positions(id)).y;
    return result;
}

} // namespace

TEST_CASE("substeps that share contact passes fold and rest as with contact in each")
{
    const Stage stages[] = {
        {"ball", std::nullopt, voile::SphereCollider{.center = {0, 0.04f, 0}, .radius = 0.04f}},
        {"box", voile::BoxCollider{.min = {-0.03f, 0, -0.03f}, .max = {0.03f, 0.08f, 0.03f}}, std::nullopt}};
    for (const Stage& stage : stages)
    {
        CAPTURE(stage.name);
        const Outcome each = drop(stage, voile::cotton(), 0);
        const Outcome shared = drop(stage, voile::cotton(), voile::Tuning{}.contact_interval);
        MESSAGE("stretch ", each.most_stretch, " ", shared.most_stretch, ", kinetic energy ", each.kinetic_energy, " ",
                shared.kinetic_energy, " J, height ", each.height, " ", shared.height, " m");
        CHECK(shared.most_stretch < 1.015f * each.most_stretch);                    // measured: 1.003
        CHECK(shared.kinetic_energy == tests::close_to(each.kinetic_energy, 0.15)); // measured: 3.5 %
        CHECK(std::abs(shared.height - each.height) < 2.5e-4);                      // measured: 5.3e-5
    }
}

// Features push pieces of cloth, which have no plane. If cloth creeps, it slides off in the end.
TEST_CASE("cloth hangs over an edge for seconds as with contact in each substep")
{
    const double moved = glm::distance(hang_over_edge(voile::Tuning{}.contact_interval), hang_over_edge(0));
    CAPTURE(moved);
    CHECK(moved < 1e-3); // m, measured: 5.2e-4; 0.09 with four substeps per pass
}

// Vertices that traverse read their neighbors, which other workgroups write.
TEST_CASE("contact with traversed features depends on no order of threads")
{
    CHECK(lie_on_rough_ground() == lie_on_rough_ground());
}
