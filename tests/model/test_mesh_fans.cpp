// Which vertices own the triangles and edges of a mesh.
#include "model/mesh_fans.hpp"
#include "model/model.hpp"
#include "support/odd_meshes.hpp"

#include "voile/fabrics.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <set>
#include <vector>

namespace
{

using Edge = std::array<uint32_t, 2>;     // the lower vertex first
using Triangle = std::array<uint32_t, 3>; // as its lowest vertex sees it

// What a mesh has, or what its fans have: how often each edge and triangle is owned.
struct Primitives
{
    std::map<Edge, int> edges;
    std::map<Triangle, int> triangles;
    std::vector<std::set<uint32_t>> owners; // of primitives around each vertex
};

// As its corners have them.
Primitives primitives_of(const voile::MeshLists& lists)
{
    Primitives result;
    result.owners.resize(lists.vertices.size());
    for (uint32_t i = 0; i < lists.vertices.size(); ++i)
        for (uint32_t k = 0; k < lists.vertices[i].corners; ++k)
        {
            const auto [b, c] = lists.corners[lists.vertices[i].first_corner + k];
            for (const uint32_t end : {b, c})
            {
                result.edges[{std::min(i, end), std::max(i, end)}] = 1;
                if (end < i)
                    result.owners[i].insert(end);
            }
            if (i < b && i < c)
                ++result.triangles[{i, b, c}];
        }
    return result;
}

Primitives primitives_of(const voile::MeshFans& fans)
{
    Primitives result;
    result.owners.resize(fans.vertices.size());
    for (uint32_t i = 0; i < fans.vertices.size(); ++i)
    {
        const voile::shared::MeshFan& fan = fans.vertices[i];
        for (uint32_t k = 0; k < fan.wedges; ++k)
        {
            const auto [b, c] = fans.wedges[fan.first_wedge + k];
            const uint32_t ends[2] = {b & ~VOILE_SPOKE_BIT, c & ~VOILE_SPOKE_BIT};
            if (b != ends[0])
                ++result.edges[{i, ends[0]}];
            if (c != ends[1])
                ++result.edges[{i, ends[1]}];
            if (ends[0] != ends[1])
                ++result.triangles[{i, ends[0], ends[1]}];
        }
        for (uint32_t k = 0; k < fan.owners; ++k)
            CHECK(result.owners[i].insert(fans.owners[fan.first_owner + k]).second);
    }
    return result;
}

voile::MeshLists lists_of(const tests::ClothMesh& mesh)
{
    voile::Model model;
    voile::MeshCloth cloth = mesh.cloth();
    cloth.material = voile::cotton();
    REQUIRE(model.add(cloth));
    return model.cloths.at(0)->mesh->lists;
}

const std::function<tests::ClothMesh()> k_meshes[] = {[] { return tests::rough_sheet(13, 9); },
                                                      tests::shuffled_sheet,
                                                      tests::octahedron,
                                                      tests::t_junctions,
                                                      tests::doubled_triangles,
                                                      tests::open_seam,
                                                      tests::fan,
                                                      tests::loose_ends,
                                                      [] { return tests::rough_sheet(170, 120); }};

} // namespace

TEST_CASE("each edge and each triangle of a mesh has one owner, its lowest vertex, and every vertex knows the owners "
          "around it")
{
    for (const auto& make : k_meshes)
    {
        const voile::MeshLists lists = lists_of(make());
        const voile::MeshFans fans = voile::make_mesh_fans(lists);
        const Primitives expected = primitives_of(lists);
        const Primitives found = primitives_of(fans);
        CHECK(found.edges == expected.edges);
        CHECK(found.triangles == expected.triangles);
        CHECK(found.owners == expected.owners);
        for (uint32_t i = 0; i < fans.vertices.size(); ++i)
            CHECK((fans.vertices[i].wedges > 0) == (lists.vertices[i].corners > 0)); // it may meet triangles itself
    }
}

TEST_CASE("a sheet in rows has about two wedges a vertex")
{
    const voile::MeshFans fans = voile::make_mesh_fans(lists_of(tests::rough_sheet(40, 40)));
    CHECK(fans.wedges.size() < 2.1 * static_cast<double>(fans.vertices.size()));
}

TEST_CASE("only meshes that collide with themselves have fans, and instances share them")
{
    const tests::ClothMesh mesh = tests::rough_sheet(5, 4);
    voile::Model model;
    voile::MeshCloth cloth = mesh.cloth();
    cloth.material = voile::cotton();
    REQUIRE(model.add(cloth));
    CHECK(model.fans.end(voile::k_fan_vertices) == 0);
    cloth.self_collision = true;
    auto cooked = voile::cook(cloth);
    REQUIRE(cooked);
    voile::MeshCloth instance;
    instance.cooked = cooked.value();
    instance.material = voile::cotton();
    instance.self_collision = true;
    const auto first = model.add(instance);
    const auto second = model.add(instance);
    REQUIRE(first);
    REQUIRE(second);
    CHECK(model.fans.end(voile::k_fan_vertices) == mesh.positions.size());
    model.remove(first.value());
    CHECK(model.fans.end(voile::k_fan_vertices) == mesh.positions.size());
    model.remove(second.value());
    CHECK(model.fans.end(voile::k_fan_vertices) == 0);
}
