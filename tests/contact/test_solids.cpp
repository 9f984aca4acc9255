// Depenetration: cloth that starts inside a closed mesh leaves it, whole and without a blow, wherever it is and however
// it got there. A double-precision query decides what is inside.
#include "support/close_to.hpp"
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"
#include "support/fastest.hpp"
#include "support/odd_solids.hpp"

#include "voile/engine/assets/shapes.hpp"
#include "voile/mesh_checks.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace
{

using tests::ClothHarness;
using tests::collider;
using tests::fastest;
using tests::joined;
using tests::moved;
using tests::spire;

voile::GridCloth sheet(uint32_t vertices, float size, const glm::vec3& middle)
{
    voile::GridCloth grid;
    grid.columns = grid.rows = vertices;
    grid.width = grid.depth = size;
    grid.transform = moved(middle);
    return grid;
}

uint32_t count_inside(const voile::MeshDistance& exact, const std::vector<glm::vec4>& positions,
                      const glm::mat4& motion = glm::mat4(1))
{
    const glm::dmat4 back = glm::inverse(glm::dmat4(motion));
    return static_cast<uint32_t>(std::count_if(positions.begin(), positions.end(),
                                               [&](const glm::vec4& p)
                                               {
                                                   const glm::dvec3 local(back * glm::dvec4(glm::dvec3(p), 1));
                                                   return exact.winding_number(local) > 0.5 &&
                                                          exact.nearest(local).signed_distance < -2e-6;
                                               }));
}

// m/s: by how much a speed exceeds that of a free fall since the start.
float beyond_fall(float speed, int frames)
{
    return speed - 9.81f * static_cast<float>(frames) / 60;
}

// m/s beyond a fall. Vertices inside leave at 0.9 m/s at most; the parts that they pull and drop swing.
constexpr float k_calm = 6; // measured: 3.2 off a box that moves, 3.1 of a sheet that a ball pierces

// Steps until no vertex is inside, up to `frames`, then `more`. Checks that no vertex is ever fast, and that none is
// inside at the end.
void comes_out(ClothHarness& harness, voile::ClothId id, const voile::MeshDistance& exact, int frames, int more)
{
    CHECK(count_inside(exact, harness.positions(id)) > 0);
    float top = 0;
    int frame = 0;
    const auto step = [&]
    {
        harness.step({});
        top = std::max(top, beyond_fall(fastest(harness.velocities(id)), ++frame));
    };
    while (frame < frames && count_inside(exact, harness.positions(id)) > 0)
        step();
    const int out = frame;
    while (frame < out + more)
        step();
    MESSAGE("out after " << out << " frames, at most " << top << " m/s beyond a fall");
    CHECK(top < k_calm);
    CHECK(count_inside(exact, harness.positions(id)) == 0);
    CHECK(harness.statistics().penetrating_vertices == 0);
    CHECK(harness.statistics().nan_vertices == 0);
}

} // namespace

TEST_CASE("a sheet that a solid pierces leaves it and comes to rest")
{
    struct Case
    {
        const char* name;
        voile::engine::Mesh mesh;
        float height; // m, of the sheet
        bool deforms;
    };
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0, 0}, 0.3f, 16);
    const Case cases[] = {
        {"the middle of a ball", ball, 0, false},
        {"the middle of a ball that may deform", ball, 0, true},
        {"a cube", voile::engine::make_box({-0.3f, -0.3f, -0.3f}, {0.3f, 0.3f, 0.3f}), 0.15f, false},
        {"a flat box", voile::engine::make_box({-0.3f, -0.06f, -0.2f}, {0.3f, 0.06f, 0.2f}), -0.05f, false},
    };
    for (const Case& c : cases)
    {
        CAPTURE(c.name);
        ClothHarness harness;
        voile::GridCloth grid = sheet(11, 0.9f, {0.01f, c.height, 0.02f});
        grid.integrator = (&c - cases) % 2 == 0 ? voile::Integrator::rk4 : voile::Integrator::verlet;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        voile::MeshCollider description = collider(c.mesh);
        const auto exact = voile::engine::take(voile::MeshDistance::create(description));
        description.deforms = c.deforms;
        (void)voile::engine::take(harness.solver.add_collider(description));
        (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{.offset = -0.3f}));
        harness.upload();
        comes_out(harness, id, exact, 90, 25);
        CHECK(harness.statistics().kinetic_energy < 0.02f); // J; measured: 0.0044
        CHECK(harness.statistics().max_stretch < 0.1f);     // measured: 0.042
    }
}

