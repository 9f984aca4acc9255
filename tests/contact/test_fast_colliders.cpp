// Colliders that are driven through a sheet: no edge of either passes through the other. Intersections are counted
// exactly, on the device.
#include "support/collider_scenes.hpp"
#include "support/hard_shapes.hpp"
#include "support/intersection_harness.hpp"

#include "voile/fabrics.hpp"

#include <random>

namespace
{

constexpr float k_frame = 1.f / 60;
constexpr float k_thin = 0.001f; // m
constexpr float k_speeds[] = {5, 100};
constexpr float k_slow_speeds[] = {2, 5}; // at which cloth that collides with itself is not left behind

// A mesh above the sheet.
struct Driven
{
    const char* name;
    voile::engine::Mesh mesh;
    glm::mat4 start;
};

voile::engine::Mesh needle_that_points_down()
{
    constexpr float k_length = 0.5f;
    voile::engine::Mesh mesh = tests::needle(k_length, 0.02f);
    for (glm::vec3& p : mesh.positions)
        p.y = -p.y;
    for (glm::uvec3& triangle : mesh.triangles)
        std::swap(triangle.x, triangle.y);
    for (glm::vec3& p : mesh.positions)
        p.y += k_length;
    return mesh;
}

// Needles on a square of 0.9 m that point up, with tips at 0 at most, and how it meets cloth above it.
struct Brush
{
    uint32_t side; // needles in a row
    bool uneven;   // a few needles are much longer than the others
    float tilt;    // of all of it
    float speed;   // m/s
    uint32_t frames;
    voile::Integrator integrator;
};

voile::engine::Mesh mesh_of(const Brush& brush)
{
    constexpr float k_width = 0.9f;
    constexpr float k_height = 0.1f;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> within(0, 1);
    voile::engine::Mesh result;
    for (uint32_t i = 0; i < brush.side * brush.side; ++i)
    {
        const glm::vec2 cell =
            glm::vec2(i % brush.side, i / brush.side) + 0.5f + 0.3f * glm::vec2(within(random), within(random));
        const glm::vec2 foot = k_width * (cell / static_cast<float>(brush.side) - 0.5f);
        const float part = within(random);
        const voile::engine::Mesh needle =
            tests::needle(k_height * (brush.uneven ? part * part * part : 0.7f + 0.3f * part), 0.008f);
        const auto first = static_cast<uint32_t>(result.positions.size());
        for (const glm::vec3& p : needle.positions)
            result.positions.push_back(p + glm::vec3(foot.x, -k_height, foot.y));
        for (const glm::uvec3& triangle : needle.triangles)
            result.triangles.push_back(triangle + first);
    }
    return result;
}

std::vector<Driven> driven()
{
    const glm::mat4 tilted = glm::rotate(tests::moved({0, 0.3f, 0}), 0.6f, glm::normalize(glm::vec3(1, 0.3f, 1)));
    return {
        {"needle", needle_that_points_down(), tests::moved({0, 0.05f, 0})},
        {"box on its corner", voile::engine::make_box(glm::vec3(-0.1f), glm::vec3(0.1f)), tilted},
        {"bar", voile::engine::make_box({-0.3f, -0.01f, -0.005f}, {0.3f, 0.01f, 0.005f}), tests::moved({0, 0.1f, 0})},
        {"strip", tests::triangle_pair(0.02f), tests::moved({0, 0.1f, 0})}};
}

// Colliders with a formula above the sheet.
std::vector<voile::Collider> solids()
{
    return {voile::BoxCollider{.min = glm::vec3(-0.1f),
                               .max = glm::vec3(0.1f),
                               .transform = glm::rotate(tests::moved({0, 0.3f, 0}), 0.6f, glm::vec3(1, 0, 0))},
            voile::CapsuleCollider{.from = {-0.2f, 0.05f, 0}, .to = {0.2f, 0.07f, 0.03f}, .radius = 0.01f},
            voile::SphereCollider{.center = {0, 0.06f, 0}, .radius = 0.02f}};
}

// Pinned at its corners.
voile::GridCloth sheet()
{
    voile::GridCloth grid;
    grid.columns = grid.rows = 24;
    grid.width = grid.depth = 1.5f;
    grid.transform = glm::rotate(tests::moved({0.013f, 0, 0.007f}), 0.3f, glm::vec3(0, 1, 0)); // parallel to no axis
    grid.integrator = voile::Integrator::verlet;
    voile::Fabric fabric = voile::cotton();
    fabric.thickness = k_thin;
    grid.material = fabric;
    const uint32_t last = grid.columns - 1;
    grid.pins = {0, last, last * grid.columns, grid.columns * grid.columns - 1};
    return grid;
}

// The vertices as they are given.
std::vector<glm::vec3> lowered(const Driven& shape, float distance)
{
    const glm::vec3 down(glm::inverse(shape.start) * glm::vec4(0, -distance, 0, 0));
    std::vector<glm::vec3> positions = shape.mesh.positions;
    for (glm::vec3& p : positions)
        p += down;
    return positions;
}

// `move` moves the collider down by a distance, m.
template <typename Move>
void drive(const voile::Collider& collider, float speed, bool self_collision, const Move& move)
{
    CAPTURE(speed);
    CAPTURE(self_collision);
    tests::IntersectionHarness harness;
    voile::GridCloth grid = sheet();
    grid.self_collision = self_collision;
    const voile::ClothId cloth = voile::engine::take(harness.solver.add_cloth(grid));
    const voile::ColliderId id = voile::engine::take(harness.solver.add_collider(collider));
    harness.upload();
    float lowest = 0;
    const uint32_t frames = speed < 4 ? 8 : speed < 10 ? 5 : 2;
    for (uint32_t frame = 1; frame <= frames; ++frame)
    {
        REQUIRE(move(harness.solver, id, speed * k_frame * static_cast<float>(frame)));
        harness.step({.duration = k_frame, .gravity = glm::vec3(0), .air_density = 0});
        CHECK(harness.statistics().penetrating_vertices == 0);
        const voile::IntersectionCounts counts = harness.counts();
        // Guards end 20 um from the collider, where rounding decides what is counted, 3 m from the origin.
        CHECK(counts.collider_pairs == counts.uncertain_pairs);
        CHECK((counts.cloth_pairs == 0 || !self_collision));
        for (const glm::vec4& p : harness.positions(cloth))
            lowest = std::min(lowest, p.y);
    }
    CHECK(lowest < -0.02f); // it was hit
}

bool lower(voile::Solver& solver, voile::ColliderId id, float distance)
{
    return static_cast<bool>(solver.move_collider(id, tests::moved({0, -distance, 0})));
}

void drive_rigid(const Driven& shape, float speed, bool self_collision)
{
    CAPTURE(shape.name);
    voile::MeshCollider mesh = tests::collider(shape.mesh);
    mesh.transform = shape.start;
    drive(mesh, speed, self_collision, lower);
}

void drive_deforming(const Driven& shape, float speed)
{
    CAPTURE(shape.name);
    voile::MeshCollider mesh = tests::deforming(shape.mesh);
    mesh.transform = shape.start;
    drive(mesh, speed, false,
          [&](voile::Solver& solver, voile::ColliderId id, float distance)
          { return static_cast<bool>(solver.deform_collider(id, lowered(shape, distance))); });
}

} // namespace

