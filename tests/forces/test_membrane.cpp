// The membrane of a mesh: stretch and shear of a fabric on any triangles, like a grid's. Its direction, momentum and
// energy.
#include "support/close_to.hpp"
#include "support/cloth_meshes.hpp"
#include "support/energy_balance.hpp"
#include "support/momenta.hpp"
#include "support/slide.hpp"

#include "voile/fabrics.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>
#include <random>
#include <string>

namespace
{

using tests::ClothHarness;
using tests::ClothMesh;
using voile::Integrator;

constexpr uint32_t k_side = 8;
constexpr float k_spacing = 0.05f;

voile::Fabric soft_in_shear()
{
    voile::Fabric fabric;
    fabric.areal_density = 0.2f;
    fabric.stretch_stiffness = {1400, 740};
    fabric.shear_stiffness = 17;
    fabric.bending_stiffness = 0;
    fabric.damping_ratio = 0;
    fabric.air_drag_normal = fabric.air_drag_tangential = 0;
    return fabric;
}

// A flat square of irregular triangles: inner vertices are moved within the plane.
ClothMesh unstructured(uint32_t side, float spacing)
{
    ClothMesh mesh = tests::sheet(side, side, spacing);
    std::mt19937 random(11);
    std::uniform_real_distribution<float> offset(-0.25f * spacing, 0.25f * spacing);
    for (uint32_t row = 1; row + 1 < side; ++row)
        for (uint32_t column = 1; column + 1 < side; ++column)
        {
            const float u = offset(random);
            mesh.positions[row * side + column] += glm::vec3(u, 0, offset(random));
        }
    for (size_t t = 0; t + 1 < mesh.triangles.size(); t += 4) // every other cell has the other diagonal
    {
        const glm::uvec3 a = mesh.triangles[t];
        const glm::uvec3 b = mesh.triangles[t + 1];
        mesh.triangles[t] = {a.x, a.y, b.z};
        mesh.triangles[t + 1] = {a.x, b.z, a.z};
    }
    return mesh;
}

// Stress of a patch of cloth under uniform strain, N/m: force per width along warp and weft, and shear.
struct Stress
{
    double warp = 0;
    double weft = 0;
    double shear = 0;
};

// From the forces of a patch whose vertices are displaced by `strain` (x' = x + strain x) from their start: the sum of
// force times position over all vertices is minus the stress times the area, whatever the inner forces (the virial).
Stress stress_of(ClothHarness& harness, voile::ClothId id, const glm::mat3& strain, double area)
{
    constexpr float k_step = 1e-6f;
    const auto rest = harness.positions(id);
    auto strained = rest;
    for (glm::vec4& x : strained)
        x += glm::vec4(strain * glm::vec3(x), 0);
    harness.set_positions(id, strained);
    harness.set_velocities(id, std::vector<glm::vec4>(rest.size(), glm::vec4(0)));
    harness.step({.duration = k_step, .substeps = 1, .gravity = glm::vec3(0)});
    const auto v = harness.velocities(id);
    glm::dmat3 virial(0);
    for (size_t i = 0; i < v.size(); ++i)
        virial -= glm::outerProduct(glm::dvec3(v[i]) / static_cast<double>(k_step * rest[i].w), glm::dvec3(rest[i]));
    virial /= area;
    harness.set_positions(id, rest);
    return {virial[0].x, virial[2].z, 0.5 * (virial[2].x + virial[0].z)};
}

glm::mat3 strain_of(float warp, float weft, float shear)
{
    glm::mat3 strain(0);
    strain[0].x = warp;
    strain[2].z = weft;
    strain[2].x = strain[0].z = 0.5f * shear;
    return strain;
}

// The stiffness of a strip along the warp with a fixed width, N/m: see make_material.
double held_stiffness(const voile::Fabric& f)
{
    const auto warp = static_cast<double>(f.stretch_stiffness[0]);
    const auto weft = static_cast<double>(f.stretch_stiffness[1]);
    const auto shear = static_cast<double>(f.shear_stiffness);
    return 0.5 * (warp + std::sqrt(warp * warp + 4 * shear * shear * warp / weft));
}

constexpr float k_strain = 1e-3f;

// Strains of 0.1 %: springs are linear to that precision.
void check_moduli(ClothHarness& harness, voile::ClothId id, const voile::Fabric& f, double area)
{
    const double e = static_cast<double>(k_strain);
    const double held = held_stiffness(f);
    const auto shear = static_cast<double>(f.shear_stiffness);
    const double ratio = static_cast<double>(f.stretch_stiffness[1]) / static_cast<double>(f.stretch_stiffness[0]);
    const double largest = held * std::max(1.0, ratio);
    const Stress along = stress_of(harness, id, strain_of(k_strain, 0, 0), area);
    CHECK(along.warp == tests::close_to(held * e, 5e-4));         // measured: 1.6e-4
    CHECK(std::abs(along.weft - shear * e) < 3e-4 * largest * e); // 7e-5
    CHECK(std::abs(along.shear) < 1e-6 * largest * e);            // 3e-7
    const Stress across = stress_of(harness, id, strain_of(0, k_strain, 0), area);
    CHECK(across.weft == tests::close_to(held * ratio * e, 1e-3)); // 3.5e-4
    const Stress sheared = stress_of(harness, id, strain_of(0, 0, 10 * k_strain), area);
    CHECK(sheared.shear == tests::close_to(10 * shear * e, 1.5e-3)); // 4e-4
}

} // namespace

