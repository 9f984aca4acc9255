// Meshes as cloth: one step against the double-precision reference, both list layouts, a triangulated grid against a
// GridCloth, custom masses and materials. test_mesh_input.cpp tests the report of a mesh and the refused meshes.
#include "reference/mesh_reference.hpp"
#include "support/close_to.hpp"
#include "support/cloth_harness.hpp"
#include "support/cloth_meshes.hpp"

#include <algorithm>
#include <cmath>

namespace
{

using tests::ClothHarness;
using tests::ClothMesh;

const reference::Environment k_environment{.wind = {2, 1, -3}};

voile::Fabric fabric_of(voile::BendingModel model)
{
    voile::Fabric fabric;
    fabric.stretch_stiffness = {300, 500};
    // So stiff that bending forces are as large as stretching forces.
    fabric.bending_stiffness = model == voile::BendingModel::isometric ? 1e-2f : 1;
    fabric.damping_ratio = 0.1f;
    fabric.air_drag_tangential = 0.2f;
    fabric.bending_model = model;
    return fabric;
}

// Every fourth vertex of a moving mesh is pinned: after some steps all springs are stretched and all hinges folded.
voile::MeshCloth pulled(const ClothMesh& mesh, const voile::ClothMaterial& material)
{
    voile::MeshCloth cloth = mesh.cloth();
    cloth.transform = tests::tilted();
    cloth.transform[3] = {0.1f, 0.2f, -0.3f, 1}; // near the origin, where floats are finer
    cloth.velocity = {0.6f, -0.9f, 0.5f};
    cloth.material = material;
    for (uint32_t i = 1; i < mesh.positions.size(); i += 4)
        cloth.pins.push_back(i);
    return cloth;
}

struct State
{
    std::vector<glm::vec4> x;
    std::vector<glm::vec4> v;
    bool operator==(const State&) const = default;
};

reference::ClothState exact(const State& state)
{
    reference::ClothState result;
    for (size_t i = 0; i < state.x.size(); ++i)
    {
        result.x.emplace_back(state.x[i]);
        result.v.emplace_back(state.v[i]);
    }
    return result;
}

struct Run
{
    float h = 0; // s
    std::vector<State> before;
    std::vector<State> after; // one step later
};

// Adds all meshes to one solver: 10 ms of motion, then the step.
Run one_step(const std::vector<voile::MeshCloth>& meshes, voile::MeshLayout layout)
{
    voile::SolverOptions options;
    options.tuning.workgroup_size = 64;
    options.tuning.mesh_layout = layout;
    ClothHarness harness(options);
    std::vector<voile::ClothId> ids;
    for (const voile::MeshCloth& mesh : meshes)
        ids.push_back(voile::engine::take(harness.solver.add_cloth(mesh)));
    harness.upload();
    const auto states = [&]
    {
        std::vector<State> result;
        for (const voile::ClothId id : ids)
            result.push_back({harness.positions(id), harness.velocities(id)});
        return result;
    };
    Run run;
    run.h = 1e-2f / static_cast<float>(harness.solver.stable_substeps(1e-2f));
    harness.step({.duration = 1e-2f});
    run.before = states();
    harness.step({.duration = run.h, .substeps = 1, .wind = {2, 1, -3}});
    run.after = states();
    return run;
}

double largest(const std::vector<glm::dvec3>& values)
{
    double result = 0;
    for (const glm::dvec3& v : values)
        result = std::max(result, glm::length(v));
    return result;
}

void check_step(const voile::MeshCloth& mesh, const State& before, const State& after, double h)
{
    reference::MeshCloth reference(mesh);
    reference.state = exact(before);
    const auto still = reference.accelerations(reference.state, k_environment);
    reference.step(h, k_environment);
    // Positions are stored in float, after a step that adds less than a hundredth to them; measured: 0.7 of the bound.
    CHECK(tests::relative_error(after.x, reference.state.x) < 2 * std::exp2(-24));
    // Velocities: a position error of a stage, from differences of stored coordinates, changes a vertex's acceleration
    // by at most omega^2 times that error. Weights and rest lengths in float add errors of the same fraction of the
    // edges' length. Both errors are below 2^-24 of the coordinates; measured: a quarter of the bound.
    const double bound =
        std::exp2(-24) * (largest(reference.state.v) + h * reference.omega_squared() * largest(reference.state.x));
    double error = 0;
    for (size_t i = 0; i < after.v.size(); ++i)
        error = std::max(error, glm::distance(glm::dvec3(after.v[i]), reference.state.v[i]));
    CHECK(error < bound);
    CHECK(largest(still) > 3 * 9.81);         // inner forces exist (measured: at least 3.5 g),
    CHECK(bound < 0.05 * h * largest(still)); // and an error of a twentieth of them would show (measured: 0.013)
}

void check_steps(const std::vector<voile::MeshCloth>& meshes)
{
    const Run run = one_step(meshes, voile::MeshLayout::interleaved);
    CHECK(one_step(meshes, voile::MeshLayout::compact).after == run.after);
    for (size_t i = 0; i < meshes.size(); ++i)
    {
        CAPTURE(i);
        check_step(meshes[i], run.before[i], run.after[i], static_cast<double>(run.h));
    }
}

// Each mesh with springs and with isometric bending.
void check_fabrics(const std::vector<ClothMesh>& meshes)
{
    std::vector<voile::MeshCloth> cloths;
    for (const ClothMesh& mesh : meshes)
        for (const auto model : {voile::BendingModel::springs, voile::BendingModel::isometric})
            cloths.push_back(pulled(mesh, fabric_of(model)));
    check_steps(cloths);
}

// The depth of the last row's center.
double lowest_middle(ClothHarness& harness, voile::ClothId id, uint32_t columns, uint32_t rows)
{
    return -static_cast<double>(harness.positions(id)[size_t{columns} * (rows - 1) + columns / 2].y);
}

} // namespace

