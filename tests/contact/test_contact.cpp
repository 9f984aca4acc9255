// Contact on the GPU: one substep against a double-precision brute force, and its guarantees: no vertex ends under a
// surface, no vertex passes through one however fast, friction sticks and slows by Coulomb's law.
#include "reference/cloth_reference.hpp"
#include "reference/contact_reference.hpp"
#include "support/cloth_harness.hpp"

#include "voile/engine/assets/shapes.hpp"
#include "voile/mesh_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <optional>

namespace
{

using tests::ClothHarness;

constexpr float k_thickness = 0.03f;
constexpr double k_query_radius = 1.0005 * 0.03; // m: a vertex at rest at the thickness touches, within 0.05 %
constexpr float k_step = 2e-3f;                  // s; the reference material allows 2.19e-3 s without loss of damping

// A sheet that moves fast into a collider below, tilted so that only a part of it arrives.
voile::GridCloth falling_sheet(uint32_t columns, uint32_t rows)
{
    voile::GridCloth grid;
    grid.columns = columns;
    grid.rows = rows;
    grid.width = 1.3f;
    grid.depth = 1.1f;
    grid.transform = tests::tilted();
    grid.transform[3] = {0.3f, 0.45f, 0.01f, 1};
    grid.velocity = {0.7f, -4, 0.3f};
    grid.material = voile::reference_material();
    tests::raw(grid).static_friction = 0.5f;
    tests::raw(grid).kinetic_friction = 0.3f;
    return grid;
}

reference::TriangleMesh mesh_of(const voile::engine::Mesh& mesh, bool closed)
{
    reference::TriangleMesh result;
    result.positions.assign(mesh.positions.begin(), mesh.positions.end());
    result.triangles = mesh.triangles;
    result.closed = closed;
    return result;
}

voile::MeshCollider collider(const voile::engine::Mesh& mesh)
{
    return {.positions = mesh.positions, .triangles = mesh.triangles};
}

// The vertex normals that rays follow, from the grid's neighbors.
glm::dvec3 grid_normal(const voile::GridCloth& grid, const std::vector<glm::dvec3>& x, uint32_t i)
{
    const uint32_t row = i / grid.columns;
    const uint32_t column = i % grid.columns;
    const auto at = [&](uint32_t r, uint32_t c) { return x[size_t{r} * grid.columns + c]; };
    const glm::dvec3 along_row =
        at(row, std::min(column + 1, grid.columns - 1)) - at(row, column == 0 ? 0 : column - 1);
    const glm::dvec3 along_column = at(std::min(row + 1, grid.rows - 1), column) - at(row == 0 ? 0 : row - 1, column);
    return glm::normalize(glm::cross(along_column, along_row));
}

using FindContact = std::function<std::optional<reference::Contact>(const glm::dvec3& from, const glm::dvec3& to,
                                                                    const glm::dvec3& normal)>;

struct Comparison
{
    uint32_t contacts = 0;
    double position_error = 0; // greatest over all vertices, m
    double velocity_error = 0; // m/s
};

// One substep on the GPU and in the reference, from the same state.
Comparison compare(ClothHarness& harness, const voile::GridCloth& grid, float h, const FindContact& find)
{
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    harness.step({.duration = h, .substeps = 1});
    reference::Cloth reference(grid);
    const auto before = reference.state;
    reference.step(static_cast<double>(h), {});
    const auto proposed = reference.state;
    const auto x = harness.positions(id);
    const auto v = harness.velocities(id);
    Comparison result;
    for (uint32_t i = 0; i < reference.size(); ++i)
    {
        glm::dvec3 expected_x = proposed.x[i];
        glm::dvec3 expected_v = proposed.v[i];
        const auto contact = find(before.x[i], proposed.x[i], grid_normal(grid, proposed.x, i));
        if (contact)
        {
            ++result.contacts;
            reference::respond(*contact, static_cast<double>(k_thickness),
                               static_cast<double>(tests::raw(grid).static_friction),
                               static_cast<double>(tests::raw(grid).kinetic_friction), static_cast<double>(h),
                               before.x[i], expected_x, expected_v);
        }
        CHECK((v[i].w > 0) == contact.has_value());
        result.position_error = std::max(result.position_error, glm::distance(glm::dvec3(x[i]), expected_x));
        result.velocity_error = std::max(result.velocity_error, glm::distance(glm::dvec3(v[i]), expected_v));
    }
    return result;
}

// Coordinates below 1 m have an error of 2^-24 m each, and a substep with a contact some 10 of them. A direction is
// such a difference over an offset of at least a hundredth of the thickness: 1e5 ulp of a meter for 0.3 mm. It rotates
// a push of up to the thickness, and velocities of up to 5 m/s.
constexpr double k_ulp = 5.96e-8;
constexpr double k_direction_bound = 10 * k_ulp / (0.01 * 0.03);
constexpr double k_position_bound = 10 * k_ulp + 0.03 * k_direction_bound;
constexpr double k_velocity_bound = 10 * k_ulp * 5 + 5 * k_direction_bound;

} // namespace

