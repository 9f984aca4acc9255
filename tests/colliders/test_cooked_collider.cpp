// A cooked mesh collider on the GPU: an instance that is turned and moved holds cloth as the mesh itself does there.
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <doctest/doctest.h>

TEST_CASE("a cooked collider that is turned and moved holds cloth as its mesh does there")
{
    const voile::engine::Mesh mesh = voile::engine::make_sphere({0, 0, 0}, 0.3f, 16);
    const auto cooked = voile::cook(tests::collider(mesh));
    REQUIRE(cooked);
    const glm::mat4 there = glm::rotate(tests::moved({0.5f, 1, 0.25f}), 0.7f, glm::normalize(glm::vec3(1, 2, -1)));
    // Which edges are features follows from the boxes of the hierarchy, which a turn changes.
    const auto run = [&](const voile::MeshCollider& collider, const glm::mat4& motion, voile::BoundingBox& box)
    {
        tests::ClothHarness harness({.feature_contact = false});
        voile::GridCloth sheet = tests::flat_sheet(16, 0.6f, 1.31f);
        sheet.transform[3] += glm::vec4(0.5f, 0, 0.25f, 0);
        const auto cloth = harness.solver.add_cloth(sheet);
        const auto id = harness.solver.add_collider(collider);
        REQUIRE(cloth);
        REQUIRE(id);
        box = harness.solver.hierarchy_boxes(id.value(), 0).at(0);
        REQUIRE(harness.solver.move_collider(id.value(), motion));
        harness.upload();
        harness.step({.duration = 1 / 60.f}, 6);
        CHECK(harness.statistics().contacts > 0);
        return harness.positions(cloth.value());
    };
    voile::MeshCollider own = tests::collider(mesh);
    voile::BoundingBox own_box;
    voile::BoundingBox box;
    const std::vector<glm::vec4> found = run({.transform = there, .cooked = cooked.value()}, glm::mat4(1), box);
    CHECK(found == run(own, there, own_box));
    own.transform = there;
    const std::vector<glm::vec4> expected = run(own, glm::mat4(1), own_box);
    float farthest = 0;
    for (size_t i = 0; i < expected.size(); ++i)
        farthest = std::max(farthest, glm::distance(glm::vec3(expected[i]), glm::vec3(found[i])));
    CHECK(farthest < 7e-7f); // m; 1.4e-7 were measured
    CHECK(glm::all(glm::lessThanEqual(box.min, own_box.min + 1e-5f)));
    CHECK(glm::all(glm::greaterThanEqual(box.max, own_box.max - 1e-5f)));
}