TEST_CASE("one step of an open mesh equals the double-precision reference at awkward sizes")
{
    // 4, 63, 64, 65 and 1225 vertices.
    check_fabrics({tests::jittered_sheet(2, 2), tests::jittered_sheet(9, 7), tests::jittered_sheet(8, 8),
                   tests::jittered_sheet(13, 5), tests::jittered_sheet(35, 35)});
}

TEST_CASE("one step of a closed mesh equals the double-precision reference")
{
    // 4, 63, 65 and 1200 vertices.
    check_fabrics({tests::tetrahedron(), tests::torus(9, 7), tests::torus(13, 5), tests::torus(40, 30)});
}

TEST_CASE("a mesh of a raw material has equal springs and equal masses")
{
    voile::Material material;
    material.vertex_mass = 0.02f;
    material.springs.structural_warp = {80, 0.1f};
    material.springs.bend_warp = {30, 0.05f};
    material.springs.shear = {1e4f, 0}; // a grid's parameter: unused here
    material.bending_stiffness = 5e-3f;
    material.bending_time = 1e-3f;
    material.linear_drag = 0.1f;
    material.air_drag_normal = 1;
    const ClothMesh open = tests::jittered_sheet(9, 7);
    const ClothMesh closed = tests::tetrahedron(); // opposite vertices that share an edge, springs across two edges
    check_steps({pulled(open, material), pulled(closed, material)});
}

TEST_CASE("a mesh moves according to its given masses")
{
    const ClothMesh mesh = tests::jittered_sheet(9, 7);
    voile::MeshCloth cloth = pulled(mesh, fabric_of(voile::BendingModel::isometric));
    for (uint32_t i = 0; i < mesh.positions.size(); ++i)
        cloth.inverse_masses.push_back(i % 5 == 0 ? 0 : 500.f * static_cast<float>(1 + i % 7));
    check_steps({cloth});
    // Different from the material's: these are 2000 to 8000 1/kg.
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(cloth));
    harness.upload();
    const auto x = harness.positions(id);
    CHECK(x[3].w == 2000);
    CHECK(x[5].w == 0);  // by its mass
    CHECK(x[13].w == 0); // held
}

TEST_CASE("vertices without a triangle do not move")
{
    ClothMesh mesh = tests::jittered_sheet(5, 5);
    mesh.positions.insert(mesh.positions.begin() + 3, glm::vec3(0.4f, 0.1f, 0.2f));
    for (glm::uvec3& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            t[corner] += t[corner] >= 3 ? 1 : 0;
    mesh.positions.emplace_back(0.5f, 0.3f, 0.2f);
    mesh.positions.emplace_back(0.6f, 0.3f, 0.2f);
    mesh.positions.emplace_back(0.7f, 0.3f, 0.2f);
    mesh.triangles.emplace_back(26, 27, 28); // collinear: not a triangle
    for (const bool given : {false, true})
    {
        ClothHarness harness;
        voile::MeshCloth cloth = mesh.cloth();
        cloth.velocity = {1, 2, 3};
        if (given)
            cloth.inverse_masses.assign(mesh.positions.size(), 10);
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(cloth));
        harness.upload();
        harness.step({.wind = {10, 0, 0}}, 3);
        const auto x = harness.positions(id);
        for (const uint32_t i : {3u, 26u, 27u, 28u})
        {
            CHECK(x[i] == glm::vec4(mesh.positions[i], 0));
            CHECK(harness.velocities(id)[i] == glm::vec4(0));
        }
        CHECK(glm::distance(glm::vec3(x[0]), mesh.positions[0]) > 0.05f); // it moves with its triangles
        CHECK(harness.statistics().nan_vertices == 0);
    }
}

