// Previous positions: those before the last step, to the bit, and no motion where a cloth jumped.
#include "support/cloth_harness.hpp"
#include "support/cloth_meshes.hpp"
#include "support/collider_scenes.hpp"

namespace
{

using tests::ClothHarness;
using tests::flat_sheet;
using tests::same_bits;
using voile::engine::take;

class Previous : public ClothHarness
{
public:
    Previous() : ClothHarness({.output = {.previous_positions = true}}) {}

    std::vector<glm::vec4> previous(voile::ClothId cloth)
    {
        const voile::VertexStreams streams = solver.vertices(cloth);
        return tests::checked(read<glm::vec4>(streams.previous_positions, streams.vertices, streams.offset));
    }

    voile::ClothId add(uint32_t columns, float height)
    {
        return take(solver.add_cloth(flat_sheet(columns, 0.5f, height)));
    }
};

} // namespace

TEST_CASE_FIXTURE(Previous, "previous positions are the positions before the last step, to the bit")
{
    const voile::ClothId sheet = add(9, 1);
    const tests::ClothMesh shape = tests::jittered_sheet(7, 5);
    const voile::ClothId mesh = take(solver.add_cloth(voile::MeshCloth{
        .positions = shape.positions, .triangles = shape.triangles, .transform = tests::moved({3, 0, 0})}));
    (void)take(solver.add_collider(voile::SphereCollider{.center = {0, 0.9f, 0}, .radius = 0.2f}));
    upload();
    for (const voile::ClothId id : {sheet, mesh})
        CHECK(same_bits(previous(id), positions(id)));
    for (int i = 0; i < 4; ++i)
    {
        const auto sheet_before = positions(sheet);
        const auto mesh_before = positions(mesh);
        step({.substeps = i % 2 == 0 ? 5u : 4u});
        CHECK(same_bits(previous(sheet), sheet_before));
        CHECK(same_bits(previous(mesh), mesh_before));
        CHECK_FALSE(same_bits(positions(sheet), sheet_before));
    }
}

TEST_CASE_FIXTURE(Previous, "previous positions persist while buffers grow, and while cloths come and go")
{
    const voile::ClothId first = add(9, 1);
    upload();
    step({}, 2);
    const auto kept = previous(first);
    const VkBuffer small = solver.vertices(first).previous_positions;
    const voile::ClothId second = add(40, 2);
    upload();
    CHECK(solver.vertices(first).previous_positions != small);
    CHECK(same_bits(previous(first), kept));
    CHECK(same_bits(previous(second), positions(second)));
    const auto before = positions(first);
    take(solver.remove(second));
    step({});
    CHECK(same_bits(previous(first), before));
    const voile::ClothId third = add(7, 3); // in the place of the second
    upload();
    CHECK(same_bits(previous(third), positions(third)));
    const auto third_before = positions(third);
    step({});
    CHECK(same_bits(previous(third), third_before));
    take(solver.remove(first));
    take(solver.remove(third));
    upload();
    step({}); // copies nothing
}

TEST_CASE_FIXTURE(Previous, "a disabled cloth has no motion")
{
    const voile::ClothId sheet = add(9, 1);
    const voile::ClothId other = add(9, 2);
    upload();
    step({}, 2);
    take(solver.set_enabled(sheet, false));
    step({});
    CHECK(same_bits(previous(sheet), positions(sheet)));
    CHECK_FALSE(same_bits(previous(other), positions(other)));
    take(solver.set_enabled(other, false)); // nothing is left to simulate
    step({}, 2);
    CHECK(same_bits(previous(other), positions(other)));
    take(solver.set_enabled(sheet, true));
    const auto before = positions(sheet);
    step({});
    CHECK(same_bits(previous(sheet), before));
    CHECK_FALSE(same_bits(previous(sheet), positions(sheet)));
}

TEST_CASE_FIXTURE(Previous, "a step that resets or teleports a cloth leaves it without motion")
{
    voile::GridCloth grid = flat_sheet(9, 0.5f, 1);
    grid.pins = {0, 8};
    const voile::ClothId pinned = take(solver.add_cloth(grid));
    const voile::ClothId other = add(5, 2);
    upload();
    step({}, 3);
    const auto jump = [&](const auto& change)
    {
        const auto before = positions(other);
        take(change());
        step({});
        CHECK(same_bits(previous(pinned), positions(pinned)));
        CHECK(same_bits(previous(other), before));
        CHECK_FALSE(same_bits(previous(other), positions(other)));
        const auto after = positions(pinned);
        step({});
        CHECK(same_bits(previous(pinned), after));
        CHECK_FALSE(same_bits(previous(pinned), positions(pinned)));
    };
    jump([&] { return solver.reset(pinned); });
    jump([&] { return solver.teleport(pinned, tests::moved({4, 0, 0})); });
    // A velocity is no jump, and neither is a material.
    const auto before = positions(pinned);
    take(solver.set_velocity(pinned, {1, 0, 0}));
    take(solver.set_material(pinned, voile::Fabric{.areal_density = 0.5f}));
    step({});
    for (size_t i = 0; i < before.size(); ++i)
        CHECK(glm::vec3(previous(pinned)[i]) == glm::vec3(before[i]));
    // A disabled cloth jumps, too.
    take(solver.set_enabled(pinned, false));
    take(solver.teleport(pinned, tests::moved({0, 1, 0})));
    step({});
    CHECK(same_bits(previous(pinned), positions(pinned)));
}

TEST_CASE_FIXTURE(Previous, "a restored snapshot has no motion until the next step")
{
    const voile::ClothId sheet = add(9, 1);
    upload();
    step({}, 2);
    const voile::Snapshot snapshot = take(solver.create_snapshot());
    run([&](VkCommandBuffer cmd) { take(solver.record_save(cmd, snapshot)); });
    const auto saved = positions(sheet);
    step({}, 3);
    run([&](VkCommandBuffer cmd) { take(solver.record_restore(cmd, snapshot)); });
    CHECK(same_bits(positions(sheet), saved));
    CHECK(same_bits(previous(sheet), saved));
    step({});
    CHECK(same_bits(previous(sheet), saved));
    CHECK_FALSE(same_bits(positions(sheet), saved));
}
