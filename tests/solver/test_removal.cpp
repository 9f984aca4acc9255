// Removing, disabling and changing what a solver has, at any time.
#include "support/close_to.hpp"
#include "support/cloth_harness.hpp"
#include "support/cloth_meshes.hpp"
#include "support/collider_scenes.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace
{

using tests::ClothHarness;
using tests::flat_sheet;
using tests::moved;
using tests::reason;
using tests::same_bits;
using voile::engine::take;

constexpr float k_frame = 1.f / 60; // s
constexpr float k_gravity = 9.81f;  // m/s^2

// Cloths of all kinds in places of their own, far from each other, each above a ball. Layers keep the features of a
// ball from depending on the other cloths.
class Park
{
public:
    explicit Park(ClothHarness& harness) : harness_(harness) {}

    void add(uint32_t place)
    {
        const auto x = static_cast<float>(10 * place);
        const glm::mat4 transform = moved({x, 1, 0});
        const auto integrator = place % 2 == 0 ? voile::Integrator::verlet : voile::Integrator::rk4;
        Entry entry{.place = place};
        if (place % 3 == 2)
        {
            const tests::ClothMesh mesh = tests::jittered_sheet(11, 9);
            voile::MeshCloth cloth = mesh.cloth();
            cloth.transform = transform;
            cloth.integrator = integrator;
            cloth.layers = 1u << place;
            cloth.pins = {0};
            entry.cloth = take(harness_.solver.add_cloth(cloth));
        }
        else
        {
            voile::GridCloth cloth = flat_sheet(9 + place, 0.5f, 0);
            cloth.transform = transform;
            cloth.integrator = integrator;
            cloth.layers = 1u << place;
            cloth.pins = {0, 5};
            entry.cloth = take(harness_.solver.add_cloth(cloth));
        }
        entry.ball = take(harness_.solver.add_collider(
            voile::SphereCollider{.center = {x, 0.85f, 0}, .radius = 0.1f, .layers = 1u << place}));
        entries.push_back(entry);
    }

    void remove(uint32_t place)
    {
        const auto entry = std::ranges::find(entries, place, &Entry::place);
        take(harness_.solver.remove(entry->cloth));
        take(harness_.solver.remove(entry->ball));
        entries.erase(entry);
    }

    struct Entry
    {
        uint32_t place = 0;
        voile::ClothId cloth{};
        voile::ColliderId ball{};
    };
    std::vector<Entry> entries;

private:
    ClothHarness& harness_;
};

constexpr voile::Step k_step{.duration = k_frame, .substeps = 40};

} // namespace

TEST_CASE("what remains after removals moves as if nothing had been there, to the bit")
{
    ClothHarness harness;
    Park park(harness);
    for (const uint32_t place : {0u, 1u, 2u, 3u, 4u, 5u})
        park.add(place);
    harness.upload();
    harness.step(k_step, 4);
    for (const uint32_t place : {1u, 2u, 4u})
        park.remove(place);
    CHECK_FALSE(harness.solver.needs_upload());
    harness.step(k_step, 2);
    for (const uint32_t place : {2u, 7u}) // in what the others left, and in what grows
        park.add(place);
    harness.step(k_step, 2); // before they are uploaded
    harness.upload();
    harness.step(k_step, 6);

    for (const Park::Entry& entry : park.entries)
    {
        CAPTURE(entry.place);
        ClothHarness alone;
        Park single(alone);
        single.add(entry.place);
        alone.upload();
        alone.step(k_step, entry.place == 2 || entry.place == 7 ? 6 : 14);
        const voile::ClothId id = single.entries.front().cloth;
        CHECK(same_bits(harness.positions(entry.cloth), alone.positions(id)));
        CHECK(same_bits(harness.velocities(entry.cloth), alone.velocities(id)));
        CHECK(same_bits(harness.normals(entry.cloth), alone.normals(id)));
    }
    CHECK(harness.statistics().contacts > 10);
}