TEST_CASE("colliders that are driven through a sheet at up to 100 m/s take it along")
{
    for (const float speed : k_speeds)
    {
        for (const Driven& shape : driven())
            drive_rigid(shape, speed, false);
        for (const voile::Collider& solid : solids())
            drive(solid, speed, false, lower);
    }
}

TEST_CASE("colliders that are driven into a sheet that collides with itself take it along")
{
    size_t run = 0;
    const auto speed = [&run] { return k_slow_speeds[run++ % std::size(k_slow_speeds)]; }; // in turn
    for (const Driven& shape : driven())
        drive_rigid(shape, speed(), true);
    for (const voile::Collider& solid : solids())
        drive(solid, speed(), true, lower);
}

// A flat mesh has no features where it was added. Folded along its middle, it lifts a sheet without vertices near the
// fold.
TEST_CASE("a sheet lies on the edge that a flat mesh folds into")
{
    tests::IntersectionHarness harness;
    voile::GridCloth grid = sheet();
    grid.columns = grid.rows = 8;
    grid.transform = tests::moved({0, 0.005f, 0}); // no row of vertices is above the mesh
    grid.pins = {0, 7, 56, 63};
    const voile::ClothId cloth = voile::engine::take(harness.solver.add_cloth(grid));
    const auto folded = [](float height)
    {
        std::vector<glm::vec3> positions;
        for (const float z : {-0.1f, 0.f, 0.1f})
            for (const float x : {-1.f, 1.f})
                positions.emplace_back(x, z == 0 ? height : 0, z);
        return positions;
    };
    const std::vector<glm::vec3> flat = folded(0);
    const std::vector<glm::uvec3> triangles{{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}};
    voile::MeshCollider mesh;
    mesh.positions = flat;
    mesh.triangles = triangles;
    mesh.deforms = true;
    const voile::ColliderId id = voile::engine::take(harness.solver.add_collider(mesh));
    harness.upload();
    for (uint32_t frame = 1; frame <= 10; ++frame)
    {
        REQUIRE(harness.solver.deform_collider(id, folded(0.01f * static_cast<float>(frame))));
        harness.step({.duration = k_frame, .gravity = glm::vec3(0), .air_density = 0});
        CHECK(harness.counts().collider_pairs == 0);
    }
    float highest = 0;
    for (const glm::vec4& p : harness.positions(cloth))
        highest = std::max(highest, p.y);
    CHECK(highest > 0.05f); // it was lifted
}

