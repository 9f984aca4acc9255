// Mesh colliders whose vertices the host moves: surfaces that carry cloth, equality with rigid motion, and hard cases
// in which no vertex may change sides.
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"

#include "voile/gpu/buffer.hpp"

#include "voile/engine/assets/shapes.hpp"
#include "voile/mesh_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace
{

using tests::ClothHarness;
using tests::deforming;
using tests::fabric_of;
using tests::flat_sheet;
using tests::reason;
using tests::transformed;

// A hemisphere of radius r at rest, open at the top. `closing` from 0 to 1 moves its rim toward the axis and past the
// half sphere, like a closing hand.
voile::engine::Mesh bowl(float radius, float closing)
{
    constexpr uint32_t k_rings = 16;
    constexpr uint32_t k_segments = 32;
    voile::engine::Mesh mesh;
    const float opening = (0.5f + 0.35f * closing) * std::numbers::pi_v<float>; // from the bottom to the rim
    mesh.positions.emplace_back(0, -radius, 0);
    for (uint32_t ring = 1; ring <= k_rings; ++ring)
        for (uint32_t segment = 0; segment < k_segments; ++segment)
        {
            const float polar = opening * static_cast<float>(ring) / k_rings;
            const float around = 2 * std::numbers::pi_v<float> * static_cast<float>(segment) / k_segments;
            mesh.positions.emplace_back(radius * std::sin(polar) * std::cos(around), -radius * std::cos(polar),
                                        radius * std::sin(polar) * std::sin(around));
        }
    const auto at = [](uint32_t ring, uint32_t segment)
    { return ring == 0 ? 0 : 1 + (ring - 1) * k_segments + segment % k_segments; };
    for (uint32_t ring = 0; ring < k_rings; ++ring)
        for (uint32_t segment = 0; segment < k_segments; ++segment)
        {
            mesh.triangles.emplace_back(at(ring, segment), at(ring + 1, segment), at(ring + 1, segment + 1));
            if (ring > 0)
                mesh.triangles.emplace_back(at(ring, segment), at(ring + 1, segment + 1), at(ring, segment + 1));
        }
    return mesh;
}

} // namespace

TEST_CASE("a mesh whose vertices all move alike acts like a rigid one")
{
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, -0.4f, 0}, 0.4f, 16);
    constexpr uint32_t k_frames = 5; // the first contact is in the fourth frame
    std::vector<glm::vec4> ends[3];
    for (int motion = 0; motion < 3; ++motion) // rigid, deformed by the host, both at once
    {
        ClothHarness harness({.feature_contact = false}); // deforming meshes have no features
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(flat_sheet(24, 0.8f, 0.15f)));
        voile::MeshCollider description = deforming(ball);
        description.deforms = motion > 0;
        const voile::ColliderId with = voile::engine::take(harness.solver.add_collider(description));
        harness.upload();
        for (uint32_t frame = 1; frame <= k_frames; ++frame)
        {
            const float time = static_cast<float>(frame) / 60;
            const glm::mat4 rise = glm::translate(glm::mat4(1.f), time * glm::vec3(0.4f, 2.5f, -0.2f));
            const glm::mat4 turn = glm::rotate(glm::mat4(1.f), 2 * time, glm::vec3(0, 1, 0));
            if (motion == 0)
                REQUIRE(harness.solver.move_collider(with, rise * turn));
            if (motion == 1)
                REQUIRE(harness.solver.deform_collider(with, transformed(ball.positions, rise * turn)));
            if (motion == 2)
            {
                REQUIRE(harness.solver.move_collider(with, rise));
                REQUIRE(harness.solver.deform_collider(with, transformed(ball.positions, turn)));
            }
            harness.step({.gravity = glm::vec3(0)});
        }
        CHECK(harness.statistics().contacts > 0);
        CHECK(harness.statistics().penetrating_vertices == 0);
        ends[motion] = harness.positions(id);
    }
    // Vertices move along chords of 2 / 60 rad each. Halfway the ball is smaller by 1 - cos(1 / 60), 0.06 mm. Later
    // differences of the sheet grow from there.
    for (int motion = 1; motion < 3; ++motion)
        for (size_t i = 0; i < ends[0].size(); ++i)
            CHECK(glm::distance(glm::vec3(ends[motion][i]), glm::vec3(ends[0][i])) < 1e-3f);
}

