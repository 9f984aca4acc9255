// Energy balance: the total energy of a cloth never exceeds its initial energy plus the work done on it.
#include "support/energy_balance.hpp"
#include "support/random_cloths.hpp"

#include "voile/fabrics.hpp"

#include <string>

namespace
{

using tests::ClothHarness;
using voile::Integrator;

voile::Fabric fabric(float density, float stiffness, float shear, float damping_ratio)
{
    voile::Fabric f;
    f.areal_density = density;
    f.stretch_stiffness = {stiffness, stiffness};
    f.shear_stiffness = shear;
    f.damping_ratio = damping_ratio;
    f.air_drag_normal = f.air_drag_tangential = 0;
    return f;
}

// A free square of n x n vertices and 1 m, scaled in its plane, each vertex slightly displaced: symmetry cancels
// nothing.
voile::GridCloth scaled_sheet(uint32_t n, float scale, const voile::Fabric& material, Integrator integrator)
{
    voile::GridCloth grid;
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
    voile::GridCloth grid;
    voile::ClothId id{};
    double start = 0; // J
    double most = 0;
    double last = 0;
};

double energy_now(ClothHarness& harness, const Subject& s, const glm::dvec3& gravity)
{
    auto reference = tests::reference_of(s.grid);
    return tests::energy_of(harness, s.id, reference, gravity);
}

void advance(ClothHarness& harness, std::vector<Subject>& subjects, voile::Step step, uint32_t frames)
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
        s.id = voile::engine::take(harness.solver.add_cloth(s.grid));
        auto reference = tests::reference_of(s.grid);
        s.start = reference.energy({.gravity = glm::dvec3(0)});
    }
    harness.upload();
}

} // namespace

TEST_CASE("squeezed and stretched cloth never exceeds its initial energy")
{
    // Without damping, only the integrator keeps them from gaining energy.
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

TEST_CASE("the center of mass of a crumpled free cloth stays at rest")
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

voile::Fabric limited_cotton(float limit, float damping_ratio)
{
    voile::Fabric f = voile::cotton();
    f.strain_limit = limit;
    f.damping_ratio = damping_ratio;
    f.air_drag_normal = f.air_drag_tangential = 0;
    return f;
}

voile::GridCloth sheet_at(float height, const voile::Fabric& material)
{
    voile::GridCloth grid;
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
    ClothHarness harness;
    voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{}));
    voile::engine::take(harness.solver.add_collider(voile::SphereCollider{.center = {0, 0.3f, 0}, .radius = 0.3f}));
    std::vector<Subject> subjects{{sheet_at(0.7f, limited_cotton(0.01f, 0))},
                                  {sheet_at(0.7f, limited_cotton(0.001f, 0))}};
    add(harness, subjects);
    for (Subject& s : subjects)
        s.start = energy_now(harness, s, {0, -9.81, 0});
    double worst = 0;
    for (int frame = 0; frame < 60; ++frame)
    {
        advance(harness, subjects, {.air_density = 0}, 1);
        worst = std::max(worst, static_cast<double>(harness.statistics().max_stretch));
    }
    CHECK(worst < 0.05); // measured: 0.033 with 0.1 %, 0.030 with 1 %
    for (const Subject& s : subjects)
    {
        CHECK(s.most < 1.0002 * s.start); // unguarded, the limit gave 1.26 times the energy
        CHECK(s.last < 0.7 * s.start);
    }
}

namespace
{

// A sheet between two rows of pins, stretched by `stretch` along its rows.
voile::GridCloth stretched_between_pins(float stretch, float limit, Integrator integrator)
{
    voile::GridCloth grid = sheet_at(1, limited_cotton(limit, 0.02f));
    grid.columns = grid.rows = 10;
    grid.transform[0] *= 1 + stretch;
    grid.integrator = integrator;
    for (uint32_t row = 0; row < grid.rows; ++row)
    {
        grid.pins.push_back(row * grid.columns);
        grid.pins.push_back(row * grid.columns + grid.columns - 1);
    }
    return grid;
}

double kinetic_energy(ClothHarness& harness, voile::ClothId id)
{
    return tests::motion_of(harness, id).energy;
}

} // namespace

