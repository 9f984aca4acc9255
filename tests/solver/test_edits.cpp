// Changes of an existing cloth: materials, reset, teleport, velocity, and snapshots to the bit.
#include "support/close_to.hpp"
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"

#include "voile/fabrics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

namespace
{

using tests::ClothHarness;
using tests::same_bits;

voile::Fabric stretchy(float stiffness)
{
    voile::Fabric fabric;
    fabric.areal_density = 0.2f;
    fabric.stretch_stiffness = {stiffness, stiffness};
    fabric.shear_stiffness = 0;
    fabric.bending_stiffness = 0;
    fabric.damping_ratio = 0.5f;
    fabric.air_drag_normal = fabric.air_drag_tangential = 5;
    return fabric;
}

// Hangs from its first row.
voile::GridCloth hanging(const voile::ClothMaterial& material)
{
    voile::GridCloth grid;
    grid.columns = grid.rows = 9;
    grid.transform[1] = {0, 0, 1, 0};
    grid.transform[2] = {0, -1, 0, 0};
    grid.transform[3] = {0, -0.5f, 0, 1};
    grid.material = material;
    for (uint32_t column = 0; column < 9; ++column)
        grid.pins.push_back(column);
    return grid;
}

double lengthening(const std::vector<glm::vec4>& x)
{
    return -static_cast<double>(x[8 * 9 + 4].y) - 1;
}

} // namespace

TEST_CASE("a material changes while the cloth hangs, without new buffers")
{
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(hanging(stretchy(50))));
    harness.upload();
    const VkBuffer buffer = harness.solver.vertices(id).positions;
    const auto settled = [&]
    {
        harness.step({.air_density = 5}, 150);
        return lengthening(harness.positions(id));
    };
    const double weight = 0.2 * 9.81; // a square meter
    CHECK(settled() == tests::close_to(weight / (2 * 50), 1.5e-4));
    voile::engine::take(harness.solver.set_material(id, stretchy(100)));
    CHECK_FALSE(harness.solver.needs_upload());
    CHECK(settled() == tests::close_to(weight / (2 * 100), 1.5e-3));
    voile::Fabric heavy = stretchy(100);
    heavy.areal_density = 0.6f;
    voile::engine::take(harness.solver.set_material(id, heavy));
    CHECK(settled() == tests::close_to(3 * weight / (2 * 100), 0.01));
    CHECK(1 / harness.positions(id)[40].w == tests::close_to(0.6f / 64, 1e-7));
    CHECK(harness.positions(id)[0].w == 0); // still pinned
    CHECK(harness.solver.vertices(id).positions == buffer);
}

TEST_CASE("a material that does not fit the cloth is refused, and the old one is kept")
{
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(hanging(stretchy(50))));
    const auto reason = [&](const voile::ClothMaterial& material)
    {
        const auto result = harness.solver.set_material(id, material);
        CHECK(std::get<voile::Fabric>(harness.solver.material(id)).stretch_stiffness[0] == 50);
        return result ? std::string() : result.error().message;
    };
    CHECK(reason(voile::reference_material()) == "cloth \"cloth\": it was added with a Fabric and stays one");
    voile::Fabric slippery = stretchy(70);
    slippery.kinetic_friction = 0.9f;
    slippery.static_friction = 0.1f;
    CHECK(reason(slippery) ==
          "cloth \"cloth\": fabric: static_friction is 0.1, must be at least kinetic_friction, 0.9");
    voile::Fabric negative = stretchy(70);
    negative.areal_density = -1;
    CHECK(reason(negative) == "cloth \"cloth\": fabric: areal_density is -1 kg/m^2, must be 0.001 to 1000");
    voile::Fabric limit = stretchy(70);
    limit.strain_limit = 1e-6f;
    CHECK(reason(limit) == "cloth \"cloth\": fabric: strain_limit is 1e-06, must be 0.001 to 10, or 0 for none");
}