TEST_CASE("friction on a flowing surface carries cloth along")
{
    // A ground of 20 x 20 cells, stretched along x: a point at x moves with the velocity x / 4 per second.
    voile::engine::Mesh ground;
    constexpr uint32_t k_side = 21;
    for (uint32_t row = 0; row < k_side; ++row)
        for (uint32_t column = 0; column < k_side; ++column)
            ground.positions.emplace_back(0.1f * static_cast<float>(column) - 1, 0, 0.1f * static_cast<float>(row) - 1);
    for (uint32_t row = 0; row + 1 < k_side; ++row)
        for (uint32_t column = 0; column + 1 < k_side; ++column)
        {
            const uint32_t i = row * k_side + column;
            ground.triangles.emplace_back(i, i + k_side, i + 1);
            ground.triangles.emplace_back(i + 1, i + k_side, i + k_side + 1);
        }
    ClothHarness harness;
    voile::GridCloth patch = flat_sheet(5, 0.05f, 0);
    voile::Fabric& fabric = fabric_of(patch);
    fabric.static_friction = fabric.kinetic_friction = 0.8f;
    patch.transform = glm::translate(glm::mat4(1.f), {0.4f, fabric.thickness, 0.1f});
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(patch));
    const voile::ColliderId with = voile::engine::take(harness.solver.add_collider(deforming(ground)));
    harness.upload();
    harness.step({}, 10);
    std::vector<glm::vec3> positions = ground.positions;
    for (int frame = 1; frame <= 60; ++frame)
    {
        for (size_t i = 0; i < positions.size(); ++i)
            positions[i].x = ground.positions[i].x * (1 + static_cast<float>(frame) / 240);
        REQUIRE(harness.solver.deform_collider(with, positions));
        harness.step({});
    }
    // 0.4 m becomes 0.5 m. The patch is stiff: its center moves with the ground below it, minus the slip until it
    // follows, v^2 / (2 mu g) = 0.6 mm.
    CHECK(std::abs(harness.positions(id)[12].x - 0.5f) < 1.5e-3f);
    CHECK(std::abs(harness.velocities(id)[12].x - 0.1f) < 5e-3f);
    harness.step({}, 30);
    CHECK(harness.statistics().kinetic_energy < 1e-6f);
    CHECK(std::abs(harness.positions(id)[12].x - 0.5f) < 2.5e-3f);
}

TEST_CASE("vertices in a GPU buffer deform a collider like vertices from the host")
{
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0, 0}, 0.3f, 12);
    struct Vertex // like the output of an engine's skinning
    {
        float weight;
        glm::vec3 position;
        glm::vec2 uv;
    };
    std::vector<glm::vec4> ends[2];
    for (int from_gpu = 0; from_gpu < 2; ++from_gpu)
    {
        ClothHarness harness;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(flat_sheet(16, 0.64f, 0.31f)));
        voile::MeshCollider description = deforming(ball);
        description.transform = glm::scale(glm::mat4(1.f), glm::vec3(1, 0.9f, 1));
        const voile::ColliderId with = voile::engine::take(harness.solver.add_collider(description));
        harness.upload();
        voile::gpu::Buffer buffer = voile::engine::take(
            voile::gpu::create_buffer(harness.context(), "skinned", 16 + ball.positions.size() * sizeof(Vertex),
                                      VK_BUFFER_USAGE_TRANSFER_SRC_BIT, voile::Memory::upload));
        for (int frame = 1; frame <= 12; ++frame)
        {
            const auto grown = transformed(
                ball.positions, glm::scale(glm::mat4(1.f), glm::vec3(1 + 0.01f * static_cast<float>(frame))));
            if (from_gpu == 0)
                REQUIRE(harness.solver.deform_collider(with, grown));
            else
            {
                for (size_t i = 0; i < grown.size(); ++i)
                {
                    const Vertex vertex{1, grown[i], {}};
                    std::memcpy(buffer.mapped().data() + 16 + i * sizeof(Vertex), &vertex, sizeof(Vertex));
                }
                buffer.flush();
                REQUIRE(harness.solver.deform_collider(
                    with, voile::DeviceVertices{buffer.handle(), 16 + offsetof(Vertex, position), sizeof(Vertex)}));
            }
            harness.step({});
        }
        CHECK(harness.statistics().contacts > 0);
        CHECK(harness.statistics().penetrating_vertices == 0);
        ends[from_gpu] = harness.positions(id);
    }
    CHECK(std::memcmp(ends[0].data(), ends[1].data(), ends[0].size() * sizeof(glm::vec4)) == 0);
}

