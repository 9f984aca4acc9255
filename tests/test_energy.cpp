// Energy balance: the total energy of a cloth never exceeds what it had at the start and what the world put into it.
#include "energy_balance.hpp"
#include "random_cloths.hpp"

#include "cloth/fabrics.hpp"

#include <string>

namespace
{

using cloth::Integrator;
using tests::ClothHarness;

cloth::Fabric fabric(float density, float stiffness, float shear, float damping_ratio)
{
    cloth::Fabric f;
    f.areal_density = density;
    f.stretch_stiffness = {stiffness, stiffness};
    f.shear_stiffness = shear;
    f.damping_ratio = damping_ratio;
    f.air_drag_normal = f.air_drag_tangential = 0;
    return f;
}

// A free square of n x n vertices and 1 m, scaled in its plane, each vertex a little aside: nothing vanishes by
// symmetry.
cloth::Grid scaled_sheet(uint32_t n, float scale, const cloth::Fabric& material, Integrator integrator)
{
    cloth::Grid grid;
    grid.columns = grid.rows = n;
    grid.material = material;
    grid.transform = tests::tilted();
    grid.transform[0] *= scale;
    grid.transform[2] *= scale;
    grid.integrator = integrator;
    return grid;
}

struct Subject
{
    cloth::Grid grid;
    cloth::ClothId id{};
    double start = 0; // J
    double most = 0;
    double last = 0;
};

double energy_now(ClothHarness& harness, const Subject& s, const glm::dvec3& gravity)
{
    auto reference = tests::reference_of(s.grid);
    return tests::energy_of(harness, s.id, reference, gravity);
}

void advance(ClothHarness& harness, std::vector<Subject>& subjects, cloth::Step step, uint32_t frames)
{
    for (uint32_t frame = 0; frame < frames; ++frame)
    {
        harness.step(step);
        step.time += static_cast<double>(step.duration);
        for (Subject& s : subjects)
        {
            s.last = energy_now(harness, s, glm::dvec3(step.gravity));
            s.most = std::max(s.most, std::isfinite(s.last) ? s.last : 1e300);
        }
    }
}

void add(ClothHarness& harness, std::vector<Subject>& subjects)
{
    for (Subject& s : subjects)
    {
        s.id = engine::take(harness.solver.add_cloth(s.grid));
        auto reference = tests::reference_of(s.grid);
        s.start = reference.energy({.gravity = glm::dvec3(0)});
    }
    harness.upload();
}

} // namespace

TEST_CASE("squeezed and stretched cloth never has more energy than at its start")
{
    // Without damping there is nothing but the integrator to keep them from heating up.
    std::vector<Subject> subjects;
    for (const Integrator integrator : {Integrator::verlet, Integrator::rk4})
        for (const float damping : {0.f, 0.002f, 0.005f})
            for (const float scale : {0.7f, 0.5f, 0.2f, 1.1f, 2.f})
                subjects.push_back({scaled_sheet(16, scale, fabric(0.13f, 300, 100, damping), integrator)});
    ClothHarness harness;
    add(harness, subjects);
    advance(harness, subjects, {.gravity = glm::vec3(0)}, 60);
    for (const Subject& s : subjects)
    {
        CAPTURE(tests::describe(s.grid));
        CAPTURE(s.grid.transform[0].x);
        CHECK(s.most <= 1.001 * s.start); // measured: 1.0000
        CHECK(s.last < 0.5 * s.start);
    }
}

TEST_CASE("a crumpled free cloth stays where it is")
{
    std::vector<Subject> subjects;
    for (const Integrator integrator : {Integrator::verlet, Integrator::rk4})
        for (const float scale : {0.5f, 0.1f})
            subjects.push_back({scaled_sheet(12, scale, fabric(0.15f, 1000, 100, 0.02f), integrator)});
    ClothHarness harness;
    add(harness, subjects);
    advance(harness, subjects, {.gravity = glm::vec3(0)}, 60);
    for (const Subject& s : subjects)
    {
        CAPTURE(tests::describe(s.grid));
        CHECK(glm::length(tests::mean_velocity(harness, s.id)) < 1e-4);
    }
}

namespace
{

cloth::Fabric limited_cotton(float limit, float damping_ratio)
{
    cloth::Fabric f = cloth::cotton();
    f.strain_limit = limit;
    f.damping_ratio = damping_ratio;
    f.air_drag_normal = f.air_drag_tangential = 0;
    return f;
}

cloth::Grid sheet_at(float height, const cloth::Fabric& material)
{
    cloth::Grid grid;
    grid.columns = grid.rows = 16;
    grid.material = material;
    grid.transform[3] = {0, height, 0, 1};
    grid.integrator = Integrator::verlet;
    return grid;
}

} // namespace

TEST_CASE("a strain limit adds no energy to cotton that falls on a sphere")
{
    // A blow that the springs alone would answer with a stretch of 4 %.
    for (const float limit : {0.01f, 0.001f})
    {
        CAPTURE(limit);
        ClothHarness harness;
        engine::take(harness.solver.add_collider(cloth::PlaneCollider{}));
        engine::take(harness.solver.add_collider(cloth::SphereCollider{.center = {0, 0.3f, 0}, .radius = 0.3f}));
        std::vector<Subject> subjects{{sheet_at(0.7f, limited_cotton(limit, 0))}};
        add(harness, subjects);
        subjects[0].start = energy_now(harness, subjects[0], {0, -9.81, 0});
        advance(harness, subjects, {.air_density = 0}, 80);
        CHECK(subjects[0].most < 1.0002 * subjects[0].start); // unguarded, the limit made it 1.26 times as much
        CHECK(subjects[0].last < 0.7 * subjects[0].start);
    }
}