TEST_CASE("ids of what was removed are errors, also when their index is used again")
{
    ClothHarness harness;
    voile::Solver& solver = harness.solver;
    const voile::ClothId cloth = take(solver.add_cloth(flat_sheet(4, 1, 0)));
    const voile::ColliderId ball = take(solver.add_collider(voile::SphereCollider{}));
    const voile::AnchorId anchor = take(solver.add_anchor(glm::mat4(1)));
    harness.upload();
    take(solver.remove(cloth));
    take(solver.remove(ball));
    take(solver.remove(anchor));
    for (const bool again : {false, true})
    {
        CAPTURE(again);
        if (again)
        {
            CHECK(take(solver.add_cloth(flat_sheet(5, 1, 0))).index == cloth.index);
            CHECK(take(solver.add_collider(voile::PlaneCollider{.offset = -5})).index == ball.index);
            CHECK(take(solver.add_anchor(glm::mat4(1))).index == anchor.index);
            harness.upload();
        }
        CHECK(reason(solver.remove(cloth)) == "cloth 0 was removed");
        CHECK(reason(solver.set_enabled(cloth, false)) == "cloth 0 was removed");
        CHECK(reason(solver.set_material(cloth, voile::Fabric{})) == "cloth 0 was removed");
        CHECK(reason(solver.set_layers(cloth, 3)) == "cloth 0 was removed");
        CHECK(reason(solver.reset(cloth)) == "cloth 0 was removed");
        CHECK(solver.vertices(cloth).vertices == 0);
        CHECK(solver.triangles(cloth).empty());
        CHECK_FALSE(solver.enabled(cloth));
        CHECK(reason(solver.remove(ball)) == "collider 0 was removed");
        CHECK(reason(solver.set_enabled(ball, true)) == "collider 0 was removed");
        CHECK(reason(solver.set_radius(ball, 1)) == "collider 0 was removed");
        CHECK(reason(solver.set_friction(ball, std::nullopt)) == "collider 0 was removed");
        CHECK(reason(solver.set_layers(ball, 3)) == "collider 0 was removed");
        CHECK(reason(solver.move_collider(ball, glm::mat4(1))) == "collider 0 was removed");
        CHECK_FALSE(solver.enabled(ball));
        CHECK(reason(solver.remove(anchor)) == "anchor 1 was removed");
        CHECK(reason(solver.move_anchor(anchor, glm::mat4(1))) == "anchor 1 was removed");
    }
    CHECK(reason(solver.remove(voile::ClothId{})) == "cloth: the id is a default-constructed one");
    CHECK(reason(solver.remove(voile::ColliderId{7})) == "collider 7 does not exist");
    CHECK(reason(solver.remove(voile::AnchorId{0})) == "anchor 0 does not exist"); // the world
    CHECK(solver.vertex_count() == 25);
    harness.step({}, 2);
}

TEST_CASE("a disabled cloth rests to the bit, continues with its velocity, and the others do not notice")
{
    ClothHarness harness;
    voile::Solver& solver = harness.solver;
    voile::GridCloth falling = flat_sheet(8, 0.5f, 3);
    voile::GridCloth other = flat_sheet(7, 0.5f, 9);
    other.integrator = voile::Integrator::verlet;
    const voile::ClothId paused = take(solver.add_cloth(falling));
    const voile::ClothId free = take(solver.add_cloth(other));
    harness.upload();
    harness.step({}, 5);
    const auto before = harness.positions(paused);
    const float speed = harness.velocities(paused)[9].y;
    const uint32_t dispatches = solver.dispatches({});
    take(solver.set_enabled(paused, false));
    CHECK_FALSE(solver.enabled(paused));
    CHECK(solver.dispatches({}) < dispatches); // no stage of RK4
    harness.step({}, 7);
    CHECK(same_bits(harness.positions(paused), before));
    const float energy = harness.statistics().kinetic_energy;
    take(solver.set_enabled(paused, true));
    CHECK(harness.statistics().kinetic_energy == energy); // the next step enables it
    harness.step({});
    CHECK(harness.statistics().kinetic_energy > energy);
    CHECK(harness.velocities(paused)[9].y == tests::close_to(speed - k_gravity * k_frame, 1e-5));
    CHECK(harness.velocities(free)[9].y == tests::close_to(-k_gravity * 13 * k_frame, 1e-5));

    take(solver.set_enabled(paused, false));
    take(solver.set_enabled(free, false));
    CHECK(solver.dispatches({}) == 0);
    const auto last = harness.positions(free);
    harness.step({}, 3);
    CHECK(same_bits(harness.positions(free), last));
    CHECK(harness.statistics().kinetic_energy == 0);
    take(solver.remove(free));
    take(solver.remove(paused));
    harness.step({}, 2);
    CHECK(harness.statistics().kinetic_energy == 0);
    CHECK(solver.vertex_count() == 0);
}