TEST_CASE("a mesh of any triangles stretches and shears with the fabric's moduli, like a grid")
{
    const ClothMesh meshes[] = {tests::sheet(k_side, k_side, k_spacing), unstructured(k_side, k_spacing)};
    const double length = static_cast<double>(k_spacing) * (k_side - 1);
    for (const float shear : {17.f, 400.f})
    {
        voile::Fabric fabric = soft_in_shear();
        fabric.shear_stiffness = shear;
        ClothHarness harness;
        std::vector<voile::ClothId> ids;
        for (const ClothMesh& mesh : meshes)
        {
            voile::MeshCloth cloth = mesh.cloth();
            cloth.material = fabric;
            ids.push_back(voile::engine::take(harness.solver.add_cloth(cloth)));
        }
        voile::GridCloth grid;
        grid.columns = grid.rows = k_side;
        grid.width = grid.depth = static_cast<float>(length);
        grid.material = fabric;
        ids.push_back(voile::engine::take(harness.solver.add_cloth(grid)));
        harness.upload();
        for (const voile::ClothId id : ids)
        {
            CAPTURE(id.index);
            check_moduli(harness, id, fabric, length * length);
        }
    }
}

TEST_CASE("warp and weft follow the texture coordinates, or rotate with a mesh that has none")
{
    const voile::Fabric fabric = soft_in_shear();
    const ClothMesh mesh = unstructured(k_side, k_spacing);
    const double area = std::pow(static_cast<double>(k_spacing) * (k_side - 1), 2);
    std::vector<glm::vec2> across; // warp along z, at any scale
    for (const glm::vec3& p : mesh.positions)
        across.emplace_back(-3 * p.z, 5 * p.x);
    const std::vector<glm::vec2> unusable(mesh.positions.size(), glm::vec2(0)); // like files without any
    voile::MeshCloth plain = mesh.cloth();
    plain.material = fabric;
    voile::MeshCloth turned = plain; // rotated from x to z
    turned.transform[0] = {0, 0, 1, 0};
    turned.transform[2] = {-1, 0, 0, 0};
    voile::MeshCloth textured = plain;
    textured.texture_coordinates = across;
    voile::MeshCloth without = plain;
    without.texture_coordinates = unusable;
    ClothHarness harness;
    std::vector<voile::ClothId> ids;
    for (const voile::MeshCloth& cloth : {plain, without, turned, textured})
        ids.push_back(voile::engine::take(harness.solver.add_cloth(cloth)));
    harness.upload();
    const double held = held_stiffness(fabric) * static_cast<double>(k_strain);
    for (const voile::ClothId id : ids)
    {
        CAPTURE(id.index);
        const bool along_x = id.index < 2;
        const glm::mat3 strain = along_x ? strain_of(k_strain, 0, 0) : strain_of(0, k_strain, 0);
        const Stress stress = stress_of(harness, id, strain, area);
        CHECK((along_x ? stress.warp : stress.weft) == tests::close_to(held, 1e-4)); // measured: 2.7e-5
        CHECK(std::abs(stress.shear) < 2e-7 * held);                                 // measured: 5e-8
    }
}

namespace
{

// A free mesh, scaled in its plane after it was added: its triangles are squeezed or stretched.
struct Squeezed
{
    ClothMesh mesh;
    voile::Fabric fabric;
    Integrator integrator;
    float scale;
    voile::ClothId id{};
    double start = 0; // J
    double most = 0;
    double last = 0;

    [[nodiscard]] voile::MeshCloth cloth() const
    {
        voile::MeshCloth result = mesh.cloth();
        result.material = fabric;
        result.integrator = integrator;
        result.transform = tests::tilted();
        return result;
    }
};

double energy_of(ClothHarness& harness, const Squeezed& s)
{
    auto reference = tests::reference_of(s.cloth());
    return tests::energy_of(harness, s.id, reference, glm::dvec3(0));
}

void start(ClothHarness& harness, std::vector<Squeezed>& subjects)
{
    for (Squeezed& s : subjects)
        s.id = voile::engine::take(harness.solver.add_cloth(s.cloth()));
    harness.upload();
    for (Squeezed& s : subjects)
    {
        auto x = harness.positions(s.id);
        for (glm::vec4& p : x)
            p = glm::vec4(s.scale * glm::vec3(p), p.w);
        harness.set_positions(s.id, x);
        s.start = s.last = energy_of(harness, s);
    }
}

voile::Fabric plain(float damping_ratio)
{
    voile::Fabric fabric = soft_in_shear();
    fabric.areal_density = 0.13f;
    fabric.stretch_stiffness = {300, 300};
    fabric.shear_stiffness = 100;
    fabric.damping_ratio = damping_ratio;
    return fabric;
}

} // namespace