TEST_CASE("a cloth is reset, teleported and given a velocity")
{
    ClothHarness harness;
    voile::GridCloth grid = hanging(stretchy(50));
    grid.pins = {};
    grid.velocity = {1, 0, 0};
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    const voile::ClothId other = voile::engine::take(harness.solver.add_cloth(hanging(stretchy(80))));
    harness.upload();
    const auto start = harness.positions(id);
    harness.step({}, 20);
    const auto first = harness.positions(id);
    const auto untouched = harness.positions(other);
    voile::engine::take(harness.solver.reset(id));
    harness.step({}, 20);
    CHECK(same_bits(harness.positions(id), first)); // the same fall again
    CHECK_FALSE(same_bits(harness.positions(other), untouched));

    // Only the edit and one tiny step without gravity.
    const voile::Step still{.duration = 1e-6f, .gravity = {0, 0, 0}};
    voile::engine::take(harness.solver.reset(id));
    voile::engine::take(harness.solver.set_velocity(id, {0, 0, 0}));
    glm::mat4 turn(1.f);
    turn[0] = {0, 0, -1, 0};
    turn[2] = {1, 0, 0, 0};
    turn[3] = {5, 6, 7, 1};
    voile::engine::take(harness.solver.teleport(id, turn));
    harness.step(still);
    const auto moved = harness.positions(id);
    for (size_t i = 0; i < start.size(); ++i)
        CHECK(glm::distance(glm::vec3(moved[i]), glm::vec3(turn * glm::vec4(glm::vec3(start[i]), 1))) < 2e-6f);
    voile::engine::take(harness.solver.set_velocity(id, {0, 3, 0}));
    voile::engine::take(harness.solver.teleport(id, glm::mat4(1.f)));
    harness.step(still);
    for (const glm::vec4& v : harness.velocities(id))
        CHECK(v.y == tests::close_to(3, 2e-4));
    CHECK_FALSE(harness.solver.teleport(id, glm::mat4(NAN)).has_value());
    CHECK_FALSE(harness.solver.set_velocity(id, glm::vec3(INFINITY)).has_value());
}

