// Tests the intersection checks against cases that are counted by hand.
#include "support/cloth_meshes.hpp"
#include "support/crossing_checks.hpp"
#include "support/hard_shapes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

namespace
{

tests::Crossings crossings(const voile::engine::Mesh& collider, const tests::ClothMesh& cloth)
{
    return tests::CrossingCheck(collider, cloth.triangles)
        .count(std::vector<glm::dvec3>(cloth.positions.begin(), cloth.positions.end()));
}

void move(tests::ClothMesh& cloth, const glm::vec3& displacement)
{
    for (glm::vec3& p : cloth.positions)
        p += displacement;
}

} // namespace

TEST_CASE("the three long edges of a needle pass through the triangle that it pierces")
{
    tests::ClothMesh cloth = tests::sheet(2, 2, 1);
    move(cloth, {-0.4f, 0.5f, -0.4f}); // the diagonal passes beside the needle
    const tests::Crossings result = crossings(tests::needle(1, 0.02f), cloth);
    CHECK(result.collider_edges == 3);
    CHECK(result.cloth_edges == 0);
    move(cloth, {0, 0.6f, 0}); // above its tip
    CHECK(crossings(tests::needle(1, 0.02f), cloth).count() == 0);
}

TEST_CASE("the depth of a sheet in a box is exact")
{
    tests::ClothMesh cloth = tests::sheet(9, 9, 0.05f);
    move(cloth, {-0.203f, 0.29f, -0.197f});
    const voile::engine::Mesh box = voile::engine::make_box({-0.115f, 0, -0.115f}, {0.115f, 0.3f, 0.115f});
    const tests::Crossings result = crossings(box, cloth);
    CHECK(result.cloth_edges > 0);
    CHECK(result.collider_edges == 8); // the upright edges, and the diagonals of their faces
    CHECK(std::abs(result.depth - 0.01) < 1e-6);
    move(cloth, {0, 0.02f, 0});
    CHECK(crossings(box, cloth).count() == 0);
}

TEST_CASE("the depth of a strip through an open ground is its shorter end")
{
    tests::ClothMesh cloth = tests::sheet(3, 2, 0.05f);
    for (glm::vec3& p : cloth.positions)
        p = {p.x + 0.4f, p.z - 0.02f, 0.3f}; // upright
    const tests::Crossings result = crossings(voile::engine::make_ground(1), cloth);
    CHECK(result.cloth_edges == 5); // three upright edges, two diagonals
    CHECK(result.collider_edges == 0);
    CHECK(std::abs(result.depth - 0.02) < 1e-6);
}
