// Welding and closedness against definitions that are written without regard to speed.
#include "geometry/closedness.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <random>
#include <utility>

namespace
{

struct Triangles
{
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
};

Triangles tetrahedron()
{
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

// Every corner is a separate vertex.
Triangles torn_apart(const Triangles& mesh)
{
    Triangles result;
    for (const glm::uvec3& t : mesh.triangles)
    {
        const auto first = static_cast<uint32_t>(result.positions.size());
        for (int corner = 0; corner < 3; ++corner)
            result.positions.push_back(mesh.positions[t[corner]]);
        result.triangles.emplace_back(first, first + 1, first + 2);
    }
    return result;
}

std::vector<uint32_t> welded_by_search(const std::vector<glm::vec3>& positions)
{
    std::vector<uint32_t> result;
    for (const glm::vec3& p : positions)
        result.push_back(static_cast<uint32_t>(std::find(positions.begin(), positions.end(), p) - positions.begin()));
    return result;
}

bool closed_by_counting(const Triangles& mesh)
{
    const std::vector<uint32_t> welded = welded_by_search(mesh.positions);
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (const glm::uvec3& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            ++edges[{welded[t[corner]], welded[t[(corner + 1) % 3]]}];
    return std::all_of(edges.begin(), edges.end(),
                       [&](const auto& edge)
                       {
                           const auto reverse = edges.find({edge.first.second, edge.first.first});
                           return edge.second == 1 && reverse != edges.end() && reverse->second == 1;
                       });
}

bool is_closed(const Triangles& mesh)
{
    return voile::is_closed(voile::weld(mesh.positions), mesh.triangles);
}

} // namespace

TEST_CASE("vertices are welded to the first one at their position, with 0 equal to -0")
{
    std::mt19937 random(1);
    std::uniform_int_distribution<int> coordinate(-3, 3);
    std::vector<glm::vec3> positions;
    for (int i = 0; i < 2000; ++i)
        positions.push_back(0.25f * glm::vec3(coordinate(random), coordinate(random), coordinate(random)));
    positions.emplace_back(-0.f, 0.f, -0.f);
    positions.emplace_back(1e30f, -1e-38f, 0.f);
    CHECK(voile::weld(positions) == welded_by_search(positions));
    CHECK(voile::weld({}).empty());
}

TEST_CASE("a mesh is closed if every edge has one triangle on each side")
{
    Triangles mesh = tetrahedron();
    CHECK(is_closed(mesh));
    CHECK(is_closed(torn_apart(mesh)));
    for (glm::uvec3& t : mesh.triangles)
        std::swap(t.y, t.z);
    CHECK(is_closed(mesh));

    const auto not_closed = [](const Triangles& changed) { CHECK_FALSE(is_closed(changed)); };
    SUBCASE("a hole")
    {
        mesh.triangles.pop_back();
        not_closed(mesh);
    }
    SUBCASE("a flipped triangle")
    {
        std::swap(mesh.triangles[1].y, mesh.triangles[1].z);
        not_closed(mesh);
    }
    SUBCASE("a triangle twice")
    {
        mesh.triangles.push_back(mesh.triangles[0]);
        not_closed(mesh);
    }
    SUBCASE("every triangle twice: as many edges in each direction, but no surface")
    {
        const std::vector<glm::uvec3> again = mesh.triangles;
        mesh.triangles.insert(mesh.triangles.end(), again.begin(), again.end());
        not_closed(mesh);
    }
    SUBCASE("as many edges in as out at every vertex, with different ends")
    {
        mesh.triangles = {{2, 3, 0}, {1, 3, 2}};
        not_closed(mesh);
    }
    SUBCASE("a seam with a gap")
    {
        mesh = torn_apart(mesh);
        mesh.positions[0].x += 1e-6f;
        not_closed(mesh);
    }
}

TEST_CASE("closedness equals an edge count, for random triangles and for large meshes")
{
    std::mt19937 random(2);
    const Triangles whole = tetrahedron();
    int closed = 0;
    for (uint32_t i = 0; i < 3000; ++i)
    {
        Triangles mesh{whole.positions, {}};
        mesh.positions.emplace_back(1, 1, 1);
        const uint32_t corners = 4 + i % 2;
        for (uint32_t t = 0; t < 4; ++t)
        {
            glm::uvec3 triangle = whole.triangles[t];
            if (random() % 8 == 0)
                std::swap(triangle.x, triangle.y);
            if (random() % 8 == 0)
                triangle = {t % corners, (t + 1) % corners, (t + 2) % corners};
            mesh.triangles.push_back(triangle);
        }
        const bool expected = closed_by_counting(mesh);
        CHECK(is_closed(mesh) == expected);
        closed += expected ? 1 : 0;
    }
    CHECK(closed > 100);
    CHECK(closed < 2900);

    voile::engine::Mesh sphere =
        voile::engine::make_sphere({0, 0, 0}, 1, 120); // more vertices than one thread takes at a time
    CHECK(is_closed({sphere.positions, sphere.triangles}));
    std::swap(sphere.triangles[9000].y, sphere.triangles[9000].z);
    CHECK_FALSE(is_closed({sphere.positions, sphere.triangles}));
}
