// Colliders that move: the substep in the collider's space, surfaces that carry cloth along, fast and thin colliders
// that must not miss, layers and sides, and bad input.
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"

#include "voile/engine/assets/shapes.hpp"
#include "voile/mesh_checks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace
{

using tests::ClothHarness;
using tests::collider;
using tests::fabric_of;
using tests::flat_sheet;
using tests::moved;
using tests::reason;

// Every kind of collider, with its top near y = 0.
std::vector<voile::Collider> all_kinds(const voile::engine::Mesh& ball)
{
    voile::BoxCollider box{.min = {-0.3f, -0.2f, -0.25f}, .max = {0.3f, 0.2f, 0.25f}};
    box.transform = glm::rotate(moved({0, -0.3f, 0}), 0.4f, glm::vec3(0.6f, 0, 0.8f));
    return {collider(ball), voile::PlaneCollider{}, voile::SphereCollider{.center = {0, -0.4f, 0}, .radius = 0.4f},
            voile::CapsuleCollider{.from = {-0.3f, -0.2f, 0}, .to = {0.3f, -0.25f, 0.1f}, .radius = 0.2f}, box};
}

} // namespace

TEST_CASE("a collider that rises to the cloth acts like a cloth that falls on the collider")
{
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, -0.4f, 0}, 0.4f, 16);
    const glm::vec3 velocity(0.4f, 3, -0.2f); // m/s, of the collider
    // The first contact is in the fourth frame. Later the sheet buckles, and roundings grow into different folds.
    constexpr uint32_t k_frames = 5;
    for (const voile::Collider& kind : all_kinds(ball))
    {
        CAPTURE(kind.index());
        std::vector<glm::vec4> ends[2];
        for (int moving = 0; moving < 2; ++moving)
        {
            ClothHarness harness;
            voile::GridCloth grid = flat_sheet(16, 0.8f, 0.15f);
            grid.velocity = moving == 1 ? glm::vec3(0) : -velocity;
            const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
            const voile::ColliderId with = voile::engine::take(harness.solver.add_collider(kind));
            harness.upload();
            for (uint32_t frame = 1; frame <= k_frames; ++frame)
            {
                const float time = static_cast<float>(frame) / 60;
                if (moving == 1)
                    CHECK(harness.solver.move_collider(with, moved(time * velocity)));
                harness.step({.gravity = glm::vec3(0)});
            }
            float fastest = 0; // relative to the collider before it
            for (const glm::vec4& v : harness.velocities(id))
                fastest = std::max(fastest, glm::distance(glm::vec3(v), grid.velocity));
            CHECK(fastest > 1);
            ends[moving] = harness.positions(id);
        }
        const glm::vec3 displacement = velocity * (static_cast<float>(k_frames) / 60);
        for (size_t i = 0; i < ends[0].size(); ++i)
            CHECK(glm::distance(glm::vec3(ends[1][i]) - displacement, glm::vec3(ends[0][i])) < 1e-4f);
    }
}

TEST_CASE("a turning table carries a patch of cloth around")
{
    // 0.5 rad/s at 0.3 m: the centripetal acceleration, 0.075 m/s^2, is far below mu g.
    const voile::engine::Mesh ground = voile::engine::make_ground(2);
    for (const bool mesh : {false, true})
    {
        CAPTURE(mesh);
        ClothHarness harness;
        voile::GridCloth grid = flat_sheet(7, 0.075f, 0);
        voile::Fabric& fabric = fabric_of(grid);
        fabric.static_friction = 0.8f;
        fabric.kinetic_friction = 0.7f;
        grid.transform = moved({0.3f, fabric.thickness, 0});
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        const voile::ColliderId table = voile::engine::take(mesh ? harness.solver.add_collider(collider(ground))
                                                                 : harness.solver.add_collider(voile::PlaneCollider{}));
        harness.upload();
        const auto start = harness.positions(id);
        glm::mat4 turn(1.f);
        for (uint32_t frame = 1; frame <= 40; ++frame)
        {
            turn = glm::rotate(glm::mat4(1.f), 0.5f * static_cast<float>(frame) / 60, glm::vec3(0, 1, 0));
            CHECK(harness.solver.move_collider(table, turn));
            harness.step({});
        }
        const auto end = harness.positions(id);
        for (size_t i = 0; i < start.size(); ++i)
        {
            // The patch starts at rest and must reach 0.15 m/s: v^2 / (2 mu g) = 1.6 mm of slip.
            const glm::vec3 expected(turn * glm::vec4(glm::vec3(start[i]), 1));
            CHECK(glm::distance(expected, glm::vec3(end[i])) < 2.5e-3f);
        }
        // The patch stops with the table.
        harness.step({}, 10);
        CHECK(harness.statistics().kinetic_energy < 1e-6f);
    }
}

