// Invalid ids: default-constructed or of another object, and the answer of every function to them.
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <string>

namespace
{

using tests::ClothHarness;
using tests::reason;

struct Expectation
{
    uint32_t index;
    std::string error; // after "cloth", "collider" or "anchor"
};
const Expectation k_expectations[] = {
    {voile::k_no_index, ": the id is a default-constructed one"},
    {1, " 1 does not exist"},
    {77, " 77 does not exist"},
    {voile::k_no_index - 1, " 4294967294 does not exist"},
};

} // namespace

TEST_CASE("a default-constructed id names nothing, and ids compare")
{
    CHECK(voile::ClothId{}.index == voile::k_no_index);
    CHECK(voile::ColliderId{} == voile::ColliderId{});
    ClothHarness harness;
    const voile::ClothId first = voile::engine::take(harness.solver.add_cloth(tests::flat_sheet(4, 1, 0)));
    const voile::ClothId second = voile::engine::take(harness.solver.add_cloth(tests::flat_sheet(4, 1, 1)));
    CHECK(first != second);
    CHECK(first != voile::ClothId{});
    const voile::AnchorId anchor = voile::engine::take(harness.solver.add_anchor(glm::mat4(1)));
    CHECK(anchor != voile::AnchorId{});
}

TEST_CASE("every function refuses a cloth that does not exist or returns an empty answer")
{
    ClothHarness harness;
    voile::Solver& solver = harness.solver;
    const voile::ClothId id = voile::engine::take(solver.add_cloth(tests::flat_sheet(4, 1, 0)));
    const voile::ColliderId ball = voile::engine::take(solver.add_collider(voile::SphereCollider{}));
    const voile::Attachment attachment{.vertex = 0};
    for (const bool uploaded : {false, true})
    {
        if (uploaded)
            harness.upload();
        for (const Expectation& expectation : k_expectations)
        {
            CAPTURE(expectation.index);
            const voile::ClothId none{expectation.index};
            const std::string error = "cloth" + expectation.error;
            CHECK(reason(solver.set_material(none, voile::Fabric{})) == error);
            CHECK(reason(solver.set_attachments(none, {&attachment, 1})) == error);
            CHECK(reason(solver.attachments_on_surface(none, ball, 1)) == error);
            CHECK(reason(solver.set_tethers(none, voile::Tethers{})) == error);
            CHECK(reason(solver.set_tethers(none, std::nullopt)) == error);
            CHECK(reason(solver.reset(none)) == error);
            CHECK(reason(solver.teleport(none, glm::mat4(1))) == error);
            CHECK(reason(solver.set_velocity(none, glm::vec3(0))) == error);
            CHECK(reason(solver.add_output(none, {})) == error);
            CHECK(std::get<voile::Fabric>(solver.material(none)).areal_density == voile::Fabric{}.areal_density);
            CHECK(solver.attachments(none).empty());
            CHECK(solver.stability(none, {}).needed == 0);
            CHECK(solver.stability(none, {}).stiffness_scale == 1);
            CHECK(solver.vertices(none).vertices == 0);
            CHECK(solver.vertices(none).positions == VK_NULL_HANDLE);
            CHECK(solver.triangles(none).empty());
            CHECK(solver.texture_coordinates(none).empty());
            CHECK(solver.name(none).empty());
            CHECK(solver.mesh_report(none).components == 0);
        }
    }
    // Nothing is left over for the next step.
    harness.step({});
    CHECK(harness.statistics().nan_vertices == 0);
    CHECK(solver.attachments(id).empty());
}

TEST_CASE("every function refuses a collider that does not exist or returns an empty answer")
{
    ClothHarness harness;
    voile::Solver& solver = harness.solver;
    const voile::ClothId id = voile::engine::take(solver.add_cloth(tests::flat_sheet(4, 1, 0)));
    (void)voile::engine::take(solver.add_collider(voile::SphereCollider{}));
    harness.upload();
    const std::vector<glm::vec3> positions(3);
    for (const Expectation& expectation : k_expectations)
    {
        CAPTURE(expectation.index);
        const voile::ColliderId none{expectation.index};
        const std::string error = "collider" + expectation.error;
        CHECK(reason(solver.move_collider(none, glm::mat4(1))) == error);
        CHECK(reason(solver.deform_collider(none, positions)) == error);
        CHECK(reason(solver.deform_collider(none, voile::DeviceVertices{})) == error);
        CHECK(reason(solver.attachments_on_surface(id, none, 1)) == error);
        CHECK(solver.hierarchy_boxes(none, 0).empty());
    }
}

TEST_CASE("every function refuses an anchor that does not exist, including the world")
{
    ClothHarness harness;
    voile::Solver& solver = harness.solver;
    const voile::ClothId id = voile::engine::take(solver.add_cloth(tests::flat_sheet(4, 1, 0)));
    for (const uint32_t index : {voile::k_no_index, 0u, 1u, 77u})
    {
        CAPTURE(index);
        const voile::AnchorId none{index};
        const std::string error = index == voile::k_no_index ? "anchor: the id is a default-constructed one"
                                                             : "anchor " + std::to_string(index) + " does not exist";
        const voile::Attachment attachment{.vertex = 3, .anchor = none};
        CHECK(reason(solver.move_anchor(none, glm::mat4(1))) == error);
        CHECK(reason(solver.set_attachments(id, {&attachment, 1})) ==
              "cloth \"cloth\": the attachment of vertex 3: " + error);
    }
}

TEST_CASE("a statistics slot that does not exist is refused, and reads 0")
{
    ClothHarness harness({.statistics_slots = 3});
    (void)voile::engine::take(harness.solver.add_cloth(tests::flat_sheet(4, 1, 0)));
    harness.upload();
    harness.run(
        [&](VkCommandBuffer cmd)
        {
            CHECK(reason(harness.solver.record_statistics(cmd, 3)) == "statistics: slot 3 of 3 does not exist");
            CHECK(reason(harness.solver.record_statistics(cmd, UINT32_MAX)) ==
                  "statistics: slot 4294967295 of 3 does not exist");
        });
    CHECK(harness.solver.statistics(3).mean_stretch == 0);
    CHECK(harness.solver.statistics(UINT32_MAX).mean_stretch == 0);
}