TEST_CASE("a substep with contact equals the double-precision brute force")
{
    struct Size
    {
        uint32_t columns;
        uint32_t rows;
    };
    const voile::engine::Mesh sphere = voile::engine::make_sphere({0, 0, 0}, 0.4f, 16);
    const voile::engine::Mesh ground = voile::engine::make_ground(3, 0.245f);
    for (const Size& size : {Size{9, 7}, Size{8, 8}, Size{13, 5}, Size{2, 617}, Size{64, 50}, Size{128, 128}})
        for (const auto method : {voile::ContactMethod::nearest_point, voile::ContactMethod::normal_ray})
            for (const bool closed : {true, false})
            {
                CAPTURE(size.columns);
                CAPTURE(size.rows);
                CAPTURE(closed);
                const bool ray = method == voile::ContactMethod::normal_ray;
                CAPTURE(ray);
                const voile::engine::Mesh& mesh = closed ? sphere : ground;
                const reference::TriangleMesh exact = mesh_of(mesh, closed);
                ClothHarness harness(
                    {.feature_contact = false, .depenetration = false, .tuning = {.contact_method = method}});
                (void)voile::engine::take(harness.solver.add_collider(collider(mesh)));
                const Comparison result =
                    compare(harness, falling_sheet(size.columns, size.rows), k_step,
                            [&](const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& normal)
                            {
                                if (auto crossing = reference::crossing_contact(exact, from, to))
                                    return crossing;
                                return ray ? reference::ray_contact(exact, from, to, normal, k_query_radius)
                                           : reference::nearest_contact(exact, from, to, k_query_radius);
                            });
                CHECK(result.contacts > 0);
                CHECK(result.contacts < size.columns * size.rows);
                CHECK(result.position_error < k_position_bound);
                CHECK(result.velocity_error < k_velocity_bound);
            }
}

TEST_CASE("a substep with planes and spheres equals their formulas")
{
    const glm::dvec3 center(0.1, 0.15, 0);
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.2, 1, -0.1));
    for (const bool plane : {true, false})
    {
        CAPTURE(plane);
        ClothHarness harness({.depenetration = false});
        if (plane)
            (void)voile::engine::take(
                harness.solver.add_collider(voile::PlaneCollider{.normal = glm::vec3(normal), .offset = 0.42f}));
        else
            (void)voile::engine::take(
                harness.solver.add_collider(voile::SphereCollider{.center = glm::vec3(center), .radius = 0.3f}));
        const Comparison result = compare(
            harness, falling_sheet(40, 31), k_step,
            [&](const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3&) -> std::optional<reference::Contact>
            {
                const auto gap = [&](const glm::dvec3& p)
                {
                    return plane ? glm::dot(normal, p) - static_cast<double>(0.42f)
                                 : glm::distance(p, center) - static_cast<double>(0.3f);
                };
                const reference::Contact contact{plane ? normal : glm::normalize(to - center), gap(to), gap(from)};
                if (contact.gap < k_query_radius)
                    return contact;
                return std::nullopt;
            });
        CHECK(result.contacts > 0);
        CHECK(result.position_error < k_position_bound);
        CHECK(result.velocity_error < k_velocity_bound);
    }
}

TEST_CASE("a vertex that passes around an edge of a mesh is neither pulled in nor stopped")
{
    const voile::engine::Mesh box = voile::engine::make_box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f});
    ClothHarness harness({.feature_contact = false});
    voile::GridCloth grid{.columns = 2, .rows = 2};
    voile::Material material; // no springs: vertices are independent
    material.thickness = 5e-3f;
    grid.material = material;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    (void)voile::engine::take(harness.solver.add_collider(collider(box)));
    harness.upload();
    constexpr float k_short_step = 1.f / 600;
    const glm::vec3 from(0.499f, 0.505f, 0.1f); // over the top; the end is beside it
    const glm::vec3 displacement(0.004f, -0.007f, 0);
    harness.set_positions(id, std::vector(4, glm::vec4(from, 1)));
    harness.set_velocities(id, std::vector(4, glm::vec4(displacement / k_short_step, 0)));
    harness.step({.duration = k_short_step, .substeps = 1, .gravity = glm::vec3(0), .air_density = 0});
    CHECK(harness.velocities(id)[0].w == 1); // it touches
    CHECK(glm::distance(glm::vec3(harness.positions(id)[0]), from + displacement) < 1e-6f);
}

