// Procedural meshes and the triangulation of polygons.
#include "voile/engine/assets/shapes.hpp"

#include "support/close_to.hpp"
#include "support/mesh_checks.hpp"
#include "voile/engine/assets/normals.hpp"
#include "voile/engine/assets/triangulate.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <vector>

namespace
{

voile::engine::Mesh cut(const std::vector<glm::vec3>& corners)
{
    voile::engine::Mesh mesh;
    mesh.positions = corners;
    mesh.triangles = voile::engine::triangulate(corners);
    return mesh;
}

// No triangle is flipped if all face +y and together they cover the outline.
void check_cut(const std::vector<glm::vec3>& corners, double area)
{
    const voile::engine::Mesh mesh = cut(corners);
    CHECK(mesh.triangles.size() == corners.size() - 2);
    CHECK(total_area(mesh) == tests::close_to(area, 1e-7));
    for (const glm::uvec3& t : mesh.triangles)
        CHECK(glm::cross(corners[t.y] - corners[t.x], corners[t.z] - corners[t.x]).y >= 0);
}

} // namespace

TEST_CASE("bounds enclose all positions")
{
    voile::engine::Mesh mesh;
    CHECK(voile::engine::bounds(mesh).max == glm::vec3(0));
    mesh.positions = {{1, -2, 3}, {-4, 5, 2}};
    CHECK(voile::engine::bounds(mesh).min == glm::vec3(-4, -2, 2));
    CHECK(voile::engine::bounds(mesh).max == glm::vec3(1, 5, 3));
}

TEST_CASE("a capsule and a box are closed, wound outward and have the right volume")
{
    const glm::vec3 from(1, 2, 3);
    const glm::vec3 to(1.6f, 2, 3.8f);
    const voile::engine::Mesh capsule = voile::engine::make_capsule(from, to, 0.5f);
    for (size_t i = 0; i < capsule.positions.size(); ++i)
    {
        const glm::vec3 p = capsule.positions[i];
        const glm::vec3 nearest = from + glm::clamp(glm::dot(p - from, to - from), 0.f, 1.f) * (to - from);
        REQUIRE(glm::distance(p, nearest + 0.5f * capsule.normals[i]) < 1e-5f);
    }
    CHECK(signed_volume(capsule) == tests::close_to(std::numbers::pi * (0.25 + 0.5 / 3), 0.005));
    CHECK(signed_volume(voile::engine::make_capsule(from, from, 0.5f)) ==
          tests::close_to(std::numbers::pi * 0.5 / 3, 0.005));

    const voile::engine::Mesh box = voile::engine::make_box({-1, 0, 1}, {1, 3, 5});
    CHECK(box.triangles.size() == 12);
    CHECK(signed_volume(box) == tests::close_to(24, 1e-7));
    for (const glm::uvec3& t : box.triangles)
    {
        const glm::vec3 a = box.positions[t.x];
        const glm::vec3 across = glm::cross(box.positions[t.y] - a, box.positions[t.z] - a);
        CHECK(glm::dot(across, box.normals[t.x]) > 0);
    }
}

TEST_CASE("a sphere is round, wound outward and has radial normals")
{
    const glm::vec3 center(1, 2, 3);
    voile::engine::Mesh sphere = voile::engine::make_sphere(center, 2.f);
    for (size_t i = 0; i < sphere.positions.size(); ++i)
        REQUIRE(glm::distance(sphere.positions[i], center + 2.f * sphere.normals[i]) < 1e-5f);
    for (const glm::uvec3& t : sphere.triangles)
    {
        const glm::vec3 a = sphere.positions[t.x];
        REQUIRE(glm::dot(glm::cross(sphere.positions[t.y] - a, sphere.positions[t.z] - a), a - center) > 0);
    }
    for (glm::vec3& p : sphere.positions)
        p -= center;
    CHECK(signed_volume(sphere) == tests::close_to(4. / 3. * std::numbers::pi * 8., 0.005));
}