TEST_CASE("a small cloth leaves the inside of a ball of 20,736 triangles")
{
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0, 0}, 0.3f, 72);
    const auto exact = voile::engine::take(voile::MeshDistance::create(collider(ball)));
    for (const auto integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
    {
        ClothHarness harness;
        voile::GridCloth grid = sheet(10, 0.2f, {0.05f, 0.08f, 0});
        grid.integrator = integrator;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        (void)voile::engine::take(harness.solver.add_collider(collider(ball)));
        harness.upload();
        comes_out(harness, id, exact, 60, 5);
        for (const glm::vec4& p : harness.positions(id)) // the shorter path; it fell through the bottom
            CHECK(p.y > 0);
    }
}

TEST_CASE("a mesh cloth leaves a sharp spire and nested parts")
{
    const voile::engine::Mesh parts = joined(voile::engine::make_box({-0.3f, -0.2f, -0.3f}, {0.1f, 0.2f, 0.3f}),
                                             voile::engine::make_sphere({0.1f, 0, 0}, 0.25f, 12));
    for (const voile::engine::Mesh& mesh : {spire(), parts})
    {
        CAPTURE(mesh.triangles.size());
        const auto exact = voile::engine::take(voile::MeshDistance::create(collider(mesh)));
        REQUIRE(exact.closed());
        ClothHarness harness;
        voile::MeshCloth description;
        std::vector<glm::vec3> positions;
        std::vector<glm::uvec3> triangles;
        constexpr uint32_t k_side = 11; // vertices
        for (uint32_t i = 0; i < k_side * k_side; ++i)
            positions.emplace_back(0.039f * static_cast<float>(i % k_side) - 0.2f, 0.05f,
                                   0.039f * static_cast<float>(i / k_side) - 0.19f);
        for (uint32_t i = 0; i < (k_side - 1) * k_side; ++i)
            if (i % k_side < k_side - 1)
            {
                triangles.emplace_back(i, i + k_side, i + 1);
                triangles.emplace_back(i + 1, i + k_side, i + k_side + 1);
            }
        description.positions = positions;
        description.triangles = triangles;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(description));
        (void)voile::engine::take(harness.solver.add_collider(collider(mesh)));
        harness.upload();
        comes_out(harness, id, exact, 120, 10); // measured: 83 frames
    }
}

TEST_CASE("cloth leaves a collider added over it or one that it is moved into")
{
    const voile::engine::Mesh box = voile::engine::make_box({-0.25f, -0.1f, -0.25f}, {0.25f, 0.1f, 0.25f});
    const auto exact = voile::engine::take(voile::MeshDistance::create(collider(box)));
    for (const bool added : {true, false})
    {
        CAPTURE(added);
        ClothHarness harness;
        voile::GridCloth grid = sheet(16, 0.8f, {0.01f, 0.02f, 0});
        const float thickness = std::get<voile::Fabric>(grid.material).thickness;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{.offset = 0.02f - thickness}));
        if (!added)
        {
            (void)voile::engine::take(harness.solver.add_collider(collider(box)));
            REQUIRE(harness.solver.teleport(id, moved({1, 0, 0})));
        }
        harness.upload();
        harness.step({}, 3);
        if (added)
        {
            (void)voile::engine::take(harness.solver.add_collider(collider(box)));
            harness.upload();
        }
        else
        {
            REQUIRE(harness.solver.teleport(id, moved({-1, 0, 0})));
            harness.step({});
        }
        comes_out(harness, id, exact, 60, 10);
        // The plane is solid to above the middle of the box: the cloth left upward.
        for (const glm::vec4& p : harness.positions(id))
            CHECK(p.y > 0.0199f);
    }
}

