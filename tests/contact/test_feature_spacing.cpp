// Features of meshes that are finer than the cloth on them: some stand for the others. How many are left, and that each
// that was left out has one nearby that is as sharp.
#include "colliders/collider_model.hpp"
#include "geometry/spatial_cell.hpp"
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <set>

namespace
{

constexpr float k_thickness = 0.003f;                      // m
constexpr float k_diagonal = std::numbers::sqrt3_v<float>; // of a cell, in its widths

// Of a mesh, for a cloth whose longest edges have the length `edge`, m.
std::shared_ptr<const voile::ColliderFeatures> features_of(const voile::engine::Mesh& mesh, float edge, bool deforms)
{
    voile::Model model;
    constexpr uint32_t k_side = 21;
    voile::GridCloth sheet = tests::flat_sheet(k_side, (k_side - 1) * edge / std::numbers::sqrt2_v<float>, 1);
    tests::fabric_of(sheet).thickness = k_thickness;
    REQUIRE(model.add(sheet));
    voile::MeshCollider description = tests::collider(mesh);
    description.deforms = deforms;
    voile::ColliderModels colliders;
    REQUIRE(colliders.add(description));
    voile::update_features(colliders, model);
    return colliders.colliders.at(0)->features;
}

voile::engine::Mesh ball(float radius)
{
    return voile::engine::make_sphere({0, 0, 0}, radius, 40);
}

// A cube about the origin whose faces are divided into cells x cells squares.
voile::engine::Mesh divided_cube(float side, uint32_t cells)
{
    voile::engine::Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.f, 1.f})
        {
            const auto first = static_cast<uint32_t>(mesh.positions.size());
            for (uint32_t row = 0; row <= cells; ++row)
                for (uint32_t column = 0; column <= cells; ++column)
                {
                    const auto at = [&](uint32_t i)
                    { return side * (static_cast<float>(i) / static_cast<float>(cells) - 0.5f); };
                    glm::vec3 p;
                    p[axis] = sign * side / 2;
                    p[(axis + 1) % 3] = at(column);
                    p[(axis + 2) % 3] = at(row);
                    mesh.positions.push_back(p);
                }
            for (uint32_t row = 0; row < cells; ++row)
                for (uint32_t column = 0; column < cells; ++column)
                {
                    const uint32_t a = first + row * (cells + 1) + column;
                    const uint32_t c = a + cells + 1;
                    glm::uvec3 lower(a, a + 1, c);
                    glm::uvec3 upper(a + 1, c + 1, c);
                    if (sign < 0)
                    {
                        std::swap(lower.y, lower.z);
                        std::swap(upper.y, upper.z);
                    }
                    mesh.triangles.insert(mesh.triangles.end(), {lower, upper});
                }
        }
    return mesh;
}

// On how many faces of the cube a point lies.
int faces_at(const glm::vec3& p, float side)
{
    int faces = 0;
    for (int axis = 0; axis < 3; ++axis)
        faces += std::abs(std::abs(p[axis]) - side / 2) < 1e-6f;
    return faces;
}

float nearest_corner(const voile::ColliderFeatures& features, const glm::vec3& p)
{
    float nearest = std::numeric_limits<float>::infinity();
    for (const auto& feature : features.features)
        if (feature.a == feature.b)
            nearest = std::min(nearest, glm::distance(feature.a, p));
    return nearest;
}

size_t distinct_positions(const voile::engine::Mesh& mesh)
{
    std::set<uint64_t> cells;
    for (const glm::vec3& p : mesh.positions)
        cells.insert(voile::spatial_cell(p, 1e-5f));
    return cells.size();
}

} // namespace

TEST_CASE("feature vertices of a fine ball are few, and as near to each other as its bend demands")
{
    constexpr float k_edge = 0.05f; // m
    for (const float radius : {0.02f, 0.04f, 0.08f})
    {
        CAPTURE(radius);
        const voile::engine::Mesh mesh = ball(radius);
        const auto found = features_of(mesh, k_edge, false);
        const voile::FeatureScale& scale = found->scale;
        CHECK(scale.edge == doctest::Approx(k_edge).epsilon(0.01));
        // A chord of that length sinks by this much, but not below the middle.
        const float half = std::min(scale.edge / 2, radius);
        const float sag = radius - std::sqrt(radius * radius - half * half);
        const float allowed = std::max(scale.spacing_for(sag), k_diagonal * scale.finest_spacing());
        std::set<uint64_t> cells;
        for (const auto& feature : found->features)
        {
            CHECK(feature.a == feature.b); // all edges are short
            cells.insert(voile::spatial_cell(feature.a, scale.finest_spacing()));
        }
        CHECK(found->features.size() == cells.size());
        CHECK(found->features.size() < distinct_positions(mesh) / 4);
        float farthest = 0;
        for (const glm::vec3& p : mesh.positions)
            farthest = std::max(farthest, nearest_corner(*found, p));
        CHECK(farthest <= allowed); // measured: at most 75 % of it
    }
    // Under a fine cloth the same ball needs none.
    CHECK(features_of(ball(0.08f), 0.008f, false)->features.empty());
}