TEST_CASE("deforming colliders that are driven through a sheet at up to 100 m/s take it along")
{
    for (const Driven& shape : driven())
        for (const float speed : k_speeds)
            drive_deforming(shape, speed);
}

// Each vertex of the sheet is near more needles than its list has room for, or in a box with them, and a workgroup near
// tens of thousands of features. Where loops of a kernel end after a number of rounds, as on lavapipe, features must be
// found in few of them.
TEST_CASE("a brush of thousands of needles that rises into a coarse sheet cuts none of it")
{
    using voile::Integrator;
    for (const Brush& brush :
         {Brush{44, false, 0, 5, 3, Integrator::verlet}, Brush{52, false, 0, 5, 3, Integrator::verlet},
          Brush{54, true, 0.8f, 1, 1, Integrator::rk4}})
    {
        CAPTURE(brush.side);
        const glm::mat4 tilted = glm::rotate(glm::mat4(1), brush.tilt, glm::normalize(glm::vec3(1, 0.2f, 0.7f)));
        tests::IntersectionHarness harness;
        voile::GridCloth grid = sheet();
        grid.columns = grid.rows = 6;
        grid.width = grid.depth = 0.8f;
        grid.transform = tilted * tests::moved({0, 0.005f, 0});
        grid.pins = {};
        grid.material = voile::Fabric{.thickness = 0.003f};
        grid.integrator = brush.integrator;
        (void)voile::engine::take(harness.solver.add_cloth(grid));
        voile::engine::Mesh mesh = mesh_of(brush);
        tests::transform_mesh(mesh, tilted); // in the collider's space nothing is along an axis
        const voile::ColliderId id = voile::engine::take(harness.solver.add_collider(tests::collider(mesh)));
        harness.upload();
        for (uint32_t frame = 1; frame <= brush.frames; ++frame)
        {
            const float height = brush.speed * k_frame * static_cast<float>(frame);
            REQUIRE(harness.solver.move_collider(id, tests::moved(tilted * glm::vec4(0, height, 0, 0))));
            harness.step({.duration = k_frame, .gravity = glm::vec3(0), .air_density = 0});
            CHECK(harness.counts().collider_pairs == 0);
        }
    }
}
