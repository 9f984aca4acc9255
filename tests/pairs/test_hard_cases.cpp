// Cloth that collides with itself and starts without intersections stays without them.
#include "support/cloth_meshes.hpp"
#include "support/pair_harness.hpp"

#include <doctest/doctest.h>

namespace
{

using tests::at;
using tests::PairHarness;
using tests::turned;
using voile::engine::take;

constexpr float k_spacing = 0.02f; // m

voile::GridCloth square(uint32_t side)
{
    return tests::pair_sheet(side, side, k_spacing);
}

} // namespace

TEST_CASE("a sheet that is dropped on its edge crumples without intersections")
{
    for (const voile::Integrator integrator : {voile::Integrator::verlet, voile::Integrator::rk4})
        for (const float far : {0.f, 100.f})
        {
            PairHarness harness;
            (void)take(harness.solver.add_collider(voile::PlaneCollider{}));
            voile::GridCloth sheet = square(12);
            sheet.transform = at({far, 0.13f, far}) * turned(1.5f, {1, 0, 0});
            sheet.integrator = integrator;
            harness.add(sheet);
            harness.upload();
            CAPTURE(far);
            CHECK(harness.first_intersection({.duration = 1.f / 60}, 20) == -1);
            CHECK(harness.statistics().forced_pairs == 0);
        }
}

TEST_CASE("a mesh of silk crumples without intersections")
{
    tests::ClothMesh mesh = tests::jittered_sheet(10, 10);
    for (glm::vec3& p : mesh.positions)
        p *= 0.5f;
    PairHarness harness;
    (void)take(harness.solver.add_collider(voile::PlaneCollider{}));
    voile::MeshCloth cloth = mesh.cloth();
    cloth.material = voile::silk();
    cloth.integrator = voile::Integrator::verlet;
    cloth.self_collision = true;
    cloth.transform = at({0, 0.24f, 0}) * turned(1.45f, {1, 0, 0});
    harness.add(cloth);
    harness.upload();
    CHECK(harness.first_intersection({.duration = 1.f / 60}, 25) == -1);
}

TEST_CASE("a ribbon falls into a heap without intersections")
{
    PairHarness harness;
    (void)take(harness.solver.add_collider(voile::PlaneCollider{}));
    voile::GridCloth ribbon = tests::pair_sheet(4, 30, k_spacing);
    ribbon.transform = at({0, 0.31f, 0}) * turned(1.5f, {1, 0, 0});
    harness.add(ribbon);
    harness.upload();
    CHECK(harness.first_intersection({.duration = 1.f / 60}, 30) == -1);
}

TEST_CASE("five sheets on a sphere keep their order")
{
    PairHarness harness;
    (void)take(harness.solver.add_collider(voile::SphereCollider{.radius = 0.08f}));
    for (int i = 0; i < 5; ++i)
    {
        voile::GridCloth sheet = square(9);
        sheet.transform =
            at({0, 0.088f + 0.006f * static_cast<float>(i), 0}) * turned(0.3f * static_cast<float>(i), {0, 1, 0});
        harness.add(sheet);
    }
    harness.upload();
    CHECK(harness.first_intersection({.duration = 1.f / 60}, 14) == -1);
    for (size_t i = 0; i + 1 < harness.cloths.size(); ++i)
        CHECK(harness.positions(harness.cloths[i])[40].y < harness.positions(harness.cloths[i + 1])[40].y);
}

TEST_CASE("a strain limit and tethers lead to no intersections")
{
    PairHarness harness;
    (void)take(harness.solver.add_collider(voile::SphereCollider{.center = {0.03f, -0.08f, 0.05f}, .radius = 0.05f}));
    voile::GridCloth sheet = square(12);
    std::get<voile::Fabric>(sheet.material).strain_limit = 0.01f;
    sheet.pins = {0, 11};
    harness.add(sheet);
    harness.upload();
    take(harness.solver.set_tethers(harness.cloths[0], voile::Tethers{0.02f}));
    CHECK(harness.first_intersection({.duration = 1.f / 60}, 30) == -1);
}

TEST_CASE("a flag in a storm does not intersect itself")
{
    PairHarness harness;
    voile::GridCloth flag = tests::pair_sheet(14, 8, k_spacing);
    flag.transform = turned(1.57f, {1, 0, 0});
    for (uint32_t row = 0; row < 8; ++row)
        flag.pins.push_back(14 * row);
    harness.add(flag);
    harness.upload();
    voile::Step step{.duration = 1.f / 60, .wind = {25, 0, 6}, .gust = 0.5f, .gust_length = 0.5f};
    CHECK(harness.first_intersection(step, 30, [&](int frame) { step.time = frame / 60.0; }) == -1);
}

TEST_CASE("a cloth is pulled from under another one without intersections")
{
    PairHarness harness;
    (void)take(
        harness.solver.add_collider(voile::BoxCollider{.min = {-0.09f, -0.1f, -0.09f}, .max = {0.09f, 0, 0.09f}}));
    voile::GridCloth lower = square(11);
    lower.transform = at({0, 0.005f, 0});
    voile::GridCloth upper = square(7);
    upper.transform = at({0, 0.011f, 0});
    harness.add(lower);
    harness.add(upper);
    harness.upload();
    harness.step({.duration = 1.f / 60}, 5);
    const voile::AnchorId hand = take(harness.solver.add_anchor(glm::mat4(1)));
    std::vector<voile::Attachment> pins;
    for (uint32_t row = 0; row < 11; ++row)
        pins.push_back(voile::pin(11 * row + 10, hand));
    take(harness.solver.set_attachments(harness.cloths[0], pins));
    const auto pull = [&](int frame) {
        take(harness.solver.move_anchor(hand, at({0.03f * static_cast<float>(frame + 1), 0, 0})));
    };
    CHECK(harness.first_intersection({.duration = 1.f / 60}, 20, pull) == -1);
    CHECK(harness.positions(harness.cloths[1])[24].x < 0.3f); // it stays behind: the hand has gone 0.6 m
}