TEST_CASE("a sheet draped over a mesh never enters it")
{
    const voile::engine::Mesh sphere = voile::engine::make_sphere({0, 0.5f, 0}, 0.5f, 24);
    const auto distance = voile::engine::take(voile::MeshDistance::create(collider(sphere)));
    voile::GridCloth grid = falling_sheet(48, 48);
    grid.width = grid.depth = 2;
    grid.transform = glm::mat4(1.f);
    grid.transform[3] = {0.05f, 1.15f, 0.02f, 1};
    grid.velocity = {0, 0, 0};
    for (const auto method : {voile::ContactMethod::nearest_point, voile::ContactMethod::normal_ray})
    {
        ClothHarness harness({.feature_contact = false, .tuning = {.contact_method = method}});
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        (void)voile::engine::take(harness.solver.add_collider(collider(sphere)));
        (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{}));
        harness.upload();
        double deepest = 1;
        for (int frame = 0; frame < 60; ++frame)
        {
            harness.step({.duration = 1.f / 60});
            for (const glm::vec4& p : harness.positions(id))
                deepest = std::min({deepest, distance.nearest(glm::vec3(p)).signed_distance, static_cast<double>(p.y)});
        }
        CHECK(deepest > -1e-6); // coordinates near 1 m, in float
        const voile::Statistics statistics = harness.statistics();
        CHECK(statistics.nan_vertices == 0);
        CHECK(statistics.penetrating_vertices == 0);
        CHECK(statistics.contacts > 48 * 48 / 10);
    }
}

TEST_CASE("no vertex passes through a surface, however fast")
{
    const voile::engine::Mesh ground = voile::engine::make_ground(5);
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0.3f, 0}, 0.3f, 16);
    for (const float speed : {5.f, 60.f, 300.f, 2000.f}) // up to 33 m per substep, at 60 substeps per second
    {
        CAPTURE(speed);
        ClothHarness harness;
        voile::GridCloth grid = falling_sheet(20, 20);
        grid.transform = glm::mat4(1.f);
        grid.transform[3] = {0, 2, 0, 1};
        grid.velocity = {0, -speed, 0};
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        (void)voile::engine::take(harness.solver.add_collider(collider(ball)));
        (void)voile::engine::take(harness.solver.add_collider(collider(ground)));
        harness.upload();
        for (int i = 0; i < 20; ++i)
        {
            harness.step({.duration = 1.f / 60, .substeps = 11});
            for (const glm::vec4& p : harness.positions(id))
                REQUIRE(p.y > 0);
        }
    }
}

TEST_CASE("a patch on an incline slides or sticks by Coulomb's law")
{
    constexpr double k_angle = 3.14159265358979 / 6;
    const glm::vec3 normal(static_cast<float>(std::sin(k_angle)), static_cast<float>(std::cos(k_angle)), 0);
    const glm::dvec3 downhill(std::cos(k_angle), -std::sin(k_angle), 0);
    struct Case
    {
        float mu_s;
        float mu_k;
        double distance; // m in 1 s
    };
    // tan 30 degrees = 0.577. Sliding: s = g / 2 (sin - mu_k cos) t^2.
    for (const Case& c : {Case{0.5f, 0.5f, 0.3286}, Case{0.3f, 0.2f, 1.6033}, Case{0, 0, 2.4525}, Case{0.6f, 0.5f, 0}})
    {
        CAPTURE(c.mu_s);
        CAPTURE(c.mu_k);
        ClothHarness harness;
        voile::GridCloth grid;
        grid.columns = grid.rows = 9;
        grid.width = grid.depth = 0.2f;
        grid.material = voile::make_material({.thickness = 0.005f}, 0.025f, 0.025f);
        tests::raw(grid).air_drag_normal = tests::raw(grid).air_drag_tangential = 0;
        tests::raw(grid).static_friction = c.mu_s;
        tests::raw(grid).kinetic_friction = c.mu_k;
        grid.transform[0] = glm::vec4(glm::vec3(downhill), 0);
        grid.transform[1] = glm::vec4(normal, 0);
        grid.transform[3] = glm::vec4(tests::raw(grid).thickness * normal, 1);
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{.normal = normal}));
        harness.upload();
        const auto start = harness.positions(id);
        harness.step({.duration = 1.f / 60, .substeps = 40}, 60);
        const auto end = harness.positions(id);
        double mean = 0;
        for (size_t i = 0; i < start.size(); ++i)
            mean += glm::dot(glm::dvec3(end[i]) - glm::dvec3(start[i]), downhill) / static_cast<double>(start.size());
        // Half a substep of rest or motion at the start: v h / 2 = 4.9 m/s / 4800.
        CHECK(std::abs(mean - c.distance) < 1e-3);
    }
}

