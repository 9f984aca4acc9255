// Meshes made by rule, and the cutting of polygons.
#include "engine/assets/shapes.hpp"

#include "engine/assets/normals.hpp"
#include "engine/assets/triangulate.hpp"
#include "mesh_checks.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace
{

engine::Mesh cut(const std::vector<glm::vec3>& corners)
{
    engine::Mesh mesh;
    mesh.positions = corners;
    mesh.triangles = engine::triangulate(corners);
    return mesh;
}

// No triangle is turned over if all look along +y, and together they cover the outline.
void check_cut(const std::vector<glm::vec3>& corners, double area)
{
    const engine::Mesh mesh = cut(corners);
    CHECK(mesh.triangles.size() == corners.size() - 2);
    CHECK(total_area(mesh) == doctest::Approx(area));
    for (const glm::uvec3& t : mesh.triangles)
        CHECK(glm::cross(corners[t.y] - corners[t.x], corners[t.z] - corners[t.x]).y >= 0);
}

} // namespace

TEST_CASE("bounds enclose all positions")
{
    engine::Mesh mesh;
    CHECK(engine::bounds(mesh).max == glm::vec3(0));
    mesh.positions = {{1, -2, 3}, {-4, 5, 2}};
    CHECK(engine::bounds(mesh).min == glm::vec3(-4, -2, 2));
    CHECK(engine::bounds(mesh).max == glm::vec3(1, 5, 3));
}

TEST_CASE("a capsule and a box are closed, wound outwards and have the volume that they should")
{
    const glm::vec3 from(1, 2, 3);
    const glm::vec3 to(1.6f, 2, 3.8f);
    const engine::Mesh capsule = engine::make_capsule(from, to, 0.5f);
    for (size_t i = 0; i < capsule.positions.size(); ++i)
    {
        const glm::vec3 p = capsule.positions[i];
        const glm::vec3 nearest = from + glm::clamp(glm::dot(p - from, to - from), 0.f, 1.f) * (to - from);
        REQUIRE(glm::distance(p, nearest + 0.5f * capsule.normals[i]) < 1e-5f);
    }
    CHECK(signed_volume(capsule) == doctest::Approx(std::numbers::pi * (0.25 + 0.5 / 3)).epsilon(0.005));
    CHECK(signed_volume(engine::make_capsule(from, from, 0.5f)) ==
          doctest::Approx(std::numbers::pi * 0.5 / 3).epsilon(0.005));

    const engine::Mesh box = engine::make_box({-1, 0, 1}, {1, 3, 5});
    CHECK(box.triangles.size() == 12);
    CHECK(signed_volume(box) == doctest::Approx(24));
    for (const glm::uvec3& t : box.triangles)
    {
        const glm::vec3 a = box.positions[t.x];
        const glm::vec3 across = glm::cross(box.positions[t.y] - a, box.positions[t.z] - a);
        CHECK(glm::dot(across, box.normals[t.x]) > 0);
    }
}

TEST_CASE("a sphere is round, wound outwards and has radial normals")
{
    const glm::vec3 center(1, 2, 3);
    engine::Mesh sphere = engine::make_sphere(center, 2.f);
    for (size_t i = 0; i < sphere.positions.size(); ++i)
        REQUIRE(glm::distance(sphere.positions[i], center + 2.f * sphere.normals[i]) < 1e-5f);
    for (const glm::uvec3& t : sphere.triangles)
    {
        const glm::vec3 a = sphere.positions[t.x];
        REQUIRE(glm::dot(glm::cross(sphere.positions[t.y] - a, sphere.positions[t.z] - a), a - center) > 0);
    }
    for (glm::vec3& p : sphere.positions)
        p -= center;
    CHECK(signed_volume(sphere) == doctest::Approx(4. / 3. * std::numbers::pi * 8.).epsilon(0.005));
}

TEST_CASE("the ground is a square that faces up")
{
    const engine::Mesh ground = engine::make_ground(3.f, -1.f);
    CHECK(engine::bounds(ground).min == glm::vec3(-3, -1, -3));
    CHECK(engine::bounds(ground).max == glm::vec3(3, -1, 3));
    CHECK(total_area(ground) == doctest::Approx(36.));
    for (const glm::uvec3& t : ground.triangles)
    {
        const glm::vec3 a = ground.positions[t.x];
        CHECK(glm::cross(ground.positions[t.y] - a, ground.positions[t.z] - a).y > 0);
    }
}

TEST_CASE("polygons are cut within their outline")
{
    check_cut({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}, 1.); // a square
    check_cut({{0, 0, 0}, {1, 0, 3}, {2, 0, 0}, {1, 0, 1}}, 2.); // a dart, whose shorter diagonal lies outside
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
    // A square with a square hole, joined to the outline by an edge that is walked both ways.
    check_cut(
        {{0, 0, 0}, {0, 0, 3}, {3, 0, 3}, {3, 0, 0}, {0, 0, 0}, {1, 0, 1}, {2, 0, 1}, {2, 0, 2}, {1, 0, 2}, {1, 0, 1}},
        8.);
}

TEST_CASE("a polygon keeps its corners' order whichever way it looks")
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
            for (const glm::uvec3& t : engine::triangulate(dart))
                CHECK(glm::dot(glm::cross(dart[t.y] - dart[t.x], dart[t.z] - dart[t.x]), normal) > 0);
        }
}

TEST_CASE("a polygon that crosses itself or has no area still gives all triangles")
{
    CHECK(cut({{0, 0, 0}, {1, 0, 1}, {1, 0, 0}, {0, 0, 1}}).triangles.size() == 2);
    CHECK(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}).triangles.size() == 3);
    CHECK(cut({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}).triangles.size() == 2);
}

TEST_CASE("normals do not depend on how a face is cut, nor on triangles without area")
{
    std::vector<glm::dvec3> sums;
    const engine::Mesh box = engine::make_box({0, 0, 0}, {1, 2, 3});
    engine::sum_normals(box.positions, box.triangles, sums);
    REQUIRE(sums.size() == box.positions.size());
    for (size_t i = 0; i < sums.size(); ++i)
        CHECK(engine::unit_normal(sums[i]) == box.normals[i]);
    // A corner of a cube, one face of it cut in two: each face counts by a right angle.
    const std::vector<glm::vec3> corner{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 0}};
    engine::sum_normals(corner, std::vector<glm::uvec3>{{0, 2, 1}, {0, 1, 3}, {0, 4, 2}, {0, 3, 4}, {0, 1, 5}}, sums);
    CHECK(glm::distance(engine::unit_normal(sums[0]), glm::vec3(-1 / std::numbers::sqrt3_v<float>)) < 1e-6f);
    CHECK(sums[5] == glm::dvec3(0)); // of a triangle without area alone
    CHECK(engine::unit_normal(sums[5]) == glm::vec3(0, 1, 0));
}