TEST_CASE("a ball shot through a curtain carries it along")
{
    const glm::vec3 start(0, 0, -0.6f);
    const voile::engine::Mesh ball_mesh = voile::engine::make_sphere(start, 0.2f, 16);
    const voile::SphereCollider ball{.center = start, .radius = 0.2f};
    for (const voile::Collider& kind : {voile::Collider(ball), voile::Collider(collider(ball_mesh))})
        for (const float speed : {30.f, 100.f})
        {
            CAPTURE(kind.index());
            CAPTURE(speed);
            ClothHarness harness;
            voile::GridCloth grid = flat_sheet(64, 1.5f, 0);
            grid.transform = glm::rotate(glm::mat4(1.f), std::numbers::pi_v<float> / 2, glm::vec3(1, 0, 0)); // hangs
            for (uint32_t column = 0; column < 64; ++column)
                grid.pins.push_back(column);
            const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
            const voile::ColliderId with = voile::engine::take(harness.solver.add_collider(kind));
            harness.upload();
            const auto before = harness.positions(id);
            // Until the ball has moved by the curtain's length and pulls it out of its path.
            for (float z = start.z; z < 0.5f;)
            {
                z = std::min(z + speed / 60, 0.5f);
                REQUIRE(harness.solver.move_collider(with, moved({0, 0, z - start.z})));
                harness.step({});
                const auto now = harness.positions(id);
                uint32_t passed = 0; // of the vertices in the ball's path
                for (size_t i = 0; i < now.size(); ++i)
                {
                    REQUIRE(std::isfinite(now[i].z));
                    // The mesh lies within its ball by 1 - cos(pi / 32) of the radius, and by a facet's width.
                    REQUIRE(glm::distance(glm::vec3(now[i]), glm::vec3(0, 0, z)) > 0.2f * 0.98f);
                    passed += z > 0 && glm::length(glm::vec2(before[i])) < 0.15f && now[i].z < z;
                }
                CHECK(passed == 0);
            }
            CHECK(harness.statistics().nan_vertices == 0);
            CHECK(harness.statistics().penetrating_vertices == 0);
        }
}

TEST_CASE("cloth attached to a collider follows it, however far it jumps")
{
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0.3f, 0}, 0.3f, 16);
    ClothHarness harness;
    voile::GridCloth grid = flat_sheet(18, 0.8f, 0.61f);
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    const voile::ColliderId with = voile::engine::take(harness.solver.add_collider(collider(ball)));
    (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{}));
    const std::vector<voile::Attachment> attachments =
        voile::engine::take(harness.solver.attachments_on_surface(id, with, 0.03f));
    REQUIRE(attachments.size() > 4);
    REQUIRE(harness.solver.set_attachments(id, attachments));
    harness.upload();
    harness.step({}, 20);
    glm::mat4 there(1.f);
    for (const glm::vec3& displacement : {glm::vec3(1, 0, 0), glm::vec3(1, 1, 0.5f), glm::vec3(-0.3f, 0.4f, 0)})
    {
        there = glm::rotate(moved(displacement), displacement.y, glm::vec3(0, 1, 0));
        REQUIRE(harness.solver.move_collider(with, there));
        harness.step({});
        const auto positions = harness.positions(id);
        for (const voile::Attachment& attachment : attachments)
            CHECK(glm::distance(glm::vec3(positions[attachment.vertex]),
                                glm::vec3(there * glm::vec4(attachment.position.value_or(glm::vec3(0)), 1))) < 1e-5f);
        CHECK(harness.statistics().nan_vertices == 0);
        CHECK(harness.statistics().deepest_penetration < 1e-6f); // attached vertices lie on the surface itself
        harness.step({}, 20);
        CHECK(harness.statistics().deepest_penetration < 1e-6f); // attached vertices lie on the surface itself
    }
    harness.step({}, 40);
    CHECK(harness.statistics().nan_vertices == 0);
    CHECK(harness.statistics().kinetic_energy < 1);
}