TEST_CASE("a snapshot restores the state to the bit, also through the host")
{
    for (const voile::Integrator integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
    {
        ClothHarness harness;
        voile::GridCloth grid = hanging(stretchy(50));
        grid.integrator = integrator;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        (void)voile::engine::take(
            harness.solver.add_collider(voile::SphereCollider{.center = {0, -0.8f, 0.1f}, .radius = 0.2f}));
        CHECK_FALSE(harness.solver.create_snapshot().has_value()); // nothing is uploaded yet
        harness.upload();
        const voile::Step step{.wind = {0, 0, 3}, .gust = 0.5f};
        harness.step(step, 25);
        const voile::Snapshot snapshot = voile::engine::take(harness.solver.create_snapshot());
        harness.run([&](VkCommandBuffer cmd) { voile::engine::take(harness.solver.record_save(cmd, snapshot)); });
        const std::vector<std::byte> kept(snapshot.bytes().begin(), snapshot.bytes().end());
        const auto saved = harness.positions(id);
        harness.step(step, 25);
        const auto x = harness.positions(id);
        const auto v = harness.velocities(id);
        for (const bool by_host : {false, true})
        {
            voile::Snapshot other = voile::engine::take(harness.solver.create_snapshot());
            if (by_host)
                voile::engine::take(other.assign(kept));
            harness.run([&](VkCommandBuffer cmd)
                        { voile::engine::take(harness.solver.record_restore(cmd, by_host ? other : snapshot)); });
            CHECK(same_bits(harness.positions(id), saved));
            harness.step(step, 25);
            CHECK(same_bits(harness.positions(id), x));
            CHECK(same_bits(harness.velocities(id), v));
            CHECK_FALSE(other.assign(std::span(kept).first(16)).has_value());
        }
    }
}

TEST_CASE("a restored state has the masses and the pins of the present material and attachments")
{
    ClothHarness harness;
    voile::GridCloth grid = tests::flat_sheet(12, 0.5f, 1);
    grid.material = voile::cotton();
    grid.pins = {0, 11};
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    harness.step({}, 3);
    const voile::Snapshot snapshot = voile::engine::take(harness.solver.create_snapshot());
    harness.run([&](VkCommandBuffer cmd) { voile::engine::take(harness.solver.record_save(cmd, snapshot)); });
    const auto saved = harness.positions(id);
    voile::Fabric heavy = voile::cotton();
    heavy.areal_density *= 15;
    voile::engine::take(harness.solver.set_material(id, heavy));
    voile::engine::take(harness.solver.set_attachments(id, {voile::pin(11), voile::pin(60)}));
    harness.step({}, 2);
    harness.run([&](VkCommandBuffer cmd) { voile::engine::take(harness.solver.record_restore(cmd, snapshot)); });
    harness.step({}, 5);
    const auto x = harness.positions(id);
    CHECK(x[70].w == tests::close_to(static_cast<double>(saved[70].w) / 15, 1e-6));
    CHECK(x[0].w == tests::close_to(static_cast<double>(saved[1].w) / 15 * 2, 1e-6)); // a corner has half of a border's
    CHECK(x[0].y < saved[0].y - 1e-4f);
    for (const uint32_t pinned : {11u, 60u})
    {
        CHECK(x[pinned].w == 0);
        CHECK(glm::vec3(x[pinned]) == glm::vec3(saved[pinned]));
    }
    CHECK(harness.statistics().max_stretch < 0.5f);
}

// A sheet in the middle of a box, which has no preferred side to leave, and a sheet released in a stretched state,
// whose strain limit returns the energy that it took.
std::array<voile::ClothId, 2> add_remembering(ClothHarness& harness)
{
    voile::GridCloth buried = tests::flat_sheet(12, 0.4f, 0.001f);
    voile::GridCloth stretched = tests::flat_sheet(8, 0.4f, 2);
    tests::fabric_of(stretched).strain_limit = 0.01f;
    stretched.transform[0] *= 1.2f;
    const std::array ids{voile::engine::take(harness.solver.add_cloth(buried)),
                         voile::engine::take(harness.solver.add_cloth(stretched))};
    (void)voile::engine::take(
        harness.solver.add_collider(voile::BoxCollider{.min = {-0.15f, -0.2f, -0.3f}, .max = {0.15f, 0.2f, 0.3f}}));
    harness.upload();
    return ids;
}

using States = std::vector<std::vector<glm::vec4>>;

States states(ClothHarness& harness, std::span<const voile::ClothId> ids)
{
    States all;
    for (const voile::ClothId id : ids)
    {
        all.push_back(harness.positions(id));
        all.push_back(harness.velocities(id));
    }
    return all;
}

constexpr voile::Step k_forty{.substeps = 40};

TEST_CASE("a snapshot contains the state of depenetration and of the strain limit, to the bit")
{
    for (const uint32_t before : {1u, 4u, 7u})
    {
        CAPTURE(before);
        ClothHarness harness;
        const auto ids = add_remembering(harness);
        harness.step(k_forty, before);
        const voile::Snapshot snapshot = voile::engine::take(harness.solver.create_snapshot());
        harness.run([&](VkCommandBuffer cmd) { voile::engine::take(harness.solver.record_save(cmd, snapshot)); });
        harness.step(k_forty, 12);
        const States first = states(harness, ids);
        harness.step(k_forty, 3);
        harness.run([&](VkCommandBuffer cmd) { voile::engine::take(harness.solver.record_restore(cmd, snapshot)); });
        harness.step(k_forty, 12);
        CHECK((states(harness, ids) == first));

        ClothHarness other; // like a program that reads a file
        const auto read_ids = add_remembering(other);
        voile::Snapshot read = voile::engine::take(other.solver.create_snapshot());
        voile::engine::take(read.assign(snapshot.bytes()));
        other.run([&](VkCommandBuffer cmd) { voile::engine::take(other.solver.record_restore(cmd, read)); });
        other.step(k_forty, 12);
        CHECK((states(other, read_ids) == first));
    }
}

TEST_CASE("an upload preserves the state of depenetration and of the strain limit, to the bit")
{
    ClothHarness alone;
    ClothHarness joined;
    const auto ids = add_remembering(alone);
    REQUIRE((add_remembering(joined) == ids));
    alone.step(k_forty, 5);
    joined.step(k_forty, 5);
    (void)voile::engine::take(joined.solver.add_cloth(tests::flat_sheet(4, 0.2f, 5)));
    joined.upload();
    alone.step(k_forty, 15);
    joined.step(k_forty, 15);
    CHECK((states(alone, ids) == states(joined, ids)));
}

TEST_CASE("a snapshot that is empty or not finite is refused")
{
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(hanging(stretchy(50))));
    harness.upload();
    voile::Snapshot snapshot = voile::engine::take(harness.solver.create_snapshot());
    const auto before = harness.positions(id);
    harness.run(
        [&](VkCommandBuffer cmd) {
            CHECK(harness.solver.record_restore(cmd, snapshot).error().message == "snapshot: nothing was saved in it");
        });
    CHECK(same_bits(harness.positions(id), before));
    std::vector<std::byte> bytes(snapshot.bytes().size(), std::byte{0});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(bytes.data() + 2 * sizeof(glm::vec4), &nan, sizeof(nan));
    CHECK(snapshot.assign(bytes).error().message == "snapshot: vertex 2 is not finite");
    CHECK_FALSE(harness.solver.record_restore(VK_NULL_HANDLE, snapshot).has_value());
}

