// Which edges and corners of colliders count as such: those that can stand between the vertices of a cloth, and no
// others.
#include "collider_features.hpp"
#include "collider_scenes.hpp"
#include "hard_shapes.hpp"

#include "engine/assets/shapes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

namespace
{

constexpr float k_thickness = 0.003f; // m
constexpr float k_length = 1;         // m, of prisms, along z

engine::Mesh prism(double radius, uint32_t sides)
{
    constexpr double k_half = k_length / 2;
    return tests::closed_cylinder(radius, -k_half, k_half, sides);
}

struct Count
{
    uint32_t along = 0;  // edges along z
    uint32_t around = 0; // edges at an end
    uint32_t corners = 0;
};

// For a cloth whose longest edges are 5 cm.
Count count(const engine::Mesh& mesh)
{
    cloth::Model model;
    cloth::Grid sheet = tests::flat_sheet(21, std::numbers::sqrt2_v<float> / 2, 1);
    tests::fabric_of(sheet).thickness = k_thickness;
    REQUIRE(model.add(sheet));
    REQUIRE(model.add(tests::collider(mesh)));
    Count result;
    for (const auto& feature : cloth::find_features(model).features)
    {
        if (feature.a == feature.b)
            ++result.corners;
        else if (std::abs(feature.a.z - feature.b.z) > k_length / 2)
            ++result.along;
        else
            ++result.around;
    }
    return result;
}

} // namespace

TEST_CASE("the flats of a cylinder are no edges, though they reach its rims")
{
    // Across 5 cm of it normals turn by 2.9 degrees on either side; 10.2 would count.
    const Count found = count(prism(0.5, 64));
    CHECK(found.along == 0);
    CHECK(found.around == 2 * 64);
    CHECK(found.corners > 64);
}

TEST_CASE("all edges of a thin rod stand out, however little each of them turns")
{
    const Count found = count(prism(0.01, 32)); // 11 degrees an edge
    CHECK(found.along >= 32);
    CHECK(found.corners >= 2);
}

TEST_CASE("the edges of a prism stand out where the angle is sharp, its flats' diagonals never")
{
    const Count found = count(prism(0.5, 6));
    CHECK(found.along == 6);
    CHECK(found.around == 2 * 6);
    CHECK(found.corners == 2 * 6);
}

TEST_CASE("a round mesh has no features, a box of triangles has 12 edges and 8 corners")
{
    const Count ball = count(engine::make_sphere({0, 0, 0}, 0.5f, 96));
    CHECK(ball.along + ball.around + ball.corners == 0);
    const Count box = count(engine::make_box(glm::vec3(-0.5f), glm::vec3(0.5f)));
    CHECK(box.along == 4);
    CHECK(box.around == 8);
    CHECK(box.corners == 8);
}