TEST_CASE("a spinning mesh drags the sheet on it around, and no vertex enters it")
{
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0.4f, 0}, 0.4f, 12); // with large facets
    const auto distance = voile::engine::take(voile::MeshDistance::create(collider(ball)));
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(flat_sheet(30, 1.05f, 0.83f)));
    const voile::ColliderId with = voile::engine::take(harness.solver.add_collider(collider(ball)));
    harness.upload();
    double deepest = 1;
    for (int frame = 1; frame <= 75; ++frame)
    {
        const glm::mat4 motion = glm::rotate(glm::mat4(1.f), 4 * static_cast<float>(frame) / 60, glm::vec3(0, 1, 0));
        REQUIRE(harness.solver.move_collider(with, motion));
        harness.step({});
        const glm::mat4 back = glm::inverse(motion);
        for (const glm::vec4& p : harness.positions(id))
            deepest = std::min(deepest, distance.nearest(glm::vec3(back * glm::vec4(glm::vec3(p), 1))).signed_distance);
    }
    CHECK(deepest > -2e-6);
    const auto x = harness.positions(id);
    const auto v = harness.velocities(id);
    double turning = 0; // mean angular velocity about y, rad/s
    for (size_t i = 0; i < x.size(); ++i)
        turning +=
            static_cast<double>((x[i].z * v[i].x - x[i].x * v[i].z) / (x[i].x * x[i].x + x[i].z * x[i].z + 0.01f)) /
            static_cast<double>(x.size());
    CHECK(turning > 0.5);
}

TEST_CASE("cloth touches only the colliders of its layers")
{
    ClothHarness harness;
    std::vector<voile::ClothId> ids;
    for (const uint32_t layers : {1u, 2u, 3u, 4u})
    {
        voile::GridCloth grid = flat_sheet(8, 0.2f, 0.05f);
        grid.layers = layers;
        ids.push_back(voile::engine::take(harness.solver.add_cloth(grid)));
    }
    (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{.layers = 1}));
    const voile::engine::Mesh lower = voile::engine::make_ground(2, -1);
    voile::MeshCollider second = collider(lower);
    second.layers = 2;
    (void)voile::engine::take(harness.solver.add_collider(second));
    harness.upload();
    harness.step({}, 60);
    const float thickness = fabric_of(flat_sheet(8, 0.2f, 0)).thickness;
    CHECK(std::abs(harness.positions(ids[0])[0].y - thickness) < 1e-4f);
    CHECK(std::abs(harness.positions(ids[1])[0].y - (thickness - 1)) < 1e-4f);
    CHECK(std::abs(harness.positions(ids[2])[0].y - thickness) < 1e-4f);
    CHECK(harness.positions(ids[3])[0].y < -4);
}

TEST_CASE("a mesh pushes cloth to the chosen side")
{
    // A cloth inside a ball: a two-sided mesh keeps it inside, a one-sided mesh lets it out. A cloth that falls on the
    // back of an open ground: it passes through a one-sided one.
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0, 0}, 0.5f, 24);
    for (const voile::Sidedness sides :
         {voile::Sidedness::automatic, voile::Sidedness::one_sided, voile::Sidedness::two_sided})
    {
        CAPTURE(static_cast<int>(sides));
        ClothHarness harness;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(flat_sheet(8, 0.4f, -0.2f)));
        voile::MeshCollider with = collider(ball);
        with.sidedness = sides;
        (void)voile::engine::take(harness.solver.add_collider(with));
        voile::GridCloth below = flat_sheet(8, 0.3f, 1.2f);
        below.layers = 2;
        const voile::ClothId falling = voile::engine::take(harness.solver.add_cloth(below));
        voile::engine::Mesh ground = voile::engine::make_ground(2, 1);
        for (glm::uvec3& t : ground.triangles)
            std::swap(t.y, t.z); // faces down
        voile::MeshCollider floor = collider(ground);
        floor.sidedness = sides;
        floor.layers = 2;
        (void)voile::engine::take(harness.solver.add_collider(floor));
        harness.upload();
        harness.step({}, 45);
        float farthest = 0;
        for (const glm::vec4& p : harness.positions(id))
            farthest = std::max(farthest, glm::length(glm::vec3(p)));
        const bool two = sides == voile::Sidedness::two_sided;
        CHECK((farthest < 0.5f) == two);
        CHECK((harness.positions(falling)[50].y < 0) == (sides == voile::Sidedness::one_sided));
    }
}

