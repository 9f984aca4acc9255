// Stability of both integrators over the whole range of materials: cloths drawn at random, thrown, stretched, crumpled
// and blown at, in as few substeps as a step may be capped to.
#include "cloth_harness.hpp"
#include "cloth_meshes.hpp"
#include "reference/mesh_reference.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <variant>

namespace
{

using tests::ClothHarness;

class Draw
{
public:
    explicit Draw(uint32_t seed) : random_(seed) {}

    bool chance(double p) { return unit() < p; }
    float uniform(float low, float high) { return low + (high - low) * static_cast<float>(unit()); }
    uint32_t count(uint32_t low, uint32_t high) { return low + static_cast<uint32_t>(unit() * (high - low + 1)); }
    // Log-uniform; one in eight is either end.
    float in(float low, float high)
    {
        const double end = unit();
        const double between = std::log(static_cast<double>(low)) +
                               unit() * std::log(static_cast<double>(high) / static_cast<double>(low));
        return end < 0.125 ? low : end < 0.25 ? high : std::clamp(static_cast<float>(std::exp(between)), low, high);
    }
    // The same from 0, which is one in four.
    float from_zero(float least, float high) { return chance(0.25) ? 0 : in(least, high); }
    glm::vec3 direction()
    {
        const glm::vec3 d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
        return d / std::max(glm::length(d), 0.01f);
    }

private:
    double unit() { return static_cast<double>(random_()) / 4294967296.0; }
    std::mt19937 random_;
};

cloth::Fabric draw_fabric(Draw& draw)
{
    cloth::Fabric f;
    f.areal_density = draw.in(1e-3f, 1e3f);
    f.stretch_stiffness = {draw.in(1e-2f, 1e7f), draw.in(1e-2f, 1e7f)};
    f.shear_stiffness = draw.from_zero(1e-2f, 1e7f);
    f.bending_stiffness = draw.from_zero(1e-8f, 1e3f);
    f.damping_ratio = draw.from_zero(1e-3f, 1);
    f.air_drag_normal = draw.from_zero(1e-2f, 100);
    f.air_drag_tangential = draw.from_zero(1e-2f, 100);
    f.bending_model = draw.chance(0.5) ? cloth::BendingModel::springs : cloth::BendingModel::isometric;
    return f;
}

cloth::Material draw_material(Draw& draw)
{
    const auto spring = [&] { return cloth::Spring{draw.from_zero(1e-2f, 1e7f), draw.from_zero(1e-4f, 1e6f)}; };
    cloth::Material m;
    m.vertex_mass = draw.in(1e-9f, 1e6f);
    m.springs = {spring(), spring(), spring(), spring(), spring(), spring()};
    m.border_share = draw.in(0.1f, 1);
    m.bending_stiffness = draw.from_zero(1e-8f, 1e3f);
    m.bending_time = draw.from_zero(1e-6f, 1);
    m.linear_drag = draw.from_zero(1e-4f, 1e6f);
    m.air_drag_normal = draw.from_zero(1e-2f, 100);
    m.air_drag_tangential = draw.from_zero(1e-2f, 100);
    return m;
}

cloth::ClothMaterial draw_any_material(Draw& draw)
{
    if (draw.chance(0.5))
        return draw_fabric(draw);
    return draw_material(draw);
}

cloth::Integrator draw_integrator(Draw& draw)
{
    return draw.chance(0.5) ? cloth::Integrator::rk4 : cloth::Integrator::verlet;
}

glm::mat4 draw_transform(Draw& draw, float least, float most)
{
    glm::mat4 transform = tests::tilted();
    for (int axis = 0; axis < 3; ++axis)
        transform[axis] *= draw.in(least, most);
    return transform;
}

cloth::Grid draw_grid(Draw& draw)
{
    cloth::Grid grid;
    grid.columns = draw.count(2, 11);
    grid.rows = draw.count(2, 11);
    grid.width = draw.in(0.02f, 5);
    grid.depth = draw.in(0.02f, 5);
    grid.transform = draw_transform(draw, 0.02f, 4); // crumpled to a fiftieth, stretched to four times
    grid.velocity = draw.uniform(0, 60) * draw.direction();
    grid.material = draw_any_material(draw);
    grid.integrator = draw_integrator(draw);
    if (draw.chance(0.3))
        grid.held = {0, grid.columns - 1};
    return grid;
}

cloth::MeshCloth draw_mesh(Draw& draw, const tests::ClothMesh& shape)
{
    cloth::MeshCloth mesh = shape.cloth();
    mesh.transform = draw_transform(draw, 0.3f, 3);
    mesh.velocity = draw.uniform(0, 60) * draw.direction();
    mesh.material = draw_any_material(draw);
    mesh.integrator = draw_integrator(draw);
    if (draw.chance(0.3))
        mesh.held = {0, 3};
    return mesh;
}

cloth::Step draw_step(Draw& draw)
{
    cloth::Step step;
    step.max_substeps = uint32_t{1} << draw.count(0, 4);
    step.wind = draw.uniform(0, 60) * draw.direction();
    step.gust = draw.uniform(0, 1);
    step.gust_length = draw.in(0.2f, 10);
    step.time = static_cast<double>(draw.uniform(0, 100));
    return step;
}

// Kinetic energy, J, and the mass that moves, kg.
struct Motion
{
    double energy = 0;
    double mass = 0;
    bool finite = true;
};

Motion motion_of(ClothHarness& harness, cloth::ClothId id)
{
    const auto x = harness.positions(id);
    const auto v = harness.velocities(id);
    Motion motion;
    for (size_t i = 0; i < x.size(); ++i)
    {
        const glm::dvec3 velocity(v[i]);
        const double mass = x[i].w > 0 ? 1 / static_cast<double>(x[i].w) : 0;
        motion.mass += mass;
        motion.energy += 0.5 * mass * glm::dot(velocity, velocity);
        for (int c = 0; c < 3; ++c)
            motion.finite = motion.finite && std::isfinite(x[i][c]) && std::isfinite(v[i][c]);
    }
    return motion;
}

// Elastic energy at the start, J, by the references.
double elastic_energy(const cloth::Grid& grid)
{
    cloth::Grid raw = grid;
    if (const auto* fabric = std::get_if<cloth::Fabric>(&grid.material))
        raw.material = cloth::make_material(*fabric, grid.width / static_cast<float>(grid.columns - 1),
                                            grid.depth / static_cast<float>(grid.rows - 1));
    reference::Cloth reference(raw);
    std::fill(reference.state.v.begin(), reference.state.v.end(), glm::dvec3(0));
    return reference.energy({.gravity = glm::dvec3(0)}); // an affine image of a grid has no curvature
}

double elastic_energy(const cloth::MeshCloth& mesh)
{
    reference::MeshCloth reference(mesh);
    std::fill(reference.state.v.begin(), reference.state.v.end(), glm::dvec3(0));
    return reference.energy({.gravity = glm::dvec3(0)});
}

struct Subject
{
    cloth::ClothId id;
    double elastic = 0; // J, at full stiffness
    double bound = 0;   // J
    std::string name;
    double furthest = 0;
};

template <typename Description>
std::string describe(const Description& d)
{
    std::string text = d.integrator == cloth::Integrator::verlet ? "Verlet" : "RK4";
    if (const auto* f = std::get_if<cloth::Fabric>(&d.material))
        return text + " fabric rho " + std::to_string(f->areal_density) + " K " +
               std::to_string(f->stretch_stiffness[0]) + " " + std::to_string(f->stretch_stiffness[1]) + " shear " +
               std::to_string(f->shear_stiffness) + " B " + std::to_string(f->bending_stiffness) +
               (f->bending_model == cloth::BendingModel::isometric ? " isometric" : " springs") + " ratio " +
               std::to_string(f->damping_ratio) + " C " + std::to_string(f->air_drag_normal) + " " +
               std::to_string(f->air_drag_tangential);
    const auto& m = std::get<cloth::Material>(d.material);
    text += " material m " + std::to_string(m.vertex_mass * 1e9f) + " ug border " + std::to_string(m.border_share) +
            " B " + std::to_string(m.bending_stiffness) + " time " + std::to_string(m.bending_time) + " drag " +
            std::to_string(m.linear_drag) + " C " + std::to_string(m.air_drag_normal) + " " +
            std::to_string(m.air_drag_tangential);
    const cloth::SpringSet& s = m.springs;
    for (const cloth::Spring& spring :
         {s.structural_warp, s.structural_weft, s.shear, s.bend_warp, s.bend_weft, s.diagonal_bend})
        text += " (" + std::to_string(spring.stiffness) + ", " + std::to_string(spring.damping) + ")";
    return text;
}

} // namespace

