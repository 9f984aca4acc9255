// Additions beside a moving cloth: what an upload preserves, and what continues while one is due.
#include "support/close_to.hpp"
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <algorithm>
#include <cmath>

namespace
{

using tests::ClothHarness;
using tests::collider;
using tests::flat_sheet;
using tests::moved;

constexpr float k_frame = 1.f / 60; // s

// Attaches vertices of the first row to a rod of the host's and returns its anchor.
voile::AnchorId attach_first_row(ClothHarness& harness, voile::ClothId id, uint32_t columns,
                                 voile::Attachment attachment)
{
    const voile::AnchorId rod = voile::engine::take(harness.solver.add_anchor(moved({0, 0, 0})));
    std::vector<voile::Attachment> attachments;
    for (uint32_t column = 0; column < columns; ++column)
    {
        attachment.vertex = column;
        attachment.anchor = rod;
        attachments.push_back(attachment);
    }
    voile::engine::take(harness.solver.set_attachments(id, attachments));
    return rod;
}

float largest_distance(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b)
{
    float largest = 0;
    for (size_t i = 0; i < a.size(); ++i)
        largest = std::max(largest, glm::distance(glm::vec3(a[i]), glm::vec3(b[i])));
    return largest;
}

} // namespace

TEST_CASE("springs and max-distance constraints persist through an upload")
{
    const voile::Attachment spring = voile::spring(0, 500, 1);
    const voile::Attachment limit = voile::max_distance(0, 0.01f);
    std::vector<glm::vec4> ends[2][2];
    for (const bool added : {false, true})
    {
        ClothHarness harness;
        std::vector<voile::ClothId> ids;
        for (const voile::Attachment& attachment : {spring, limit})
        {
            voile::GridCloth grid = flat_sheet(8, 0.5f, 0);
            grid.transform = moved({30, 5, 0});
            ids.push_back(voile::engine::take(harness.solver.add_cloth(grid)));
            attach_first_row(harness, ids.back(), 8, attachment);
        }
        harness.upload();
        harness.step({}, 5);
        if (added)
        {
            (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{.offset = -100}));
            harness.upload();
        }
        harness.step({}, 10);
        for (size_t i = 0; i < 2; ++i)
            ends[added][i] = harness.positions(ids[i]);
    }
    for (size_t i = 0; i < 2; ++i)
        CHECK(largest_distance(ends[0][i], ends[1][i]) < 1e-4f); // with contact, another order of rounding
}

TEST_CASE("pins rest and move with their anchor while an upload is due")
{
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(flat_sheet(6, 0.5f, 0)));
    const voile::AnchorId rod = attach_first_row(harness, id, 6, {});
    harness.upload();
    const auto start = harness.positions(id);
    const auto go_to = [&](float x)
    {
        voile::engine::take(harness.solver.move_anchor(rod, moved({x, 0, 0})));
        harness.step({});
    };
    const auto drift = [&](float x)
    {
        float largest = 0;
        const auto now = harness.positions(id);
        for (size_t column = 0; column < 6; ++column)
            largest =
                std::max(largest, glm::distance(glm::vec3(now[column]), glm::vec3(start[column]) + glm::vec3(x, 0, 0)));
        return largest;
    };
    go_to(0.02f); // 1.2 m/s
    (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{.offset = -100}));
    REQUIRE(harness.solver.needs_upload());
    harness.step({}, 10); // the anchor rests
    CHECK(drift(0.02f) < 1e-5f);
    go_to(0.05f);
    CHECK(drift(0.05f) < 1e-5f);
    harness.upload();
    harness.step({}, 2);
    CHECK(drift(0.05f) < 1e-5f);
}

TEST_CASE("colliders rest and move while an upload is due")
{
    const voile::engine::Mesh ground = voile::engine::make_ground(1);
    for (const bool late : {false, true}) // the first motion comes after the addition
    {
        CAPTURE(late);
        ClothHarness harness;
        // A sheet on a moving table, and one on a deforming table 5 m away.
        std::vector<voile::ClothId> ids;
        std::vector<voile::ColliderId> tables;
        for (const bool deforms : {false, true})
        {
            voile::GridCloth grid = flat_sheet(6, 0.5f, 0);
            tests::fabric_of(grid).static_friction = tests::fabric_of(grid).kinetic_friction = 50;
            const glm::vec3 position(deforms ? 5 : 0, 0, 0);
            grid.transform = moved(position + glm::vec3(0, tests::fabric_of(grid).thickness, 0));
            ids.push_back(voile::engine::take(harness.solver.add_cloth(grid)));
            voile::MeshCollider table = deforms ? tests::deforming(ground) : collider(ground);
            table.transform = moved(position);
            tables.push_back(voile::engine::take(harness.solver.add_collider(table)));
        }
        harness.upload();
        harness.step({}, 3);
        const auto height = [&](size_t i) { return harness.positions(ids[i])[14].y; };
        const float heights[2] = {height(0), height(1)};
        const auto rise = [&](float y)
        {
            voile::engine::take(harness.solver.move_collider(tables[0], moved({0, y, 0})));
            voile::engine::take(
                harness.solver.deform_collider(tables[1], tests::transformed(ground.positions, moved({0, y, 0}))));
            harness.step({});
        };
        const auto check_at = [&](double y)
        {
            for (size_t i = 0; i < 2; ++i)
            {
                CAPTURE(i);
                CHECK(height(i) - heights[i] == tests::close_to(y, 1e-5));
            }
        };
        if (!late)
            rise(0.01f); // 0.6 m/s: the cloth flies to 18 mm above it and falls back
        (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{.offset = -100}));
        REQUIRE(harness.solver.needs_upload());
        if (late)
            rise(0.01f);
        harness.step({}, 20); // the tables rest
        check_at(0.01);
        harness.upload();
        harness.step({}, 5);
        check_at(0.01);
    }
}