TEST_CASE("motions end with their step also while no cloth is enabled")
{
    ClothHarness harness;
    voile::Solver& solver = harness.solver;
    const voile::ClothId sheet = take(solver.add_cloth(flat_sheet(6, 0.5f, 1)));
    const voile::AnchorId rod = take(solver.add_anchor(moved({0, 1, 0})));
    const voile::ColliderId ball =
        take(solver.add_collider(voile::SphereCollider{.center = {0, 0.8f, 0}, .radius = 0.1f}));
    take(solver.set_attachments(sheet, {voile::pin(0, rod)}));
    harness.upload();
    harness.step({});
    take(solver.set_enabled(sheet, false));
    const auto before = harness.positions(sheet);
    for (int i = 1; i <= 5; ++i) // past the cloth
    {
        take(solver.move_collider(ball, moved({0, 0.2f * static_cast<float>(i), 0})));
        take(solver.move_anchor(rod, moved({0, 1 + 0.1f * static_cast<float>(i), 0})));
        harness.step({});
    }
    CHECK(same_bits(harness.positions(sheet), before));
    take(solver.set_enabled(sheet, true));
    harness.step({});
    const auto after = harness.positions(sheet);
    CHECK(after[0].y == before[0].y);
    for (size_t i = 1; i < after.size(); ++i)
        CHECK(std::abs(after[i].y - before[i].y) < 0.02f); // it falls, and nothing lifts it
    CHECK(harness.statistics().contacts == 0);
}

TEST_CASE("a stiff cloth that is disabled or removed asks for no substeps")
{
    ClothHarness harness;
    voile::Solver& solver = harness.solver;
    voile::GridCloth stiff = flat_sheet(8, 0.05f, 3);
    for (float& stiffness : tests::fabric_of(stiff).stretch_stiffness)
        stiffness *= 50;
    (void)take(solver.add_cloth(flat_sheet(8, 0.5f, 9)));
    const uint32_t few = solver.stable_substeps(k_frame);
    const voile::ClothId id = take(solver.add_cloth(stiff));
    CHECK(solver.stable_substeps(k_frame) > 2 * few);
    take(solver.set_enabled(id, false));
    CHECK(solver.stable_substeps(k_frame) == few);
    take(solver.set_enabled(id, true));
    take(solver.remove(id));
    CHECK(solver.stable_substeps(k_frame) == few);
}