TEST_CASE("no cloth runs away, whatever its material, in however few substeps")
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
            const cloth::Grid grid = draw_grid(draw);
            subjects.push_back(
                {engine::take(harness.solver.add_cloth(grid)), elastic_energy(grid), 0, "grid " + describe(grid)});
        }
        for (const tests::ClothMesh& shape : shapes)
        {
            const cloth::MeshCloth mesh = draw_mesh(draw, shape);
            subjects.push_back(
                {engine::take(harness.solver.add_cloth(mesh)), elastic_energy(mesh), 0, "mesh " + describe(mesh)});
        }
        harness.upload();
        cloth::Step step = draw_step(draw);
        CAPTURE(step.max_substeps);
        // Springs and damping take energy or keep it; gravity adds g t to a cloth's mean speed at most; drag pulls
        // towards the wind, whose speed is at most W with all gusts at their height, and what it puts into springs on
        // the way may come back as speed once more. The integrators' own energy is up to 1 / (1 - 0.9^2) = 5.3 times
        // smaller than the true one, in modes that take the whole step (Verlet's is v^2 + omega^2 x^2 (1 - (omega h /
        // 2)^2)). What runs away grows by a factor each substep, and is past any bound within 30 steps.
        // Not covered: Verlet without damping where springs are far shorter than at rest, in far too few substeps.
        // Their force turns round within a step, and the cloth heats up, in proportion to time (12 times this bound in
        // one of 588 cloths drawn while this was written).
        const double wind = static_cast<double>(glm::length(step.wind)) * (1 + 2.74 * static_cast<double>(step.gust));
        for (Subject& s : subjects)
        {
            const Motion start = motion_of(harness, s.id);
            const cloth::Stability stability = harness.solver.stability(s.id, step);
            const bool softened = stability.stiffness_share < 1 || stability.damping_share < 1;
            CHECK(softened == (stability.needed > step.max_substeps));
            CHECK(stability.used <= step.max_substeps);
            const double energy = start.energy + static_cast<double>(stability.stiffness_share) * s.elastic;
            const double speed = std::sqrt(2 * energy / start.mass) + 9.81 * 0.5 + 2 * wind;
            s.bound = 5.3 * 0.5 * start.mass * speed * speed;
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

TEST_CASE("damping of springs that fall into one line is as stable as in a plane")
{
    // Flat, the damping of rows and columns acts in two directions; folded into one line in both, twice as strong in
    // one. Stiffness is along the rows alone, and does not grow.
    ClothHarness harness;
    std::vector<cloth::ClothId> ids;
    for (const auto integrator : {cloth::Integrator::rk4, cloth::Integrator::verlet})
    {
        cloth::Grid grid;
        grid.columns = grid.rows = 9;
        grid.transform[0] = {0.6f, 0.8f, 0, 0};
        grid.transform[2] = {0.222f, 0.296f, 0, 0};
        grid.velocity = {3, 4, 1};
        grid.held = {0, 40};
        cloth::Material material;
        material.springs.structural_warp = {100, 20};
        material.springs.structural_weft = {0, 20};
        material.springs.shear = {0, 20};
        grid.material = material;
        grid.integrator = integrator;
        ids.push_back(engine::take(harness.solver.add_cloth(grid)));
    }
    harness.upload();
    const cloth::Step step{.max_substeps = 16};
    CHECK(harness.solver.stability(ids[0], step).damping_share < 1);
    for (const cloth::ClothId id : ids)
        CHECK(motion_of(harness, id).energy > 0.1);
    harness.step(step, 60);
    for (const cloth::ClothId id : ids)
    {
        const Motion now = motion_of(harness, id);
        CHECK(now.finite);
        // It started with sqrt(26) m/s and falls for a second.
        CHECK(now.energy < 0.5 * now.mass * std::pow(std::sqrt(26) + 9.81, 2));
    }
}

TEST_CASE("the substeps that stability asks for leave no vertex limited at rest")
{
    Draw draw(77);
    ClothHarness harness;
    std::vector<cloth::ClothId> ids;
    std::vector<std::string> names;
    const tests::ClothMesh shapes[] = {tests::sheet(7, 6, 0.05f), tests::jittered_sheet(7, 6)};
    for (int i = 0; i < 24; ++i)
    {
        cloth::Grid grid = draw_grid(draw);
        cloth::MeshCloth mesh = draw_mesh(draw, shapes[i % 2]);
        grid.transform = glm::mat4(1.f);
        grid.velocity = mesh.velocity = glm::vec3(0);
        ids.push_back(engine::take(harness.solver.add_cloth(grid)));
        ids.push_back(engine::take(harness.solver.add_cloth(mesh)));
        names.push_back(std::to_string(grid.columns) + " x " + std::to_string(grid.rows) + " grid " + describe(grid));
        names.push_back("mesh " + describe(mesh));
    }
    harness.upload();
    std::vector<cloth::Step> steps;
    for (const cloth::ClothId id : ids)
    {
        // A step as long as it needs four substeps, a little less than four that take all of the margin.
        cloth::Step step{.duration = 1, .gravity = glm::vec3(0)};
        for (int i = 0; i < 4; ++i)
            step.duration *= 3.9f / static_cast<float>(harness.solver.stability(id, step).needed);
        step.substeps = harness.solver.stability(id, step).needed;
        REQUIRE(step.substeps <= 8);
        CHECK(harness.solver.stability(id, step).stiffness_share == 1);
        CHECK(harness.solver.stability(id, step).damping_share == 1);
        steps.push_back(step);
    }
    // The longest ones first. At rest nothing moves but by the rounding of coordinates, with speeds of an ulp a
    // substep, which matter less the shorter the steps that follow.
    std::sort(ids.begin(), ids.end(),
              [&](cloth::ClothId a, cloth::ClothId b) { return steps[a.index].duration > steps[b.index].duration; });
    for (const cloth::ClothId id : ids)
    {
        CAPTURE(names[id.index]);
        harness.step(steps[id.index]);
        int limited = 0;
        for (const glm::vec4& v : harness.velocities(id))
            limited += v.w != 0 ? 1 : 0;
        CHECK(limited == 0);
    }
}