TEST_CASE("the ground is a square that faces up")
{
    const voile::engine::Mesh ground = voile::engine::make_ground(3.f, -1.f);
    CHECK(voile::engine::bounds(ground).min == glm::vec3(-3, -1, -3));
    CHECK(voile::engine::bounds(ground).max == glm::vec3(3, -1, 3));
    CHECK(total_area(ground) == tests::close_to(36., 1e-7));
    for (const glm::uvec3& t : ground.triangles)
    {
        const glm::vec3 a = ground.positions[t.x];
        CHECK(glm::cross(ground.positions[t.y] - a, ground.positions[t.z] - a).y > 0);
    }
}

TEST_CASE("polygons are triangulated within their outline")
{
    check_cut({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}, 1.); // a square
    check_cut({{0, 0, 0}, {1, 0, 3}, {2, 0, 0}, {1, 0, 1}}, 2.); // a dart with its shorter diagonal outside
    check_cut({{0, 0, 0}, {0, 0, 3}, {3, 0, 3}, {3, 0, 2}, {1, 0, 2}, {1, 0, 1}, {3, 0, 1}, {3, 0, 0}}, 7.); // a C
    check_cut({{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {2, 0, 2}, {2, 0, 0}, {1, 0, 0}}, 4.); // corners in the middle of edges
    // A spike from the side ends within the corner that has the shortest cut.
    check_cut({{0, 0, 0},
               {0, 0, 1},
               {0, 0, 20},
               {20, 0, 20},
               {20, 0, 10.5f},
               {0.3f, 0, 0.3f},
               {20, 0, 10},
               {20, 0, 0},
               {1, 0, 0}},
              400. - 0.5 * 0.5 * 19.7);
    // A square with a square hole, joined to the outline by an edge that is used in both directions.
    check_cut(
        {{0, 0, 0}, {0, 0, 3}, {3, 0, 3}, {3, 0, 0}, {0, 0, 0}, {1, 0, 1}, {2, 0, 1}, {2, 0, 2}, {1, 0, 2}, {1, 0, 1}},
        8.);
}

TEST_CASE("triangulation keeps the winding of a polygon in any plane")
{
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.f, 1.f})
        {
            std::vector<glm::vec3> dart(4, glm::vec3(0));
            const std::vector<glm::vec2> flat = {{0, 0}, {3, 1}, {0, 2}, {1, 1}};
            glm::vec3 normal(0);
            normal[axis] = side;
            for (size_t i = 0; i < 4; ++i)
            {
                dart[i][(axis + 1) % 3] = flat[i].x;
                dart[i][(axis + 2) % 3] = side * flat[i].y;
            }
            for (const glm::uvec3& t : voile::engine::triangulate(dart))
                CHECK(glm::dot(glm::cross(dart[t.y] - dart[t.x], dart[t.z] - dart[t.x]), normal) > 0);
        }
}

TEST_CASE("a polygon that crosses itself or has no area still gives n - 2 triangles")
{
    CHECK(cut({{0, 0, 0}, {1, 0, 1}, {1, 0, 0}, {0, 0, 1}}).triangles.size() == 2);
    CHECK(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}).triangles.size() == 3);
    CHECK(cut({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}).triangles.size() == 2);
}

