// Stability of both integrators over the whole range of materials: random cloths, thrown, stretched, crumpled and blown
// at, in as few substeps as a step allows.
#include "support/random_cloths.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace
{

using tests::ClothHarness;
using tests::describe;
using tests::Draw;
using tests::elastic_energy;
using tests::Motion;

voile::GridCloth draw_grid(Draw& draw)
{
    voile::GridCloth grid;
    grid.columns = draw.count(2, 11);
    grid.rows = draw.count(2, 11);
    grid.width = draw.in(0.02f, 5);
    grid.depth = draw.in(0.02f, 5);
    grid.transform = draw_transform(draw, 0.02f, 4); // crumpled to a fiftieth or stretched to four times
    grid.velocity = draw.uniform(0, 60) * draw.direction();
    grid.material = draw_any_material(draw);
    grid.integrator = draw_integrator(draw);
    if (draw.chance(0.3))
        grid.pins = {0, grid.columns - 1};
    return grid;
}

double elastic_energy(const voile::GridCloth& grid)
{
    voile::GridCloth raw = grid;
    if (const auto* fabric = std::get_if<voile::Fabric>(&grid.material))
        raw.material = voile::make_material(*fabric, grid.width / static_cast<float>(grid.columns - 1),
                                            grid.depth / static_cast<float>(grid.rows - 1));
    reference::Cloth reference(raw);
    std::fill(reference.state.v.begin(), reference.state.v.end(), glm::dvec3(0));
    return reference.energy({.gravity = glm::dvec3(0)}); // an affine image of a grid has no curvature
}

struct Subject
{
    voile::ClothId id;
    double elastic = 0; // J, at full stiffness
    double bound = 0;   // J
    std::string name;
    double furthest = 0;
};

} // namespace

TEST_CASE("no cloth blows up, whatever its material and however few its substeps")
{
    Draw draw(2024);
    const tests::ClothMesh shapes[] = {tests::jittered_sheet(7, 6), tests::torus(9, 7), tests::tetrahedron()};
    for (int round = 0; round < 12; ++round)
    {
        CAPTURE(round);
        ClothHarness harness;
        std::vector<Subject> subjects;
        for (int i = 0; i < 4; ++i)
        {
            const voile::GridCloth grid = draw_grid(draw);
            subjects.push_back({voile::engine::take(harness.solver.add_cloth(grid)), elastic_energy(grid), 0,
                                "grid " + describe(grid)});
        }
        for (const tests::ClothMesh& shape : shapes)
        {
            const voile::MeshCloth mesh = draw_mesh(draw, shape);
            subjects.push_back({voile::engine::take(harness.solver.add_cloth(mesh)), elastic_energy(mesh), 0,
                                "mesh " + describe(mesh)});
        }
        harness.upload();
        voile::Step step = draw_step(draw);
        CAPTURE(step.max_substeps);
        for (Subject& s : subjects)
        {
            const Motion start = motion_of(harness, s.id);
            const voile::Stability stability = harness.solver.stability(s.id, step);
            const bool softened = stability.stiffness_scale < 1 || stability.damping_scale < 1;
            CHECK(softened == (stability.needed > step.max_substeps));
            CHECK(stability.used <= step.max_substeps);
            s.bound = energy_bound(start, static_cast<double>(stability.stiffness_scale) * s.elastic, step);
        }
        for (int i = 0; i < 30; ++i)
        {
            harness.step(step);
            step.time += static_cast<double>(step.duration);
            for (Subject& s : subjects)
            {
                const Motion now = motion_of(harness, s.id);
                s.furthest = std::max(s.furthest, now.finite ? now.energy / s.bound : 1e300);
            }
        }
        for (const Subject& s : subjects)
        {
            CAPTURE(s.name);
            CHECK(s.furthest < 1);
        }
    }
}

TEST_CASE("damping of springs folded into one line is as stable as in a plane")
{
    // On a flat sheet the damping of rows and columns acts in two directions. Folded into one line in both directions
    // it acts twice as strong in one. Stiffness is along the rows only and does not grow.
    ClothHarness harness;
    std::vector<voile::ClothId> ids;
    for (const auto integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
    {
        voile::GridCloth grid;
        grid.columns = grid.rows = 9;
        grid.transform[0] = {0.6f, 0.8f, 0, 0};
        grid.transform[2] = {0.222f, 0.296f, 1e-5f, 0}; // parallel axes are refused
        grid.velocity = {3, 4, 1};
        grid.pins = {0, 40};
        voile::Material material;
        material.springs.structural_warp = {100, 20};
        material.springs.structural_weft = {0, 20};
        material.springs.shear = {0, 20};
        grid.material = material;
        grid.integrator = integrator;
        ids.push_back(voile::engine::take(harness.solver.add_cloth(grid)));
    }
    harness.upload();
    const voile::Step step{.max_substeps = 16};
    CHECK(harness.solver.stability(ids[0], step).damping_scale < 1);
    for (const voile::ClothId id : ids)
        CHECK(motion_of(harness, id).energy > 0.1);
    harness.step(step, 60);
    for (const voile::ClothId id : ids)
    {
        const Motion now = motion_of(harness, id);
        CHECK(now.finite);
        // It started with sqrt(26) m/s and falls for a second.
        CHECK(now.energy < 0.5 * now.mass * std::pow(std::sqrt(26) + 9.81, 2));
    }
}