TEST_CASE("changes of an uploaded cloth take effect while an upload is due")
{
    ClothHarness harness;
    voile::GridCloth grid = flat_sheet(6, 0.5f, 0);
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    const auto start = harness.positions(id);
    harness.step({}, 10);
    const voile::ClothId other = voile::engine::take(harness.solver.add_cloth(flat_sheet(4, 0.5f, 3)));
    const voile::Attachment corner{.vertex = 0};
    voile::engine::take(harness.solver.set_velocity(other, {7, 0, 0})); // this waits
    voile::engine::take(harness.solver.reset(id));
    voile::engine::take(harness.solver.set_velocity(id, {2, 0, 0}));
    harness.step({.gravity = glm::vec3(0)});
    CHECK(harness.positions(id)[20].x - start[20].x == tests::close_to(2 * k_frame, 5e-7));
    CHECK(harness.positions(id)[0].w > 0);

    voile::engine::take(harness.solver.set_attachments(id, {&corner, 1}));
    const auto before = harness.positions(id);
    harness.step({.gravity = glm::vec3(0)});
    CHECK(glm::vec3(harness.positions(id)[0]) == glm::vec3(before[0]));
    CHECK(harness.positions(id)[0].w == 0);
    harness.upload();
    harness.step({.gravity = glm::vec3(0)}, 3);
    CHECK(glm::vec3(harness.positions(id)[0]) == glm::vec3(before[0]));
    CHECK(harness.positions(id)[20].x > before[20].x);
    CHECK(harness.velocities(other)[5].x == tests::close_to(7, 1e-6));

    (void)voile::engine::take(harness.solver.add_cloth(flat_sheet(4, 0.5f, 6)));
    voile::engine::take(harness.solver.set_attachments(id, {}));
    harness.step({}, 2);
    CHECK(harness.positions(id)[0].w > 0);
}

TEST_CASE("a material takes effect while an upload is due")
{
    ClothHarness harness;
    voile::GridCloth grid = flat_sheet(8, 0.5f, 0);
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    harness.step({});
    const float lightest = harness.positions(id)[9].w;
    (void)voile::engine::take(harness.solver.add_cloth(flat_sheet(2, 0.5f, 3)));
    voile::Fabric heavy = tests::fabric_of(grid);
    heavy.areal_density *= 4;
    voile::engine::take(harness.solver.set_material(id, heavy));
    harness.step({});
    CHECK(harness.positions(id)[9].w == tests::close_to(lightest / 4, 1e-7));
    harness.upload();
    harness.step({});
    CHECK(harness.positions(id)[9].w == tests::close_to(lightest / 4, 1e-7));
}

TEST_CASE("a cloth that is not uploaded yet has no vertices on the device")
{
    ClothHarness harness;
    const voile::ClothId first = voile::engine::take(harness.solver.add_cloth(flat_sheet(6, 0.5f, 0)));
    CHECK(harness.solver.vertices(first).vertices == 0);
    harness.upload();
    CHECK(harness.solver.vertices(first).vertices == 36);
    const voile::ClothId second = voile::engine::take(harness.solver.add_cloth(flat_sheet(5, 0.5f, 1)));
    const voile::VertexStreams streams = harness.solver.vertices(second);
    CHECK(streams.positions == VK_NULL_HANDLE);
    CHECK(streams.velocities == VK_NULL_HANDLE);
    CHECK(streams.normals == VK_NULL_HANDLE);
    CHECK(streams.offset == 0);
    CHECK(streams.vertices == 0);
    CHECK(harness.solver.vertices(first).vertices == 36);
    harness.upload();
    CHECK(harness.solver.vertices(second).vertices == 25);
    CHECK(harness.solver.vertices(second).offset == 36 * sizeof(glm::vec4));
}

TEST_CASE("statistics in flight survive an upload")
{
    ClothHarness harness;
    CHECK(harness.solver.statistics(1).kinetic_energy == 0);
    voile::GridCloth grid = flat_sheet(6, 0.5f, 0);
    grid.velocity = {3, 0, 0};
    (void)voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    harness.step({.gravity = glm::vec3(0)});
    const float energy = harness.statistics().kinetic_energy;
    CHECK(energy > 0.1f);
    CHECK(harness.solver.statistics(1).kinetic_energy == 0); // nothing was recorded into this slot
    (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{.offset = -100}));
    // In one submission, like frames in flight: the reduction, then an upload.
    voile::Upload kept;
    harness.run(
        [&](VkCommandBuffer cmd)
        {
            voile::engine::take(harness.solver.record_statistics(cmd, 1));
            kept = voile::engine::take(harness.solver.record_upload(cmd));
        });
    CHECK(harness.solver.statistics(0).kinetic_energy == energy);
    CHECK(harness.solver.statistics(1).kinetic_energy == energy);
}