TEST_CASE("a closing bowl keeps the cloth inside")
{
    for (const float speed : {3.f, 6.f}) // closings per second: the rim moves at up to 7 m/s
    {
        CAPTURE(speed);
        const voile::engine::Mesh open = bowl(0.4f, 0);
        ClothHarness harness;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(flat_sheet(14, 0.4f, -0.22f)));
        const voile::ColliderId with = voile::engine::take(harness.solver.add_collider(deforming(open)));
        harness.upload();
        harness.step({}, 25);
        float closing = 0;
        while (closing < 1)
        {
            closing = std::min(closing + speed / 60, 1.f);
            const voile::engine::Mesh now = bowl(0.4f, closing);
            REQUIRE(harness.solver.deform_collider(with, now.positions));
            harness.step({});
            const auto exact = voile::engine::take(
                voile::MeshDistance::create({.positions = now.positions, .triangles = now.triangles}));
            for (const glm::vec4& p : harness.positions(id))
            {
                REQUIRE(std::isfinite(p.x));
                // All vertices were inside. Each still is, or it has left through the opening above the rim.
                const bool inside = !exact.crossing(glm::dvec3(0), glm::dvec3(p));
                CHECK(inside);
            }
        }
        CHECK(harness.statistics().nan_vertices == 0);
    }
}

TEST_CASE("an upload preserves a deformed mesh")
{
    const voile::engine::Mesh ground = voile::engine::make_ground(1);
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(flat_sheet(8, 0.2f, 0.52f)));
    const voile::ColliderId with = voile::engine::take(harness.solver.add_collider(deforming(ground)));
    harness.upload();
    REQUIRE(harness.solver.deform_collider(
        with, transformed(ground.positions, glm::translate(glm::mat4(1.f), {0, 0.5f, 0}))));
    harness.step({}, 20);
    (void)voile::engine::take(harness.solver.add_collider(deforming(voile::engine::make_ground(1, -2))));
    harness.upload();
    harness.step({}, 30);
    for (const glm::vec4& p : harness.positions(id))
        CHECK(p.y > 0.5f);
}

TEST_CASE("vertices inside a deforming mesh are counted before the first step and after an upload")
{
    ClothHarness harness;
    voile::GridCloth grid = flat_sheet(3, 0.2f, 0);
    grid.pins = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    (void)voile::engine::take(harness.solver.add_cloth(grid));
    const voile::engine::Mesh box = voile::engine::make_box(glm::vec3(-0.5f), glm::vec3(0.5f));
    const voile::ColliderId id = voile::engine::take(harness.solver.add_collider(deforming(box)));
    harness.upload();
    CHECK(harness.statistics().penetrating_vertices == 9);
    CHECK(harness.statistics().deepest_penetration == doctest::Approx(0.5f).epsilon(1e-6));
    voile::engine::take(harness.solver.deform_collider(id, transformed(box.positions, tests::moved({0, 0.2f, 0}))));
    harness.step({});
    (void)voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    CHECK(harness.statistics().penetrating_vertices == 18);
    CHECK(harness.statistics().deepest_penetration == doctest::Approx(0.3f).epsilon(1e-6));
}

TEST_CASE("invalid input of a deforming collider is refused")
{
    ClothHarness harness;
    voile::Solver& solver = harness.solver;
    const voile::engine::Mesh ground = voile::engine::make_ground(1);
    const voile::ColliderId stiff = voile::engine::take(
        solver.add_collider(voile::MeshCollider{.positions = ground.positions, .triangles = ground.triangles}));
    const voile::ColliderId soft = voile::engine::take(solver.add_collider(deforming(ground)));
    auto positions = ground.positions;
    CHECK(reason(solver.deform_collider(stiff, positions)) ==
          "collider 0 does not deform: it was added without \"deforms\"");
    CHECK(reason(solver.deform_collider({9}, positions)) == "collider 9 does not exist");
    CHECK(reason(solver.deform_collider(soft, std::span(positions).first(3))) ==
          "collider 1: 3 positions, but it was added with 4");
    positions[2].y = std::numeric_limits<float>::infinity();
    CHECK(reason(solver.deform_collider(soft, positions)) == "collider 1: position 2 is not finite");
    CHECK(reason(solver.deform_collider(soft, voile::DeviceVertices{})) == "collider 1: no buffer of vertices");
    const auto some = reinterpret_cast<VkBuffer>(uintptr_t{16}); // never used
    CHECK(reason(solver.deform_collider(soft, voile::DeviceVertices{some, 2})) ==
          "collider 1: the vertices' offset is 2 bytes, must be a multiple of 4");
    CHECK(reason(solver.deform_collider(soft, voile::DeviceVertices{some, 0, 8})) ==
          "collider 1: the vertices' stride is 8 bytes, must be 12 to 64 and a multiple of 4");
    CHECK(reason(solver.deform_collider(soft, ground.positions)) == "accepted");
}