TEST_CASE("cloth leaves solids that move, turn and deform meanwhile")
{
    const voile::engine::Mesh box = voile::engine::make_box({-0.2f, -0.15f, -0.2f}, {0.2f, 0.15f, 0.2f});
    for (const bool deforms : {false, true})
    {
        CAPTURE(deforms);
        ClothHarness harness;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(sheet(13, 0.7f, {0.01f, 0.05f, 0})));
        voile::MeshCollider description = collider(box);
        description.deforms = deforms;
        const voile::ColliderId with = voile::engine::take(harness.solver.add_collider(description));
        harness.upload();
        voile::engine::Mesh now = box;
        glm::mat4 motion(1.f);
        float top = 0;
        for (int frame = 1; frame <= 50; ++frame)
        {
            const float time = static_cast<float>(frame) / 60;
            motion = glm::rotate(moved(time * glm::vec3(0.5f, 0.3f, 0)), time, glm::vec3(0, 1, 0));
            REQUIRE(harness.solver.move_collider(with, motion));
            if (deforms)
            {
                for (size_t i = 0; i < now.positions.size(); ++i)
                    now.positions[i] = (1 + 0.2f * time) * box.positions[i];
                REQUIRE(harness.solver.deform_collider(with, now.positions));
            }
            harness.step({});
            top = std::max(top, beyond_fall(fastest(harness.velocities(id)), frame));
        }
        MESSAGE("at most " << top << " m/s beyond a fall");
        const auto exact = voile::engine::take(voile::MeshDistance::create(collider(now)));
        CHECK(count_inside(exact, harness.positions(id), motion) == 0);
        CHECK(top < k_calm);
    }
}

TEST_CASE("a ball that moves at 8 m/s takes the cloth inside it along, and lets it out")
{
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(sheet(6, 0.1f, {0, 0, 0})));
    const auto ball = voile::engine::take(harness.solver.add_collider(voile::SphereCollider{.radius = 0.15f}));
    harness.upload();
    const voile::Step step{.gravity = glm::vec3(0), .air_density = 0};
    harness.step(step, 2);
    constexpr float k_speed = 8; // m/s
    float x = 0;
    float top = 0;
    for (int frame = 0; frame < 15; ++frame)
    {
        x += k_speed / 60;
        REQUIRE(harness.solver.move_collider(ball, moved({x, 0, 0})));
        harness.step(step);
        top = std::max(top, fastest(harness.velocities(id)));
    }
    CHECK(harness.statistics().penetrating_vertices == 0);
    float mean = 0;
    for (const glm::vec4& p : harness.positions(id))
        mean += p.x / 36;
    MESSAGE("the sheet has moved by " << mean << " m, the ball by " << x << " m, at most " << top << " m/s");
    CHECK(mean > 0.9f * x);
    CHECK(top < 12);
}

TEST_CASE("a solid that jumps away does not throw the cloth that was inside")
{
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(sheet(10, 0.1f, {0, 0, 0})));
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0, 0}, 0.3f, 12);
    const voile::ColliderId with = voile::engine::take(harness.solver.add_collider(collider(ball)));
    harness.upload();
    harness.step({});
    REQUIRE(harness.solver.move_collider(with, moved({30, 0, 0})));
    harness.step({}, 2);
    CHECK(fastest(harness.velocities(id)) < 3); // m/s; measured: 0.7
}

