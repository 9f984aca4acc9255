// Random cloths over the whole range of materials, and the bounds of the stability tests.
#pragma once

#include "reference/mesh_reference.hpp"
#include "support/cloth_harness.hpp"
#include "support/cloth_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <variant>

namespace tests
{

class Draw
{
public:
    explicit Draw(uint32_t seed) : random_(seed) {}

    bool chance(double p) { return unit() < p; }
    float uniform(float low, float high) { return low + (high - low) * static_cast<float>(unit()); }
    uint32_t count(uint32_t low, uint32_t high) { return low + static_cast<uint32_t>(unit() * (high - low + 1)); }
    // Log-uniform; one in eight is one of the ends.
    float in(float low, float high)
    {
        const double end = unit();
        const double between = std::log(static_cast<double>(low)) +
                               unit() * std::log(static_cast<double>(high) / static_cast<double>(low));
        return end < 0.125 ? low : end < 0.25 ? high : std::clamp(static_cast<float>(std::exp(between)), low, high);
    }
    // Log-uniform, and 0 in one of four cases.
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

inline voile::Fabric draw_fabric(Draw& draw)
{
    voile::Fabric f;
    f.areal_density = draw.in(1e-3f, 1e3f);
    f.stretch_stiffness = {draw.in(1e-2f, 1e7f), draw.in(1e-2f, 1e7f)};
    f.shear_stiffness = draw.from_zero(1e-2f, 1e7f);
    f.bending_stiffness = draw.from_zero(1e-8f, 1e3f);
    f.damping_ratio = draw.from_zero(1e-3f, 1);
    f.air_drag_normal = draw.from_zero(1e-2f, 100);
    f.air_drag_tangential = draw.from_zero(1e-2f, 100);
    f.bending_model = draw.chance(0.5) ? voile::BendingModel::springs : voile::BendingModel::isometric;
    return f;
}

inline voile::Material draw_material(Draw& draw)
{
    const auto spring = [&] { return voile::Spring{draw.from_zero(1e-2f, 1e7f), draw.from_zero(1e-4f, 1e6f)}; };
    voile::Material m;
    m.vertex_mass = draw.in(1e-9f, 1e6f);
    m.springs = {spring(), spring(), spring(), spring(), spring(), spring()};
    m.border_scale = draw.in(0.1f, 1);
    m.bending_stiffness = draw.from_zero(1e-8f, 1e3f);
    m.bending_time = draw.from_zero(1e-6f, 1);
    m.linear_drag = draw.from_zero(1e-4f, 1e6f);
    m.air_drag_normal = draw.from_zero(1e-2f, 100);
    m.air_drag_tangential = draw.from_zero(1e-2f, 100);
    return m;
}

inline voile::ClothMaterial draw_any_material(Draw& draw)
{
    if (draw.chance(0.5))
        return draw_fabric(draw);
    return draw_material(draw);
}

inline voile::Integrator draw_integrator(Draw& draw)
{
    return draw.chance(0.5) ? voile::Integrator::rk4 : voile::Integrator::verlet;
}

inline glm::mat4 draw_transform(Draw& draw, float least, float most)
{
    glm::mat4 transform = tilted();
    for (int axis = 0; axis < 3; ++axis)
        transform[axis] *= draw.in(least, most);
    return transform;
}

inline voile::MeshCloth draw_mesh(Draw& draw, const ClothMesh& shape)
{
    voile::MeshCloth mesh = shape.cloth();
    mesh.transform = draw_transform(draw, 0.3f, 3);
    mesh.velocity = draw.uniform(0, 60) * draw.direction();
    mesh.material = draw_any_material(draw);
    mesh.integrator = draw_integrator(draw);
    if (draw.chance(0.3))
        mesh.pins = {0, 3};
    return mesh;
}

inline voile::Step draw_step(Draw& draw)
{
    voile::Step step;
    step.max_substeps = uint32_t{1} << draw.count(0, 4);
    step.wind = draw.uniform(0, 60) * draw.direction();
    step.gust = draw.uniform(0, 1);
    step.gust_length = draw.in(0.2f, 10);
    step.time = static_cast<double>(draw.uniform(0, 100));
    return step;
}

// Kinetic energy, J, and the moving mass, kg.
struct Motion
{
    double energy = 0;
    double mass = 0;
    bool finite = true;
};

inline Motion motion_of(ClothHarness& harness, voile::ClothId id)
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

// At the start, J, by the reference.
inline double elastic_energy(const voile::MeshCloth& mesh)
{
    reference::MeshCloth reference(mesh);
    std::fill(reference.state.v.begin(), reference.state.v.end(), glm::dvec3(0));
    return reference.energy({.gravity = glm::dvec3(0)});
}

// An upper bound of a cloth's kinetic energy in the next steps, half a second at most, J. `elastic`: J of its springs
// at the start, times the fraction of their stiffness that the step keeps.
//
// Springs and damping conserve or remove energy. Gravity adds at most g t to a cloth's mean speed. Drag pulls toward
// the wind, whose speed is at most W with all gusts at their peak, and the energy that it puts into springs may return
// as speed once more. The integrators' own energy is up to 1 / (1 - 0.9^2) = 5.3 times smaller than the true one, in
// modes at the stability limit of the step (Verlet's is v^2 + omega^2 x^2 (1 - (omega h / 2)^2)). An instability grows
// by a factor per substep and exceeds any bound within 30 steps.
// Springs whose force reverses within a step add no energy: Verlet makes fast springs viscous (forces.glsl).
inline double energy_bound(const Motion& start, double elastic, const voile::Step& step)
{
    const double wind = static_cast<double>(glm::length(step.wind)) * (1 + 2.74 * static_cast<double>(step.gust));
    const double speed = std::sqrt(2 * (start.energy + elastic) / start.mass) + 9.81 * 0.5 + 2 * wind;
    return 5.3 * 0.5 * start.mass * speed * speed;
}

template <typename Description>
std::string describe(const Description& d)
{
    const std::string integrator = d.integrator == voile::Integrator::verlet ? "Verlet, " : "RK4, ";
    return integrator + std::visit([](const auto& material) { return voile::to_string(material); }, d.material);
}

} // namespace tests
