// The solver's report of a cloth mesh, and the meshes that it refuses.
#include "support/close_to.hpp"
#include "support/cloth_harness.hpp"
#include "support/cloth_meshes.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace
{

using tests::ClothHarness;
using tests::ClothMesh;

voile::MeshReport report_of(const ClothMesh& mesh)
{
    ClothHarness harness;
    return harness.solver.mesh_report(voile::engine::take(harness.solver.add_cloth(mesh.cloth())));
}

// All counts are 0 unless a test states otherwise.
void check(const voile::MeshReport& found, const voile::MeshReport& expected)
{
    CHECK(found.components == expected.components);
    CHECK(found.boundary_edges == expected.boundary_edges);
    CHECK(found.non_manifold_edges == expected.non_manifold_edges);
    CHECK(found.isolated_vertices == expected.isolated_vertices);
    CHECK(found.degenerate_triangles == expected.degenerate_triangles);
    CHECK(found.coincident_vertices == expected.coincident_vertices);
    CHECK(found.softened_edges == expected.softened_edges);
}

void append(ClothMesh& mesh, const ClothMesh& other, const glm::vec3& offset)
{
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const glm::vec3& p : other.positions)
        mesh.positions.push_back(p + offset);
    for (const glm::uvec3& t : other.triangles)
        mesh.triangles.push_back(t + first);
}

} // namespace

TEST_CASE("the report of a mesh counts pieces, borders and irregularities")
{
    SUBCASE("two pieces")
    {
        ClothMesh mesh = tests::sheet(3, 4, 0.1f);
        append(mesh, tests::sheet(2, 2, 0.05f), {2, 0, 0});
        check(report_of(mesh), {.components = 2, .boundary_edges = 10 + 4});
        CHECK(report_of(mesh).shortest_edge == tests::close_to(0.05, 2e-6));
    }
    SUBCASE("closed")
    {
        check(report_of(tests::torus(9, 7)), {.components = 1});
    }
    SUBCASE("three triangles at an edge")
    {
        const ClothMesh mesh{{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}},
                             {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
        check(report_of(mesh), {.components = 1, .boundary_edges = 6, .non_manifold_edges = 1});
        CHECK(report_of(mesh).shortest_edge == 1);
    }
    SUBCASE("isolated vertices")
    {
        ClothMesh mesh = tests::sheet(2, 2, 0.1f);
        mesh.positions.emplace_back(3, 0, 0);
        mesh.positions.emplace_back(4, 0, 0);
        check(report_of(mesh), {.components = 1, .boundary_edges = 4, .isolated_vertices = 2});
    }
    SUBCASE("triangles without area, one with vertices that others use")
    {
        ClothMesh mesh = tests::sheet(3, 2, 0.1f);
        mesh.triangles.emplace_back(0, 1, 2); // collinear
        mesh.triangles.emplace_back(3, 3, 4);
        mesh.positions.emplace_back(1, 1, 1);
        mesh.triangles.emplace_back(6, 6, 6);
        const voile::MeshReport report = report_of(mesh);
        check(report, {.components = 1, .boundary_edges = 6, .isolated_vertices = 1, .degenerate_triangles = 3});
        CHECK(report.shortest_edge == tests::close_to(0.1, 7e-8));
    }
    SUBCASE("an open seam")
    {
        ClothMesh mesh = tests::sheet(3, 3, 0.125f);
        append(mesh, tests::sheet(3, 3, 0.125f), {0.25f, 0, 0}); // its first column on the other's last, exact in float
        check(report_of(mesh), {.components = 2, .boundary_edges = 16, .coincident_vertices = 3});
    }
    SUBCASE("two pieces that share one vertex are connected")
    {
        const ClothMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
        check(report_of(mesh), {.components = 1, .boundary_edges = 6});
    }
    SUBCASE("a grid has none")
    {
        ClothHarness harness;
        check(harness.solver.mesh_report(voile::engine::take(harness.solver.add_cloth(voile::GridCloth{}))), {});
    }
}

TEST_CASE("a mesh that cannot be a cloth is refused by name, and the solver is unchanged")
{
    constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();
    const ClothMesh good = tests::sheet(3, 3, 0.1f);
    const std::vector<glm::vec2> too_few(8);
    ClothMesh line;
    line.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    line.triangles = {{0, 1, 2}, {1, 1, 2}};
    ClothMesh broken_index = good;
    broken_index.triangles[2].y = 9;
    ClothMesh broken_position = good;
    broken_position.positions[4].z = k_nan;
    struct Case
    {
        voile::MeshCloth mesh;
        std::string message;
    };
    std::vector<Case> cases{
        {{.positions = good.positions}, "the mesh has no triangles"},
        {line.cloth(), "none of its 2 triangles has an area"},
        {broken_index.cloth(), "triangle 2 refers to position 9 of 9"},
        {broken_position.cloth(), "position 4 is not finite"},
    };
    const auto add = [&](const std::string& message, const std::function<void(voile::MeshCloth&)>& spoil)
    {
        cases.push_back({good.cloth(), message});
        spoil(cases.back().mesh);
    };
    add("8 texture coordinates for 9 positions", [&](voile::MeshCloth& m) { m.texture_coordinates = too_few; });
    add("10 inverse masses for 9 vertices", [](voile::MeshCloth& m) { m.inverse_masses.assign(10, 1); });
    add("inverse mass 3 is -1 1/kg, must be 0 to 1e+09",
        [](voile::MeshCloth& m) { (m.inverse_masses = std::vector<float>(9, 1))[3] = -1; });
    add("inverse mass 0 is nan 1/kg, must be 0 to 1e+09",
        [](voile::MeshCloth& m) { m.inverse_masses.assign(9, std::abs(k_nan)); });
    add("pinned vertex 9 of 9", [](voile::MeshCloth& m) { m.pins = {0, 9}; });
    add("its transform is not finite", [](voile::MeshCloth& m) { m.transform[3].x = k_nan; });
    add("its transform takes vertex 0 to (3e+38, 0, 0), each must be -1e+06 to 1e+06 m",
        [](voile::MeshCloth& m) { m.transform[0].x = m.transform[3].x = 3e38f; });
    add("velocity is (0, nan, 0) m/s, each must be -10000 to 10000", [](voile::MeshCloth& m) { m.velocity.y = k_nan; });
    add("fabric: areal_density is 0 kg/m^2, must be 0.001 to 1000",
        [](voile::MeshCloth& m) { m.material = voile::Fabric{.areal_density = 0}; });

    ClothHarness harness;
    REQUIRE(harness.solver.add_cloth(good.cloth()).has_value());
    for (Case& c : cases)
    {
        c.mesh.name = "shirt";
        const auto result = harness.solver.add_cloth(c.mesh);
        REQUIRE_MESSAGE(!result, c.message);
        CHECK(result.error().message == "cloth \"shirt\": " + c.message);
        CHECK(harness.solver.vertex_count() == 9);
        CHECK(harness.solver.triangle_count() == 8);
    }
    harness.upload(); // existing objects still work
    harness.step({}, 2);
    CHECK(harness.statistics().nan_vertices == 0);
}