TEST_CASE("cloth between pins too far apart comes to rest, whatever its tethers and its strain limit")
{
    std::vector<Subject> subjects;
    for (const Integrator integrator : {Integrator::verlet, Integrator::rk4})
        for (const float limit : {0.f, 0.01f, 0.f, 0.01f})
            subjects.push_back({stretched_between_pins(0.1f, limit, integrator)});
    ClothHarness harness;
    add(harness, subjects);
    for (size_t i = 0; i < subjects.size(); ++i)
        if (i % 4 < 2)
            voile::engine::take(harness.solver.set_tethers(subjects[i].id, voile::Tethers{}));
    harness.upload();
    for (Subject& s : subjects)
        s.start = energy_now(harness, s, {0, -9.81, 0});
    advance(harness, subjects, {}, 90);
    for (size_t i = 0; i < subjects.size(); ++i)
    {
        CAPTURE(i);
        CHECK(subjects[i].most < 1.0001 * subjects[i].start);  // tethers that snap back: 15 times as much
        CHECK(kinetic_energy(harness, subjects[i].id) < 1e-3); // J, of 10 J; 17 J after snapping back
    }
}

namespace
{

// J, relative to the cloth in the origin's plane.
double work_of_gravity(ClothHarness& harness, voile::ClothId id)
{
    double work = 0;
    for (const glm::vec4& p : harness.positions(id))
        work -= p.w > 0 ? 9.81 * static_cast<double>(p.y) / static_cast<double>(p.w) : 0;
    return std::max(work, 0.);
}

} // namespace

TEST_CASE("cloth squeezed between two capsules comes to rest")
{
    for (const Integrator integrator : {Integrator::verlet, Integrator::rk4})
    {
        CAPTURE(int(integrator));
        voile::GridCloth grid;
        grid.columns = grid.rows = 7;
        grid.width = grid.depth = 0.28f;
        voile::Fabric fabric = voile::denim();
        fabric.bending_stiffness = 8.06e-5f; // the value that showed the fault
        grid.material = fabric;
        grid.integrator = integrator;
        grid.transform[0] /= 6;
        grid.transform[2] /= 6;
        ClothHarness harness;
        voile::engine::take(harness.solver.add_collider(
            voile::CapsuleCollider{.from = {-0.5f, 0.1f, 0}, .to = {0.5f, 0.1f, 0}, .radius = 0.09f}));
        voile::engine::take(harness.solver.add_collider(
            voile::CapsuleCollider{.from = {0, -0.1f, -0.5f}, .to = {0, -0.1f, 0.5f}, .radius = 0.09f}));
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        harness.upload();
        harness.step({}, 120);
        // J, of 65 J at the start; measured: 8e-4 and 1.5e-3. It may have slipped out from between them and fall.
        CHECK(kinetic_energy(harness, id) - work_of_gravity(harness, id) < 3e-3);
    }
}

TEST_CASE("cloth whose density changes by a factor of 10,000 in every frame stays finite")
{
    std::vector<Subject> subjects;
    for (const Integrator integrator : {Integrator::verlet, Integrator::rk4})
        for (const float limit : {0.f, 0.02f})
        {
            voile::GridCloth grid = sheet_at(2, limited_cotton(limit, 0.02f));
            grid.columns = grid.rows = 8;
            grid.integrator = integrator;
            grid.pins = {0, 7};
            subjects.push_back({grid});
        }
    ClothHarness harness;
    add(harness, subjects);
    for (int frame = 0; frame < 60; ++frame)
    {
        CAPTURE(frame);
        for (const Subject& s : subjects)
        {
            auto fabric = std::get<voile::Fabric>(s.grid.material);
            fabric.areal_density = frame % 2 == 0 ? 1e-2f : 1e2f;
            voile::engine::take(harness.solver.set_material(s.id, fabric));
        }
        harness.step({});
        for (size_t i = 0; i < subjects.size(); ++i)
        {
            CAPTURE(i);
            REQUIRE(tests::motion_of(harness, subjects[i].id).finite);
        }
    }
}