namespace
{

double doubled_area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The rule itself, for a polygon in the plane y = 0. Its time grows with the third power of the corners.
std::vector<glm::uvec3> cut_by_rule(const std::vector<glm::vec3>& corners)
{
    std::vector<uint32_t> left(corners.size());
    std::iota(left.begin(), left.end(), 0u);
    double area = 0;
    for (size_t i = 1; i + 1 < corners.size(); ++i)
        area += doubled_area({corners[0].z, corners[0].x}, {corners[i].z, corners[i].x},
                             {corners[i + 1].z, corners[i + 1].x});
    const auto flat = [&](uint32_t i)
    { return area < 0 ? glm::dvec2(corners[i].x, corners[i].z) : glm::dvec2(corners[i].z, corners[i].x); };
    std::vector<glm::uvec3> triangles;
    while (left.size() > 3)
    {
        const auto ear_at = [&](size_t i)
        { return glm::uvec3(left[(i + left.size() - 1) % left.size()], left[i], left[(i + 1) % left.size()]); };
        const auto blocks = [&](const glm::uvec3& t, uint32_t i)
        {
            const glm::dvec2 p = flat(i);
            return p != flat(t.x) && p != flat(t.y) && p != flat(t.z) && doubled_area(flat(t.x), flat(t.y), p) >= 0 &&
                   doubled_area(flat(t.y), flat(t.z), p) >= 0 && doubled_area(flat(t.z), flat(t.x), p) >= 0;
        };
        std::optional<size_t> best;
        bool best_clear = false;
        double best_cut = 0;
        for (size_t i = 0; i < left.size(); ++i)
        {
            const glm::uvec3 t = ear_at(i);
            if (doubled_area(flat(t.x), flat(t.y), flat(t.z)) <= 0)
                continue;
            const glm::dvec2 diagonal = flat(t.z) - flat(t.x);
            const double cut = glm::dot(diagonal, diagonal);
            const bool clear = std::ranges::none_of(left, [&](uint32_t other) { return blocks(t, other); });
            if (best && (best_clear != clear ? best_clear : cut >= best_cut))
                continue;
            best = i;
            best_clear = clear;
            best_cut = cut;
        }
        triangles.push_back(ear_at(best.value_or(0)));
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(best.value_or(0)));
    }
    triangles.emplace_back(left[0], left[1], left[2]);
    return triangles;
}

// A corner every 2 pi / count around the origin, at the given distance.
template <typename Radius>
std::vector<glm::vec3> corners_around(uint32_t count, Radius radius)
{
    std::vector<glm::vec3> corners;
    for (uint32_t i = 0; i < count; ++i)
    {
        const double angle = 2 * std::numbers::pi * i / count;
        const double r = radius(i);
        corners.emplace_back(r * std::cos(angle), 0, -r * std::sin(angle));
    }
    return corners;
}

double area_of(const std::vector<glm::vec3>& corners)
{
    glm::dvec3 sum(0);
    for (size_t i = 0; i < corners.size(); ++i)
        sum += glm::cross(glm::dvec3(corners[i]), glm::dvec3(corners[(i + 1) % corners.size()]));
    return 0.5 * glm::length(sum);
}

} // namespace

TEST_CASE("the ear with the shortest cut is clipped first, also if outlines touch, cross or lie on a line")
{
    std::mt19937 random(1);
    const auto up_to = [&](uint32_t most) { return std::uniform_int_distribution<uint32_t>(0, most)(random); };
    for (int round = 0; round < 600; ++round)
    {
        const uint32_t count = 4 + up_to(24);
        std::vector<glm::vec3> corners;
        if (round % 3 == 0)
            corners = corners_around(count, [&](uint32_t) { return 0.1 + 0.01 * up_to(90); });
        else
            for (uint32_t i = 0; i < count; ++i) // few positions: corners repeat, edges overlap
                corners.emplace_back(up_to(round % 3 == 1 ? 3 : 100), 0, up_to(round % 3 == 1 ? 3 : 100));
        CAPTURE(round);
        if (area_of(corners) > 0) // otherwise no plane to project to
            REQUIRE(voile::engine::triangulate(corners) == cut_by_rule(corners));
    }
}