TEST_CASE("a snapshot of another solver is refused")
{
    ClothHarness small;
    voile::GridCloth grid = hanging(stretchy(50));
    (void)voile::engine::take(small.solver.add_cloth(grid));
    small.upload();
    const voile::Snapshot snapshot = voile::engine::take(small.solver.create_snapshot());
    small.run([&](VkCommandBuffer cmd) { voile::engine::take(small.solver.record_save(cmd, snapshot)); });
    ClothHarness large;
    grid.columns *= 10;
    (void)voile::engine::take(large.solver.add_cloth(grid));
    large.upload();
    for (ClothHarness* other : {&large, &small})
        other->run(
            [&](VkCommandBuffer cmd)
            {
                const bool own = other == &small;
                CHECK(other->solver.record_save(cmd, snapshot).has_value() == own);
                const auto restored = other->solver.record_restore(cmd, snapshot);
                CHECK((own || restored.error().message == "snapshot: it was made by another solver"));
            });
}

TEST_CASE("pins of a disabled cloth keep their inverse mass of 0, whatever changes")
{
    ClothHarness harness;
    const voile::GridCloth grid = hanging(stretchy(50));
    REQUIRE(grid.pins.size() >= 2);
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    harness.step({}, 2);
    const voile::Snapshot snapshot = voile::engine::take(harness.solver.create_snapshot());
    harness.run([&](VkCommandBuffer cmd) { voile::engine::take(harness.solver.record_save(cmd, snapshot)); });
    voile::engine::take(harness.solver.set_enabled(id, false));
    const auto pinned = [&](uint32_t vertex)
    {
        harness.step({});
        const float speed = glm::length(glm::vec3(harness.velocities(id)[vertex]));
        return harness.positions(id)[vertex].w == 0 && speed == 0;
    };
    CHECK(pinned(grid.pins[0]));
    voile::engine::take(harness.solver.reset(id));
    CHECK(pinned(grid.pins[0]));
    voile::engine::take(harness.solver.set_velocity(id, {1, 0, 0}));
    CHECK(pinned(grid.pins[0]));
    voile::engine::take(harness.solver.set_material(id, stretchy(60)));
    CHECK(pinned(grid.pins[0]));
    harness.run([&](VkCommandBuffer cmd) { voile::engine::take(harness.solver.record_restore(cmd, snapshot)); });
    CHECK(pinned(grid.pins[0]));
    voile::engine::take(harness.solver.set_attachments(id, {voile::pin(grid.pins[1])}));
    CHECK(pinned(grid.pins[1]));
    CHECK_FALSE(pinned(grid.pins[0]));
    voile::engine::take(harness.solver.set_attachments(id, {}));
    CHECK_FALSE(pinned(grid.pins[1]));
}