TEST_CASE("pins, cloth of other layers and cloth in two-sided meshes stay inside")
{
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0, 0}, 0.3f, 12);
    struct Case
    {
        const char* name;
        bool pinned;
        uint32_t layers;
        voile::Sidedness sides;
        bool stays;
    };
    for (const Case& c : {Case{"free", false, 1, voile::Sidedness::automatic, false},
                          Case{"pinned", true, 1, voile::Sidedness::automatic, true},
                          Case{"on another layer", false, 2, voile::Sidedness::automatic, true},
                          Case{"in a mesh with two sides", false, 1, voile::Sidedness::two_sided, true}})
    {
        CAPTURE(c.name);
        ClothHarness harness;
        voile::GridCloth grid = sheet(6, 0.1f, {0, 0.1f, 0});
        grid.layers = c.layers;
        if (c.pinned)
            grid.pins = {0, 14, 15, 35};
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        voile::MeshCollider description = collider(ball);
        description.sidedness = c.sides;
        (void)voile::engine::take(harness.solver.add_collider(description));
        harness.upload();
        const auto before = harness.positions(id);
        harness.step({.gravity = glm::vec3(0), .air_density = 0}, 2); // the first step only votes
        const auto after = harness.positions(id);
        for (const uint32_t i : {0u, 14u, 15u, 35u})
            CHECK((glm::distance(before[i], after[i]) < (c.pinned ? 1e-30f : 1e-6f)) == c.stays);
        if (!c.stays)
            CHECK(glm::distance(glm::vec3(before[14]), glm::vec3(after[14])) == tests::close_to(0.015, 1e-4));
    }
}

TEST_CASE("depenetration never leads below the ground")
{
    // Half of the ball is below the ground, and cloth lies nearer to its bottom than to its top.
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0, 0}, 0.3f, 16);
    const voile::engine::Mesh ground = voile::engine::make_ground(2, -0.1f);
    const auto exact = voile::engine::take(voile::MeshDistance::create(collider(ball)));
    for (const bool mesh : {false, true})
    {
        CAPTURE(mesh);
        ClothHarness harness;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(sheet(12, 0.24f, {0.01f, -0.06f, 0})));
        (void)voile::engine::take(harness.solver.add_collider(collider(ball)));
        (void)voile::engine::take(mesh ? harness.solver.add_collider(collider(ground))
                                       : harness.solver.add_collider(voile::PlaneCollider{.offset = -0.1f}));
        harness.upload();
        comes_out(harness, id, exact, 80, 5);
        for (const glm::vec4& p : harness.positions(id))
            CHECK(p.y > -0.1f);
    }
}

TEST_CASE("depenetration is recorded only with a solid, and is equal to the bit in every run")
{
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0, 0}, 0.3f, 12);
    voile::MeshCollider two_sided = collider(ball);
    two_sided.sidedness = voile::Sidedness::two_sided;
    const voile::engine::Mesh ground = voile::engine::make_ground(2, -1);
    const voile::Step step{.substeps = 4};
    std::array<uint32_t, 4> dispatches{};
    const voile::Collider kinds[] = {voile::Collider(voile::SphereCollider{}), voile::Collider(two_sided),
                                     voile::Collider(collider(ground)), voile::Collider(collider(ball))};
    std::vector<glm::vec4> ends[2];
    for (size_t kind = 0; kind < 4; ++kind)
        for (int run = 0; run < (kind < 3 ? 1 : 2); ++run)
        {
            ClothHarness harness({.feature_contact = false}); // it has its own passes
            const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(sheet(20, 0.8f, {0, 0.1f, 0})));
            (void)voile::engine::take(harness.solver.add_collider(kinds[kind]));
            harness.upload();
            dispatches[kind] = harness.solver.dispatches(step);
            if (kind < 3)
                continue;
            harness.step({}, 10);
            ends[run] = harness.positions(id);
        }
    CHECK(dispatches[0] == dispatches[3]);
    CHECK(dispatches[1] == dispatches[2]);
    CHECK(dispatches[1] + 1 == dispatches[3]);
    CHECK(std::memcmp(ends[0].data(), ends[1].data(), ends[0].size() * sizeof(glm::vec4)) == 0);
}