TEST_CASE("a sharp edge keeps all parts that are longer than the spacing, and else a vertex within it")
{
    constexpr float k_edge = 0.05f; // m
    constexpr float k_side = 0.2f;  // m
    SUBCASE("parts of 1 cm")
    {
        const auto found = features_of(divided_cube(k_side, 20), k_edge, false);
        uint32_t edges = 0;
        uint32_t corners = 0;
        for (const auto& feature : found->features)
        {
            CHECK(faces_at(feature.a, k_side) >= 2);
            CHECK(faces_at(0.5f * (feature.a + feature.b), k_side) >= 2); // no diagonal
            ++(feature.a == feature.b ? corners : edges);
        }
        CHECK(edges == 12 * 20);
        CHECK(corners == 12 * 19 + 8);
    }
    SUBCASE("parts of 2 mm")
    {
        const voile::engine::Mesh mesh = divided_cube(k_side, 100);
        const auto found = features_of(mesh, k_edge, false);
        const float spacing = found->scale.finest_spacing();
        for (const auto& feature : found->features)
        {
            CHECK(feature.a == feature.b);
            CHECK(faces_at(feature.a, k_side) >= 2);
        }
        CHECK(found->features.size() < (12 * 99 + 8) / 2);
        for (const glm::vec3& p : mesh.positions)
            if (faces_at(p, k_side) >= 2)
                CHECK(nearest_corner(*found, p) <= k_diagonal * spacing);
    }
}

namespace
{

// Of the sources of a deforming mesh, at rest.
struct Sources
{
    const voile::engine::Mesh& mesh;
    const voile::DeformingFeatures& features;

    [[nodiscard]] glm::vec3 normal(uint32_t a, uint32_t b, uint32_t c) const
    {
        return glm::normalize(glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
    }
    [[nodiscard]] glm::vec3 middle(const voile::shared::FeatureSource& source) const
    {
        return 0.5f * (mesh.positions[source.a] + mesh.positions[source.b]);
    }
    [[nodiscard]] glm::vec3 along(const voile::shared::FeatureSource& source) const
    {
        return mesh.positions[source.b] - mesh.positions[source.a];
    }
    // 1 - the cosine of the largest angle at an edge.
    [[nodiscard]] float sharpness(const voile::shared::FeatureSource& source) const
    {
        float result = 0;
        for (uint32_t h = source.first_hinge; h < source.first_hinge + source.hinges; ++h)
        {
            const voile::shared::FeatureHinge& hinge = features.hinges[h];
            if (hinge.d != VOILE_NO_VERTEX)
                result = std::max(result,
                                  1 - glm::dot(normal(hinge.a, hinge.b, hinge.c), normal(hinge.b, hinge.a, hinge.d)));
        }
        return result;
    }
};

} // namespace

TEST_CASE("features of a deforming mesh have a stand-in nearby that is as sharp, and few stay in a coarse grid")
{
    constexpr float k_edge = 0.1f; // m
    for (const bool round : {true, false})
    {
        CAPTURE(round);
        const voile::engine::Mesh mesh = round ? ball(0.08f) : divided_cube(0.2f, 40);
        const auto found = features_of(mesh, k_edge, true);
        const Sources all{mesh, found->deforming};
        const auto& sources = found->deforming.sources;
        const float finest = found->scale.finest_spacing();
        size_t with_stand_in = 0;
        for (const auto& source : sources)
        {
            if (!std::isfinite(source.reach))
                continue;
            ++with_stand_in;
            const auto& other = sources[source.stand_in];
            CHECK(source.reach >= 2 * finest);
            CHECK(source.reach <= found->scale.edge);
            CHECK(glm::distance(all.middle(source), all.middle(other)) <= k_diagonal * source.reach);
            CHECK(other.reach > source.reach); // it stays where the other does not
            CHECK((source.a == source.b) == (other.a == other.b));
            if (source.a == source.b)
                continue;
            CHECK(all.sharpness(other) >= all.sharpness(source) - 1e-5f);
            const float own = glm::length(all.along(source));
            const float others = glm::length(all.along(other));
            CHECK(others >= 0.749f * own);
            CHECK(std::abs(glm::dot(all.along(source), all.along(other))) >= 0.899f * own * others);
        }
        // Of the vertices that stay in a grid, no two share a cell.
        for (float spacing = 2 * finest; spacing <= found->scale.edge; spacing *= 2)
        {
            std::set<uint64_t> cells;
            size_t staying = 0;
            for (const auto& source : sources)
                if (source.a == source.b && source.reach > spacing)
                {
                    ++staying;
                    cells.insert(voile::spatial_cell(all.middle(source), spacing));
                }
            CHECK(staying > 0);
            CHECK(staying == cells.size());
        }
        CHECK(with_stand_in > sources.size() / 2);
    }
}
