// Solids that close on cloth, and part again.
#include "support/collider_scenes.hpp"
#include "support/fastest.hpp"
#include "support/intersection_harness.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace
{

constexpr float k_radius = 0.06f; // m
constexpr float k_open = 0.05f;   // m, from the sheet to each solid

// What closes on a sheet from above and from below. Both touch at the height 0 when they have moved by `k_open`.
struct Jaws
{
    std::string name;
    voile::Collider upper;
    voile::Collider lower;
    bool lower_moves = true;
};

voile::MeshCollider mesh_ball(float y)
{
    static const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0, 0}, k_radius, 24);
    voile::MeshCollider mesh = tests::collider(ball);
    mesh.transform = tests::moved({0, y, 0});
    return mesh;
}

std::vector<Jaws> jaws()
{
    const float y = k_open + k_radius;
    return {{"balls", voile::SphereCollider{.center = {0, y, 0}, .radius = k_radius},
             voile::SphereCollider{.center = {0, -y, 0}, .radius = k_radius}},
            {"capsules", voile::CapsuleCollider{.from = {-0.2f, y, 0}, .to = {0.2f, y, 0}, .radius = k_radius},
             voile::CapsuleCollider{.from = {-0.1f, -y, -0.1f}, .to = {0.1f, -y, 0.1f}, .radius = k_radius}},
            {"meshes", mesh_ball(y), mesh_ball(-y)},
            {"a ball and the ground", voile::SphereCollider{.center = {0, y, 0}, .radius = k_radius},
             voile::PlaneCollider{.offset = -0.003f}, false}};
}

// Boxes, turned about the vertical and tilted against each other, rad.
Jaws boxes(bool meshes, float turn, float tilt)
{
    const float y = k_open + k_radius;
    const auto box = [&](float height, float side) -> voile::Collider
    {
        const glm::mat4 pose = glm::rotate(glm::rotate(tests::moved({0, height, 0}), turn, glm::vec3(0, 1, 0)),
                                           side * tilt, glm::vec3(1, 0, 0));
        if (!meshes)
            return voile::BoxCollider{.min = glm::vec3(-k_radius), .max = glm::vec3(k_radius), .transform = pose};
        static const voile::engine::Mesh cube = voile::engine::make_box(glm::vec3(-k_radius), glm::vec3(k_radius));
        voile::MeshCollider mesh = tests::collider(cube);
        mesh.transform = pose;
        return mesh;
    };
    return {"boxes", box(y, 1), box(-y, -1)};
}

struct Pinched
{
    float fastest = 0; // m/s
    float stretch = 0;
    uint32_t most_inside = 0;
    voile::IntersectionCounts end;
    uint32_t inside_at_end = 0;
};

// The solids overlap by `overlap` (m) for 8 of 40 frames.
Pinched pinch(const Jaws& jaws, float overlap, voile::Integrator integrator)
{
    tests::IntersectionHarness harness;
    voile::GridCloth grid = tests::flat_sheet(12, 0.22f, 0);
    grid.transform = glm::rotate(tests::moved({0.003f, 0.001f, 0.002f}), 0.3f, glm::vec3(0, 1, 0));
    grid.integrator = integrator;
    const voile::ClothId cloth = voile::engine::take(harness.solver.add_cloth(grid));
    const auto add = [&](const voile::Collider& collider)
    { return voile::engine::take(harness.solver.add_collider(collider)); };
    const voile::ColliderId upper = add(jaws.upper);
    const voile::ColliderId lower = add(jaws.lower);
    harness.upload();
    Pinched result;
    for (int frame = 0; frame < 40; ++frame)
    {
        const int closed = std::min({frame + 1, 12, std::max(30 - frame, 0)});
        const float depth = (k_open + (jaws.lower_moves ? 0.5f : 1.f) * overlap) * static_cast<float>(closed) / 12;
        voile::engine::take(harness.solver.move_collider(upper, tests::moved({0, -depth, 0})));
        if (jaws.lower_moves)
            voile::engine::take(harness.solver.move_collider(lower, tests::moved({0, depth, 0})));
        harness.step({.gravity = glm::vec3(0)});
        const voile::Statistics statistics = harness.statistics();
        result.most_inside = std::max(result.most_inside, statistics.penetrating_vertices);
        result.stretch = std::max(result.stretch, statistics.max_stretch);
        result.inside_at_end = statistics.penetrating_vertices;
        result.fastest = std::max(result.fastest, tests::fastest(harness.velocities(cloth)));
    }
    result.end = harness.counts();
    return result;
}

} // namespace

// The exit along the cloth's normal led all through one of them, and vertices that had no room kept the velocity that
// springs gave them.
TEST_CASE("solids that close on a sheet hold it where it is, and release it when they part")
{
    const std::vector<Jaws> all = jaws();
    for (const Jaws& each : all)
    {
        const auto turn = &each - all.data();
        const float overlap = turn % 2 == 0 ? 0.02f : 0;
        const bool rk4 = turn >= 2;
        CAPTURE(each.name);
        CAPTURE(overlap);
        CAPTURE(rk4);
        const Pinched pinched = pinch(each, overlap, rk4 ? voile::Integrator::rk4 : voile::Integrator::verlet);
        CHECK((pinched.most_inside > 0) == (overlap > 0));
        CHECK(pinched.fastest < (overlap > 0 ? 10 : 2));       // measured: 6.4 and 0.95; before 132 and 20
        CHECK(pinched.stretch < (overlap > 0 ? 0.8f : 0.05f)); // 0.40 and 0.025
        CHECK(pinched.inside_at_end == 0);
        CHECK(pinched.end.collider_pairs == 0);
    }
}

// Cloth around the edges of boxes that had closed on it was taken for cloth that belongs there, and held within them:
// in 8 of 16 such scenes, by up to 41 pairs.
TEST_CASE("boxes that close on a sheet leave none of their edges in it when they part, in all scenes but two")
{
    int scenes_with_pairs = 0;
    uint32_t most_pairs = 0;
    constexpr glm::vec2 k_turns[]{{0, 0}, {0.4f, 0}, {0, 0.1f}, {0.4f, 0.1f}};
    for (const bool meshes : {false, true})
        for (const glm::vec2& turned : k_turns)
        {
            const bool touch = meshes != ((&turned - k_turns) % 2 == 1); // in turn: they overlap otherwise
            const float overlap = touch ? 0 : 0.005f;
            CAPTURE(meshes);
            CAPTURE(turned.x);
            CAPTURE(turned.y);
            CAPTURE(overlap);
            const Pinched pinched = pinch(boxes(meshes, turned.x, turned.y), overlap, voile::Integrator::verlet);
            CHECK(pinched.most_inside > 0);
            CHECK(pinched.inside_at_end == 0);
            CHECK(pinched.fastest < 60);   // measured: 16, and 37 on an H200
            CHECK(pinched.stretch < 1.3f); // 0.64
            scenes_with_pairs += pinched.end.collider_pairs > 0 ? 1 : 0;
            most_pairs = std::max(most_pairs, pinched.end.collider_pairs);
        }
    CHECK(scenes_with_pairs <= 2); // the meshes that only touch, not turned; on an H200 another one
    CHECK(most_pairs <= 8);
}