TEST_CASE("vertices attached to an anchor or a collider are free when it is removed")
{
    ClothHarness harness;
    voile::Solver& solver = harness.solver;
    voile::GridCloth grid = flat_sheet(6, 0.5f, 1);
    const voile::ClothId sheet = take(solver.add_cloth(grid));
    const voile::AnchorId rod = take(solver.add_anchor(glm::mat4(1)));
    const voile::ColliderId ball =
        take(solver.add_collider(voile::SphereCollider{.center = {0.25f, 1, 0.25f}, .radius = 0.05f}));
    std::vector<voile::Attachment> attachments = take(solver.attachments_on_surface(sheet, ball, 0.1f));
    const uint32_t on_ball = attachments.front().vertex;
    REQUIRE(on_ball != 0);
    attachments.push_back(voile::pin(0, rod));
    attachments.push_back(voile::pin(5));
    take(solver.set_attachments(sheet, attachments));
    take(solver.set_tethers(sheet, voile::Tethers{}));
    harness.upload();
    harness.step({}, 3);
    CHECK(harness.positions(sheet)[0].w == 0);
    CHECK(harness.positions(sheet)[on_ball].w == 0);
    take(solver.remove(rod));
    CHECK(solver.attachments(sheet).size() == attachments.size() - 1);
    harness.step({}, 2);
    CHECK(harness.positions(sheet)[0].w > 0);
    CHECK(harness.positions(sheet)[on_ball].w == 0);
    take(solver.remove(ball));
    CHECK_FALSE(solver.needs_upload());
    harness.step({}, 2);
    CHECK(harness.positions(sheet)[on_ball].w > 0);
    CHECK(harness.positions(sheet)[5].w == 0);
    CHECK(solver.attachments(sheet).size() == 1);
    // The last pin: the tethers end with it, and a new pin brings them back.
    take(solver.set_attachments(sheet, {voile::pin(5, take(solver.add_anchor(glm::mat4(1))))}));
    harness.step({}, 2);
    take(solver.remove(*solver.attachments(sheet).front().anchor));
    harness.step({}, 20);
    const float low = harness.positions(sheet)[5].y;
    harness.step({}, 5);
    CHECK(harness.positions(sheet)[5].y < low - 0.2f);
}

TEST_CASE("removed places are used again, and buffers grow a few times for many additions")
{
    ClothHarness harness;
    voile::Solver& solver = harness.solver;
    std::vector<voile::ClothId> ids;
    for (int i = 0; i < 4; ++i)
        ids.push_back(take(solver.add_cloth(flat_sheet(8, 0.5f, static_cast<float>(i)))));
    harness.upload();
    const VkBuffer buffer = solver.vertices(ids[0]).positions;
    const VkDeviceSize place = solver.vertices(ids[2]).offset;
    take(solver.remove(ids[2]));
    CHECK(solver.vertices(ids[2]).positions == VK_NULL_HANDLE);
    const voile::ClothId other = take(solver.add_cloth(flat_sheet(7, 0.5f, 7)));
    harness.upload();
    CHECK(solver.vertices(other).offset == place);
    CHECK(solver.vertices(other).positions == buffer);
    std::set<VkBuffer> buffers;
    for (int i = 0; i < 60; ++i)
    {
        (void)take(solver.add_cloth(flat_sheet(8, 0.5f, static_cast<float>(10 + i))));
        harness.upload();
        harness.step({.substeps = 1});
        buffers.insert(solver.vertices(ids[0]).positions);
    }
    CHECK(buffers.size() <= 8); // 256 to 4,096 vertices, by half each
    CHECK(harness.statistics().nan_vertices == 0);
}

TEST_CASE("a snapshot is for the cloths that it was made for")
{
    ClothHarness harness;
    voile::Solver& solver = harness.solver;
    const voile::ClothId first = take(solver.add_cloth(flat_sheet(6, 0.5f, 0)));
    const voile::ClothId second = take(solver.add_cloth(flat_sheet(6, 0.5f, 3)));
    const voile::ClothId third = take(solver.add_cloth(flat_sheet(5, 0.5f, 6)));
    harness.upload();
    take(solver.remove(second)); // a gap in the middle
    harness.step({}, 3);
    const voile::Snapshot snapshot = take(solver.create_snapshot());
    harness.run([&](VkCommandBuffer cmd) { take(solver.record_save(cmd, snapshot)); });
    const auto saved = harness.positions(third);
    harness.step({}, 3);
    harness.run([&](VkCommandBuffer cmd) { take(solver.record_restore(cmd, snapshot)); });
    CHECK(same_bits(harness.positions(third), saved));
    (void)take(solver.add_cloth(flat_sheet(6, 0.5f, 3))); // as many vertices as the one removed
    harness.upload();
    take(solver.remove(first));
    harness.run(
        [&](VkCommandBuffer cmd)
        {
            CHECK(reason(solver.record_restore(cmd, snapshot)) ==
                  "snapshot: it was made for other cloths: some were uploaded or removed since");
        });
}