TEST_CASE("a squeezed or stretched mesh never exceeds its initial energy")
{
    std::vector<Squeezed> subjects;
    for (const Integrator integrator : {Integrator::verlet, Integrator::rk4})
        for (const float scale : {0.7f, 0.5f, 0.2f, 1.1f, 2.f})
        {
            subjects.push_back({unstructured(9, 0.125f), plain(0), integrator, scale});
            subjects.push_back({tests::sheet(9, 9, 0.125f), plain(0), integrator, scale});
        }
    ClothHarness harness;
    start(harness, subjects);
    for (int i = 0; i < 15; ++i)
    {
        harness.step({.gravity = glm::vec3(0)}, 4);
        for (Squeezed& s : subjects)
        {
            s.last = energy_of(harness, s);
            s.most = std::max(s.most, std::isfinite(s.last) ? s.last : 1e300);
        }
    }
    for (const Squeezed& s : subjects)
    {
        CAPTURE(static_cast<int>(s.integrator));
        CAPTURE(s.scale);
        CHECK(s.most <= 1.01 * s.start); // the promise; measured: 0.98, RK4 at stretch 2
        CHECK(s.last < 0.5 * s.start);   // measured: 0.37
    }
}

TEST_CASE("a crumpled free mesh conserves momentum and gains no spin")
{
    std::vector<Squeezed> subjects;
    for (const Integrator integrator : {Integrator::verlet, Integrator::rk4})
        for (const float scale : {0.5f, 0.9f})
            subjects.push_back({unstructured(10, 1.f / 9), plain(0.02f), integrator, scale});
    ClothHarness harness;
    start(harness, subjects);
    double moving[4] = {};
    for (int frames = 0; frames < 32; frames += 4)
    {
        harness.step({.gravity = glm::vec3(0)}, 4);
        for (size_t i = 0; i < subjects.size(); ++i)
            moving[i] = std::max(moving[i], tests::momenta_of(harness, subjects[i].id).speeds);
    }
    for (size_t i = 0; i < subjects.size(); ++i)
    {
        CAPTURE(i);
        const tests::Momenta end = tests::momenta_of(harness, subjects[i].id);
        CHECK(glm::length(end.linear) < 3e-7 * moving[i]); // measured: 8e-8
        // m, measured: 3.4e-5, from the error of RK4 at its longest step; Verlet 1e-8.
        CHECK(glm::length(end.angular) < 1e-4 * moving[i]);
    }
}

TEST_CASE("a mesh of a preset sticks and slips within 1 % of the incline's tangent")
{
    // Like test_static_friction for grids: rounding must not shake stiff triangles by more than a vertex's weight.
    constexpr double k_angle = 30 * 3.14159265358979 / 180;
    const ClothMesh mesh = unstructured(9, 0.01f);
    const glm::mat4 tilt = glm::rotate(glm::mat4(1.f), static_cast<float>(-k_angle), glm::vec3(0, 0, 1));
    ClothHarness harness;
    (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{.normal = glm::vec3(tilt[1])}));
    const glm::dvec3 downhill(tilt[0]);
    std::vector<voile::ClothId> ids;
    std::vector<double> start;
    for (const double factor : {0.99, 1.01})
    {
        voile::Fabric fabric = voile::cotton();
        fabric.static_friction = static_cast<float>(factor * std::tan(k_angle));
        fabric.kinetic_friction = 0.5f;
        fabric.air_drag_normal = fabric.air_drag_tangential = 0;
        voile::MeshCloth cloth = mesh.cloth();
        cloth.material = fabric;
        cloth.integrator = Integrator::verlet;
        cloth.transform = tilt;
        cloth.transform[3] = tilt * glm::vec4(0.03f, fabric.thickness - 5e-6f, factor > 1 ? 0.3f : -0.3f, 1);
        ids.push_back(voile::engine::take(harness.solver.add_cloth(cloth)));
    }
    harness.upload();
    const auto position = [&](voile::ClothId id)
    {
        const auto x = harness.positions(id);
        double sum = 0;
        for (const glm::vec4& p : x)
            sum += glm::dot(glm::dvec3(p), downhill) / static_cast<double>(x.size());
        return sum;
    };
    for (const voile::ClothId id : ids)
        start.push_back(position(id));
    harness.step({.duration = 0.05f});
    const double slide = tests::slide_distance(k_angle, 0.99 * std::tan(k_angle), 0.5, 0.05);
    CHECK(position(ids[0]) - start[0] == tests::close_to(slide, 0.01)); // measured: 2.5e-3
    CHECK(std::abs(position(ids[1]) - start[1]) < 6e-6 * slide);        // measured: 6.1e-7, on an H200 2.4e-6
}