TEST_CASE("friction of a pair is the geometric mean of both sides")
{
    // Fabric 0.9, collider 0.1: with 0.3 on an incline of 30 degrees it slides 1.175 m in 1 s.
    constexpr double k_angle = 3.14159265358979 / 6;
    const glm::vec3 normal(static_cast<float>(std::sin(k_angle)), static_cast<float>(std::cos(k_angle)), 0);
    ClothHarness harness;
    voile::GridCloth grid;
    grid.columns = grid.rows = 2;
    grid.width = grid.depth = 0.1f;
    grid.material = voile::Material{};
    tests::raw(grid).static_friction = tests::raw(grid).kinetic_friction = 0.9f;
    grid.transform[0] = {normal.y, -normal.x, 0, 0};
    grid.transform[1] = glm::vec4(normal, 0);
    grid.transform[3] = glm::vec4(tests::raw(grid).thickness * normal, 1);
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    (void)voile::engine::take(
        harness.solver.add_collider(voile::PlaneCollider{.normal = normal, .friction = voile::Friction{0.1f, 0.1f}}));
    harness.upload();
    const auto start = harness.positions(id);
    harness.step({.duration = 1.f / 60, .substeps = 40}, 60);
    const double slid = glm::distance(glm::dvec3(harness.positions(id)[0]), glm::dvec3(start[0]));
    CHECK(std::abs(slid - 0.5 * 9.81 * (0.5 - 0.3 * std::sqrt(0.75))) < 1e-3);
}

TEST_CASE("two runs with contact are equal to the bit")
{
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0.2f, 0}, 0.3f, 16);
    std::vector<std::vector<glm::vec4>> states;
    for (int run = 0; run < 2; ++run)
    {
        ClothHarness harness;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(falling_sheet(61, 47)));
        (void)voile::engine::take(harness.solver.add_collider(collider(ball)));
        (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{}));
        harness.upload();
        harness.step({.duration = 1.f / 60, .substeps = 11}, 20);
        states.push_back(harness.positions(id));
        states.push_back(harness.velocities(id));
    }
    CHECK(std::memcmp(states[0].data(), states[2].data(), states[0].size() * sizeof(glm::vec4)) == 0);
    CHECK(std::memcmp(states[1].data(), states[3].data(), states[1].size() * sizeof(glm::vec4)) == 0);
}

TEST_CASE("a vertex pressed between two sheets closer than the thickness passes through neither")
{
    // Two open sheets 2 cm apart, and a cloth of thickness 3 cm driven between them: each pushes it through the other.
    voile::engine::Mesh gap = voile::engine::make_ground(2, 0);
    const voile::engine::Mesh upper = voile::engine::make_ground(2, 0.02f);
    for (const glm::uvec3& t : upper.triangles)
        gap.triangles.push_back(t + 4u);
    gap.positions.insert(gap.positions.end(), upper.positions.begin(), upper.positions.end());
    ClothHarness harness;
    voile::GridCloth grid = falling_sheet(12, 12);
    grid.width = grid.depth = 1;
    grid.transform = glm::mat4(1.f);
    grid.transform[3] = {0, 0.01f, 0, 1};
    grid.velocity = {0.1f, 1, 0};
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    (void)voile::engine::take(harness.solver.add_collider(collider(gap)));
    harness.upload();
    for (int i = 0; i < 30; ++i)
    {
        harness.step({.duration = 1.f / 60, .substeps = 11, .gravity = {0, i % 2 == 0 ? 20.f : -20.f, 0}});
        for (const glm::vec4& p : harness.positions(id))
        {
            REQUIRE(p.y >= 0);
            REQUIRE(p.y <= 0.02f);
        }
    }
}