TEST_CASE("a triangulated sheet hangs like a grid")
{
    // Without shear stiffness, a sheet pinned at its upper edge stretches by rho g L / 2 K.
    constexpr uint32_t k_side = 9;
    voile::Fabric fabric;
    fabric.areal_density = 0.2f;
    fabric.shear_stiffness = 0;
    fabric.bending_stiffness = 0;
    fabric.damping_ratio = 1;
    fabric.air_drag_tangential = 100; // damps the slow motion in the sheet's plane
    const ClothMesh mesh = tests::sheet(k_side, k_side, 1.f / (k_side - 1));
    voile::MeshCloth cloth = mesh.cloth();
    cloth.material = fabric;
    cloth.transform[1] = {0, 0, 1, 0}; // maps z to -y
    cloth.transform[2] = {0, -1, 0, 0};
    voile::GridCloth grid;
    grid.columns = grid.rows = k_side;
    grid.material = fabric;
    grid.transform = cloth.transform;
    grid.transform[3] = {0.5f, -0.5f, 0, 1};
    for (uint32_t i = 0; i < k_side; ++i)
        cloth.pins.push_back(i);
    grid.pins = cloth.pins;
    ClothHarness harness;
    const voile::ClothId as_mesh = voile::engine::take(harness.solver.add_cloth(cloth));
    const voile::ClothId as_grid = voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    harness.step({.duration = 0.1f, .air_density = 1000}, 20);
    const double exact = 0.2 * 9.81 / (2 * 1000);
    // Float positions near 1 m are known to 6e-8 of 1e-3; measured: 2.7e-5 of both.
    CHECK(lowest_middle(harness, as_mesh, k_side, k_side) - 1 == tests::close_to(exact, 1.3e-4));
    CHECK(lowest_middle(harness, as_grid, k_side, k_side) - 1 == tests::close_to(exact, 1.3e-4));
}

TEST_CASE("a cantilever with isometric bending sags equally as a mesh and as a grid")
{
    // A strip of 3 x 11 vertices 2 cm apart with its first two rows pinned. Its deflection follows from the beam's
    // difference equation: the curvature at row i is the moment of the rows beyond it over B.
    constexpr uint32_t k_rows = 11;
    constexpr double k_spacing = 0.02;
    voile::Fabric fabric;
    fabric.areal_density = 0.2f;
    fabric.bending_stiffness = 0.04f;
    fabric.stretch_stiffness = {500, 500};
    fabric.damping_ratio = 0.1f;
    fabric.bending_model = voile::BendingModel::isometric;
    const ClothMesh mesh = tests::sheet(3, k_rows, static_cast<float>(k_spacing));
    voile::MeshCloth cloth = mesh.cloth();
    cloth.material = fabric;
    cloth.pins = {0, 1, 2, 3, 4, 5};
    cloth.integrator = voile::Integrator::verlet; // only to save time
    voile::GridCloth grid;
    grid.columns = 3;
    grid.rows = k_rows;
    grid.width = 0.04f;
    grid.depth = 0.2f;
    grid.material = fabric;
    grid.pins = cloth.pins;
    grid.integrator = cloth.integrator;
    ClothHarness harness;
    const voile::ClothId as_mesh = voile::engine::take(harness.solver.add_cloth(cloth));
    const voile::ClothId as_grid = voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    // Drag against speed squared: first enough for a creep without swinging, then more for the last tenth of a
    // millimeter.
    harness.step({.duration = 0.1f, .air_density = 3e3f}, 8);
    harness.step({.duration = 0.1f, .air_density = 2e4f}, 3);
    REQUIRE(harness.solver.stable_substeps(0.1f) < voile::Step{}.max_substeps); // otherwise it would be softened

    double w[k_rows] = {};
    for (uint32_t i = 1; i + 1 < k_rows; ++i)
    {
        double moment = 0; // per meter of width, N
        for (uint32_t j = i + 1; j < k_rows; ++j)
            moment += (j + 1 == k_rows ? 0.5 : 1) * 0.2 * 9.81 * k_spacing * k_spacing * (j - i);
        w[i + 1] = 2 * w[i] - w[i - 1] + k_spacing * k_spacing * moment / 0.04;
    }
    const double sag = w[k_rows - 1];
    CHECK(sag == tests::close_to(0.2 * 9.81 * std::pow(0.19, 4) / (8 * 0.04), 0.025)); // rho g L^4 / 8B
    CHECK(lowest_middle(harness, as_grid, 3, k_rows) == tests::close_to(sag, 5e-3));   // measured: 1.1e-3 of both
    CHECK(lowest_middle(harness, as_mesh, 3, k_rows) == tests::close_to(sag, 5e-3));
}