TEST_CASE("a face of 20,000 corners is triangulated quickly")
{
    const auto start = std::chrono::steady_clock::now();
    std::mt19937 random(2);
    std::uniform_real_distribution<double> any(0.1, 1);
    constexpr uint32_t k_corners = 20000;
    std::vector<glm::vec3> comb;
    for (uint32_t i = 0; i < k_corners / 4; ++i)
        for (const glm::vec2& p : {glm::vec2(0, 0), glm::vec2(0, 9), glm::vec2(0.5f, 9), glm::vec2(0.5f, 0)})
            comb.emplace_back(p.x + static_cast<float>(i), 0, p.y);
    comb.emplace_back(k_corners / 4, 0, -1);
    comb.emplace_back(-1, 0, -1);
    for (const std::vector<glm::vec3>& corners :
         {corners_around(k_corners, [](uint32_t) { return 1.; }),
          corners_around(k_corners, [](uint32_t i) { return i % 2 == 0 ? 0.3 : 1.; }),
          corners_around(k_corners, [&](uint32_t) { return any(random); }), comb})
        check_cut(corners, area_of(corners));
    // It crosses itself everywhere, on few positions.
    std::vector<glm::vec3> lattice;
    for (uint32_t i = 0; i < k_corners; ++i)
        lattice.emplace_back(random() % 6, 0, random() % 6);
    CHECK(voile::engine::triangulate(lattice).size() == k_corners - 2);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    CHECK(elapsed.count() < 10); // each a fraction of a second; minutes if every ear tests every corner
}

TEST_CASE("a dome and a tube make a capsule")
{
    const voile::engine::Mesh dome = voile::engine::make_dome(12);
    const voile::engine::Mesh tube = voile::engine::make_tube(48);
    CHECK(total_area(dome) == tests::close_to(2 * std::numbers::pi, 0.005));
    CHECK(total_area(tube) == tests::close_to(2 * std::numbers::pi, 0.003));
    CHECK(std::abs(voile::engine::bounds(dome).min.y) < 1e-7f);
    CHECK(voile::engine::bounds(dome).max.y == 1);
    CHECK(voile::engine::bounds(tube).min.y == 0);
    CHECK(voile::engine::bounds(tube).max.y == 1);
    for (const voile::engine::Mesh* mesh : {&dome, &tube})
        for (const glm::uvec3& t : mesh->triangles)
        {
            const glm::vec3 a = mesh->positions[t.x];
            const glm::vec3 across = glm::cross(mesh->positions[t.y] - a, mesh->positions[t.z] - a);
            REQUIRE(glm::dot(across, mesh->normals[t.x] + mesh->normals[t.y] + mesh->normals[t.z]) > 0);
        }
    // Their rims coincide vertex by vertex.
    for (uint32_t i = 0; i <= 48; ++i)
    {
        const glm::vec3 rim = dome.positions[dome.positions.size() - 49 + i];
        CHECK(glm::distance(rim, tube.positions[tube.positions.size() - 49 + i]) < 1e-6f);
    }
    CHECK(voile::engine::turn_to({0, 0, 1}) * glm::vec3(0, 1, 0) == glm::vec3(0, 0, 1));
}

TEST_CASE("normals do not depend on the triangulation of a face or on triangles without area")
{
    std::vector<glm::dvec3> sums;
    const voile::engine::Mesh box = voile::engine::make_box({0, 0, 0}, {1, 2, 3});
    voile::engine::sum_normals(box.positions, box.triangles, sums);
    REQUIRE(sums.size() == box.positions.size());
    for (size_t i = 0; i < sums.size(); ++i)
        CHECK(voile::engine::unit_normal(sums[i]) == box.normals[i]);
    // A corner of a cube with one face cut in two: each face is weighted by a right angle.
    const std::vector<glm::vec3> corner{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 0}};
    voile::engine::sum_normals(corner, std::vector<glm::uvec3>{{0, 2, 1}, {0, 1, 3}, {0, 4, 2}, {0, 3, 4}, {0, 1, 5}},
                               sums);
    CHECK(glm::distance(voile::engine::unit_normal(sums[0]), glm::vec3(-1 / std::numbers::sqrt3_v<float>)) < 1e-6f);
    CHECK(sums[5] == glm::dvec3(0)); // only triangles without area
    CHECK(voile::engine::unit_normal(sums[5]) == glm::vec3(0, 1, 0));
}
