// The lists of triangles that vertices keep between substeps: contact finds the same with and without them.
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"
#include "support/hard_shapes.hpp"

#include "voile/mesh_checks.hpp"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using tests::ClothHarness;

namespace
{

constexpr float k_substep = 1.f / 4096; // s; its multiples are exact
constexpr uint32_t k_substeps = 64;
constexpr uint32_t k_other_layer = 2;

struct Shot
{
    float thickness; // m
    float speed;     // m/s, upward; half of it sideways
    uint32_t rings;  // of the lump: its edges are about 0.5 m / rings long
};

class Scene : public ClothHarness
{
public:
    explicit Scene(const Shot& shot) : ClothHarness({.depenetration = false}), mesh_(tests::lump_with_ears(shot.rings))
    {
        voile::GridCloth grid = tests::flat_sheet(24, 0.45f, -0.325f); // under the lump: its ears are above
        grid.transform = grid.transform * glm::mat4_cast(glm::quat(glm::vec3(0.05f, 0.7f, 0.02f)));
        grid.velocity = {0.5f * shot.speed, shot.speed, 0};
        tests::fabric_of(grid).thickness = shot.thickness;
        tests::fabric_of(grid).areal_density *= 1.4f; // so that k_substeps are enough
        id = voile::engine::take(solver.add_cloth(grid));
        (void)voile::engine::take(solver.add_collider(tests::collider(mesh_)));
        upload();
    }

    // Invalidates all lists by an upload.
    void forget_lists()
    {
        (void)voile::engine::take(solver.add_collider(voile::SphereCollider{.radius = 0.1f, .layers = k_other_layer}));
        upload();
    }

    voile::ClothId id;

private:
    voile::engine::Mesh mesh_;
};

// The largest distance between corresponding vertices.
float difference(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b)
{
    float most = 0;
    for (size_t i = 0; i < a.size(); ++i)
        most = std::max(most, a[i] == b[i] ? 0 : glm::distance(a[i], b[i]));
    return most;
}

// Runs the same shot with lists that persist and with lists that serve one substep. `rounding`: m, the allowed
// difference.
voile::Statistics compare(const Shot& shot, float rounding)
{
    CAPTURE(shot.thickness);
    CAPTURE(shot.rings);
    Scene kept(shot);
    Scene fresh(shot);
    REQUIRE(kept.solver.stable_substeps(k_substep * k_substeps) <= k_substeps);
    voile::Statistics most;
    constexpr uint32_t k_substeps_per_step = 32;
    for (uint32_t step = 0; step < k_substeps / k_substeps_per_step; ++step)
    {
        kept.step({.duration = k_substeps_per_step * k_substep, .substeps = k_substeps_per_step});
        for (uint32_t i = 0; i < k_substeps_per_step; ++i)
        {
            fresh.forget_lists();
            fresh.step({.duration = k_substep, .substeps = 1});
        }
        CHECK(difference(kept.positions(kept.id), fresh.positions(fresh.id)) <= rounding);
        CHECK(difference(kept.velocities(kept.id), fresh.velocities(fresh.id)) <= rounding / k_substep);
        const voile::Statistics now = kept.statistics();
        most.contacts = std::max(most.contacts, now.contacts);
        most.overflowing_vertices = std::max(most.overflowing_vertices, now.overflowing_vertices);
    }
    return most;
}

} // namespace

TEST_CASE("lists of near triangles change no bit of contact")
{
    const voile::Statistics most = compare({.thickness = 0.005f, .speed = 3, .rings = 48}, 0);
    CHECK(most.contacts > 20);
    CHECK(most.overflowing_vertices == 0);
}

TEST_CASE("an overflowed list of near triangles loses no contact")
{
    // The kernel has two instances of the same code, with and without a traversal in every substep. A compiler may
    // round one in another order, so that it touches a substep earlier (on an H200: 5e-6 m).
    const voile::Statistics most = compare({.thickness = 0.03f, .speed = 3, .rings = 160}, 1e-5f);
    CHECK(most.contacts > 20);
    CHECK(most.overflowing_vertices > 0);
}

