// Which edges and vertices of colliders are features: exactly those that can protrude between the vertices of a cloth.
#include "colliders/collider_model.hpp"
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"
#include "support/hard_shapes.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace
{

constexpr float k_thickness = 0.003f; // m
constexpr float k_length = 1;         // m, of prisms, along z

voile::engine::Mesh prism(double radius, uint32_t sides)
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
std::vector<voile::shared::Feature> features_of(const voile::engine::Mesh& mesh)
{
    voile::Model model;
    voile::GridCloth sheet = tests::flat_sheet(21, std::numbers::sqrt2_v<float> / 2, 1);
    tests::fabric_of(sheet).thickness = k_thickness;
    REQUIRE(model.add(sheet));
    voile::ColliderModels colliders;
    REQUIRE(colliders.add(tests::collider(mesh)));
    voile::update_features(colliders, model);
    return colliders.colliders.at(0)->features->features;
}

Count count(const voile::engine::Mesh& mesh)
{
    Count result;
    for (const voile::shared::Feature& feature : features_of(mesh))
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

TEST_CASE("the flats of a cylinder are no feature edges, though they extend to its rims")
{
    // Within 5 cm its normals turn by 2.9 degrees on either side; 10.2 would count.
    const Count found = count(prism(0.5, 64));
    CHECK(found.along == 0);
    CHECK(found.around == 2 * 64);
    CHECK(found.corners > 64);
}

TEST_CASE("all edges of a thin rod are feature edges, however small their angles")
{
    const Count found = count(prism(0.01, 32)); // 11 degrees per edge
    CHECK(found.along >= 32);
    CHECK(found.corners >= 2);
}

TEST_CASE("the sharp edges of a prism are feature edges, the diagonals of its flats never")
{
    const Count found = count(prism(0.5, 6));
    CHECK(found.along == 6);
    CHECK(found.around == 2 * 6);
    CHECK(found.corners == 2 * 6);
}

TEST_CASE("a round mesh has no features, a box of triangles has 12 edges and 8 corners")
{
    const Count ball = count(voile::engine::make_sphere({0, 0, 0}, 0.5f, 96));
    CHECK(ball.along + ball.around + ball.corners == 0);
    const Count box = count(voile::engine::make_box(glm::vec3(-0.5f), glm::vec3(0.5f)));
    CHECK(box.along == 4);
    CHECK(box.around == 8);
    CHECK(box.corners == 8);
}

TEST_CASE("a feature knows how far its solid goes on behind it")
{
    constexpr float k_cloth_edge = 0.05f; // m, as in count()
    const auto box = [](float height) {
        return voile::engine::make_box({-0.2f, -height / 2, -0.2f}, {0.2f, height / 2, 0.2f});
    };
    for (const float height : {0.002f, 0.01f, 0.03f, 0.4f})
    {
        CAPTURE(height);
        // Obliquely through a plate from an edge, by 20.8 or 69.2 degrees to its flats; a corner sees three of them.
        const float oblique = std::numbers::pi_v<float> / 4 + std::atan(0.45f);
        const float behind_edge = height / (2 * std::sin(oblique));
        const std::vector<voile::shared::Feature> features = features_of(box(height));
        for (const voile::shared::Feature& feature : features)
        {
            const bool upright = feature.a.y != feature.b.y;
            if (feature.a == feature.b || upright)
                CHECK(feature.depth > 0);
            else
                CHECK(feature.depth == doctest::Approx(std::min(behind_edge, k_cloth_edge)).epsilon(0.06));
        }
    }
}

TEST_CASE("features of a mesh are found again only where cloths are thinner or coarser than all before")
{
    const voile::engine::Mesh mesh = prism(0.1, 12);
    voile::Model model;
    voile::ColliderModels colliders;
    REQUIRE(colliders.add(tests::collider(mesh)));
    const auto add = [&](uint32_t side, float thickness)
    {
        voile::GridCloth sheet = tests::flat_sheet(side, 1, 1);
        tests::fabric_of(sheet).thickness = thickness;
        REQUIRE(model.add(sheet));
        voile::update_features(colliders, model);
        return colliders.colliders.at(0)->features;
    };
    const auto first = add(21, k_thickness);
    CHECK_FALSE(first->features.empty());
    CHECK(add(21, k_thickness) == first);
    CHECK(add(41, 2 * k_thickness) == first);
    const auto thinner = add(21, 0.5f * k_thickness);
    CHECK(thinner != first);
    CHECK(add(11, k_thickness) != thinner);

    REQUIRE(colliders.add(tests::collider(mesh)));
    voile::update_features(colliders, model);
    CHECK(colliders.colliders.at(1)->features == colliders.colliders.at(0)->features);
}

// Contacts of edges divide by sums over their vertices' inverse masses. These underflow, or leave all of a push to the
// one light vertex.