TEST_CASE("the boxes of each level of a hierarchy cover the mesh and lie within their parents")
{
    ClothHarness harness;
    const voile::engine::Mesh ball = voile::engine::make_sphere({1, 2, 3}, 0.5f, 8);
    const voile::ColliderId with = voile::engine::take(harness.solver.add_collider(collider(ball)));
    const voile::ColliderId plane = voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{}));
    CHECK(harness.solver.hierarchy_boxes(plane, 3).empty());
    voile::MeshCollider deforming = collider(ball);
    deforming.deforms = true;
    CHECK(harness.solver.hierarchy_boxes(voile::engine::take(harness.solver.add_collider(deforming)), 3).empty());
    const auto within = [](const glm::vec3& min, const glm::vec3& max, const voile::BoundingBox& box)
    { return glm::all(glm::lessThanEqual(box.min, min)) && glm::all(glm::lessThanEqual(max, box.max)); };
    std::vector<voile::BoundingBox> above = harness.solver.hierarchy_boxes(with, 0);
    REQUIRE(above.size() == 1);
    CHECK(glm::distance(above[0].min, glm::vec3(0.5f, 1.5f, 2.5f)) < 1e-5f);
    for (uint32_t level = 1; level <= 48; ++level)
    {
        const std::vector<voile::BoundingBox> boxes = harness.solver.hierarchy_boxes(with, level);
        CHECK(boxes.size() <= 2 * above.size());
        for (const voile::BoundingBox& box : boxes)
            CHECK(std::any_of(above.begin(), above.end(),
                              [&](const voile::BoundingBox& outer) { return within(box.min, box.max, outer); }));
        for (const glm::uvec3& t : ball.triangles)
        {
            const glm::vec3 min = glm::min(ball.positions[t.x], glm::min(ball.positions[t.y], ball.positions[t.z]));
            const glm::vec3 max = glm::max(ball.positions[t.x], glm::max(ball.positions[t.y], ball.positions[t.z]));
            REQUIRE(std::any_of(boxes.begin(), boxes.end(),
                                [&](const voile::BoundingBox& box) { return within(min, max, box); }));
        }
        above = boxes;
    }
    CHECK(above.size() >= ball.triangles.size() / 4); // the leaves
}

TEST_CASE("invalid input of a collider is refused and changes nothing")
{
    ClothHarness harness;
    voile::Solver& solver = harness.solver;
    const voile::ColliderId ball = voile::engine::take(solver.add_collider(voile::SphereCollider{}));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(reason(solver.move_collider({7}, glm::mat4(1))) == "collider 7 does not exist");
    CHECK(reason(solver.move_collider(ball, glm::mat4(nan))) == "collider 0: its motion is not finite");
    CHECK(reason(solver.move_collider(ball, glm::mat4(2))) == "collider 0: its motion is not rigid");
    CHECK(reason(solver.move_collider(ball, glm::scale(glm::mat4(1.f), glm::vec3(-1, 1, 1)))) ==
          "collider 0: its motion is not rigid");
    CHECK(reason(solver.add_collider(voile::CapsuleCollider{.radius = -1})).find("radius is -1") != std::string::npos);
    CHECK(reason(solver.add_collider(voile::CapsuleCollider{.from = {nan, 0, 0}})) ==
          "collider \"capsule\": from is (nan, 0, 0) m, each must be -1e+06 to 1e+06");
    CHECK(reason(solver.add_collider(voile::BoxCollider{.min = {0, 1, 0}, .max = {1, 1, 1}})) ==
          "collider \"box\": the side along y is 0 m, must be 0.0001 to 2e+06");
    CHECK(reason(solver.add_collider(voile::BoxCollider{.transform = glm::mat4(3)})) ==
          "collider \"box\": the box's transform is not rigid");
    CHECK(voile::engine::take(solver.add_collider(voile::PlaneCollider{})).index == 1);
}