// A ball rises by 11 cm and bulges within one step, past the lists of several refreshes, or in a step per substep, each
// with lists of its own. Verlet's steps differ by more than their lists.
TEST_CASE("lists of near triangles that deform lose no contact")
{
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, -0.25f, 0}, 0.2f, 64);
    const auto rise = [&](voile::Integrator integrator, uint32_t steps)
    {
        ClothHarness harness({.depenetration = false});
        voile::GridCloth grid = tests::flat_sheet(24, 0.45f, 0);
        grid.integrator = integrator;
        tests::fabric_of(grid).areal_density *= 2.5f; // so that k_substeps are enough for Verlet
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        const voile::ColliderId with = voile::engine::take(harness.solver.add_collider(tests::deforming(ball)));
        harness.upload();
        for (uint32_t step = 1; step <= steps; ++step)
        {
            const float part = static_cast<float>(step) / static_cast<float>(steps);
            std::vector<glm::vec3> risen = ball.positions;
            for (glm::vec3& p : risen)
                p += part * glm::vec3(0.02f, 0.11f, 0.3f * p.z);
            REQUIRE(harness.solver.deform_collider(with, risen));
            const uint32_t substeps = k_substeps / steps;
            harness.step({.duration = static_cast<float>(substeps) * k_substep, .substeps = substeps});
        }
        CHECK(harness.statistics().contacts > 20);
        CHECK(harness.statistics().penetrating_vertices == 0);
        return harness.positions(id);
    };
    const std::vector<glm::vec4> kept = rise(voile::Integrator::rk4, 1);
    CHECK(difference(kept, rise(voile::Integrator::rk4, k_substeps)) < 6e-7f); // measured: 1.2e-7
    (void)rise(voile::Integrator::verlet, 1);
}

// Hundreds of triangles lie within the thickness, but only few are nearer than resting cloth. A list can hold those.
TEST_CASE("cloth at rest that is far thicker than the triangles' edges has lists of near triangles")
{
    voile::engine::Mesh ball = voile::engine::make_sphere({0, 0, 0}, 0.3f, 240); // edges of 4 mm and less
    for (glm::vec3& p : ball.positions)
        p = glm::vec3(p.y, p.z - 0.3f, p.x); // moves its poles, where slivers are, to the side
    ClothHarness harness;
    voile::GridCloth grid = tests::flat_sheet(24, 0.3f, 0.031f);
    tests::fabric_of(grid).thickness = 0.03f;
    (void)voile::engine::take(harness.solver.add_cloth(grid));
    (void)voile::engine::take(harness.solver.add_collider(tests::collider(ball)));
    harness.upload();
    harness.step({}, 30);
    const voile::Statistics statistics = harness.statistics();
    CHECK(statistics.contacts > 100);
    CHECK(statistics.candidates > statistics.contacts);
    CHECK(statistics.overflowing_vertices == 0);
}

// The balls of all lists would have to be as wide as the collider's displacement per substep, with thousands of
// triangles. The next larger float exceeds the distances that such lists resolve.
TEST_CASE("a list of near triangles ends when its collider moves by hundreds of meters in a step")
{
    const voile::engine::Mesh lump = tests::lump_with_ears(160);
    ClothHarness harness({.feature_contact = false, .depenetration = false});
    voile::GridCloth grid = tests::flat_sheet(24, 0.45f, -0.325f); // within the thickness, so that lists are narrow
    tests::fabric_of(grid).thickness = 0.03f;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    const voile::ColliderId with = voile::engine::take(harness.solver.add_collider(tests::collider(lump)));
    harness.upload();
    const voile::Step still{.substeps = 10, .gravity = {0, 0, 0}};
    harness.step(still);
    CHECK(harness.statistics().candidates > 100);
    for (const float x : {400.f, 400.01f})
    {
        REQUIRE(harness.solver.move_collider(with, tests::moved({x, 0, 0})));
        harness.step(still);
    }
    const voile::Statistics after = harness.statistics();
    CHECK(after.candidates == 0);
    CHECK(after.nan_vertices == 0);
    CHECK(std::abs(harness.positions(id)[0].x + 0.225f) < 0.05f); // the cloth has not moved along
}

// The lists of resting cloth are old and were made for its former thickness.
TEST_CASE("cloth at rest that becomes thicker rises by the added thickness, on triangles outside its lists")
{
    const voile::engine::Mesh lump = tests::lump_with_ears(96);
    ClothHarness harness({.feature_contact = false});
    voile::GridCloth grid = tests::flat_sheet(24, 0.35f, -0.29f);
    grid.transform = tests::moved({0, -0.302f, 0});
    voile::Fabric& fabric = tests::fabric_of(grid);
    fabric.thickness = 0.004f;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    const voile::MeshCollider collider = tests::collider(lump);
    (void)voile::engine::take(harness.solver.add_collider(collider));
    harness.upload();
    const voile::Step pressed{.gravity = {0, 9.81f, 0}}; // upward, against the side without ears
    harness.step(pressed, 15);
    fabric.thickness = 0.0065f; // wider than a list's ball
    REQUIRE(harness.solver.set_material(id, fabric));
    harness.step(pressed);
    const voile::MeshDistance distance = voile::engine::take(voile::MeshDistance::create(collider));
    double nearest = 1;
    for (const glm::vec4& p : harness.positions(id))
        nearest = std::min(nearest, distance.nearest(glm::dvec3(p)).signed_distance);
    CHECK(nearest > 0.0065 - 1e-6);
    CHECK(nearest < 0.0075);
}
