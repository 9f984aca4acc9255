// Intersections of cloths with themselves and each other: the count on the GPU equals an exact count on the CPU.
#include "support/intersection_harness.hpp"

#include <cmath>

using tests::IntersectionHarness;

namespace
{

// Cloth pairs of one cloth, checked against the exact count.
uint32_t check_cloth(IntersectionHarness& harness, voile::ClothId cloth)
{
    const voile::IntersectionCounts found = harness.counts();
    CHECK(found.uncertain_pairs == 0);
    CHECK(found.collider_pairs == 0);
    const tests::ExactMesh mesh = harness.exact(cloth);
    CHECK(found.cloth_pairs == tests::count_pairs(mesh, mesh));
    return found.cloth_pairs;
}

// Moves rows of a flat sheet so that it is a staircase that comes back through itself.
std::vector<glm::vec3> rolled(const std::vector<glm::vec4>& flat, float radius)
{
    std::vector<glm::vec3> result;
    for (const glm::vec4& p : flat)
    {
        const float angle = p.z / radius;
        result.emplace_back(p.x + 0.03f * angle, radius * std::sin(angle), radius * std::cos(angle));
    }
    return result;
}

} // namespace

TEST_CASE_FIXTURE(IntersectionHarness, "a flat sheet does not intersect itself, a rolled one does")
{
    const voile::ClothId sheet = voile::engine::take(solver.add_cloth(tests::flat_grid(24, 17)));
    upload();
    CHECK(check_cloth(*this, sheet) == 0);
    CHECK(marks(sheet) == std::vector<uint32_t>(24 * 17, 0));
    place(sheet, rolled(positions(sheet), 0.2f));
    CHECK(check_cloth(*this, sheet) > 0);
}

TEST_CASE_FIXTURE(IntersectionHarness, "crumpled grids and meshes have as many intersections as an exact count")
{
    const tests::ClothMesh torus = tests::torus(17, 11);
    const voile::ClothId grid = voile::engine::take(solver.add_cloth(tests::flat_grid(19, 14)));
    const voile::ClothId mesh = voile::engine::take(solver.add_cloth(torus.cloth()));
    upload();
    for (const voile::ClothId other : {grid, mesh}) // one at a time
    {
        voile::engine::take(solver.set_enabled(other == grid ? mesh : grid, false));
        voile::engine::take(solver.set_enabled(other, true));
        step({.duration = 1e-6f, .substeps = 1});
        for (const uint32_t seed : {1u, 2u, 3u})
        {
            place(other, tests::random_positions(solver.vertices(other).vertices, seed, 0.5f));
            CHECK(check_cloth(*this, other) > 1000);
        }
    }
}

TEST_CASE_FIXTURE(IntersectionHarness,
                  "where hundreds of triangles intersect each other, the count is exact or says that it is not")
{
    const voile::ClothId sheet = voile::engine::take(solver.add_cloth(tests::flat_grid(14, 14)));
    upload();
    for (const float extent : {0.1f, 0.06f})
    {
        CAPTURE(extent);
        std::vector<glm::vec3> corners = tests::random_positions(14 * 14, 1, extent); // many of them at one point
        for (glm::vec3& corner : corners)
            corner = glm::round(16.f * corner) / 16.f;
        place(sheet, corners);
        const tests::ExactMesh mesh = exact(sheet);
        const uint64_t expected = tests::count_pairs(mesh, mesh);
        const voile::IntersectionCounts found = counts();
        CAPTURE(expected);
        CAPTURE(found.cloth_pairs);
        CHECK(found.cloth_pairs <= expected);
        CHECK((found.cloth_pairs == expected || found.uncertain_pairs > 0)); // lavapipe 22.3: 69,907, 68,435 found
    }
}

TEST_CASE_FIXTURE(IntersectionHarness, "intersections are counted exactly far from the origin")
{
    const voile::ClothId sheet = voile::engine::take(solver.add_cloth(tests::flat_grid(12, 11)));
    upload();
    for (const float distance : {100.f, 10000.f})
    {
        // At 10 km floats are 1 mm apart: many vertices lie in the planes of triangles.
        place(sheet, tests::random_positions(12 * 11, 4, 0.02f, glm::vec3(distance, -distance, distance / 3)));
        CHECK(check_cloth(*this, sheet) > 1000);
    }
}

TEST_CASE_FIXTURE(IntersectionHarness,
                  "vertices on a lattice make edges pass through vertices and edges, and all is exact")
{
    const voile::ClothId sheet = voile::engine::take(solver.add_cloth(tests::flat_grid(12, 11)));
    upload();
    for (const uint32_t seed : {1u, 2u, 3u, 4u})
    {
        std::vector<glm::vec3> lattice = tests::random_positions(12 * 11, seed, 2.5f);
        for (glm::vec3& p : lattice)
            p = glm::round(p) * 0.1f; // equal vertices, triangles without area, coplanar overlap
        place(sheet, lattice);
        CHECK(check_cloth(*this, sheet) > 1000);
        for (glm::vec3& p : lattice)
            p = glm::mat3(0.96f, 0.28f, 0, -0.168f, 0.576f, 0.8f, 0.224f, -0.768f, 0.6f) * p; // nearly degenerate
        place(sheet, lattice);
        CHECK(check_cloth(*this, sheet) > 100);
    }
}

TEST_CASE_FIXTURE(IntersectionHarness, "intersections of slivers are counted exactly")
{
    const voile::ClothId sheet = voile::engine::take(solver.add_cloth(tests::flat_grid(14, 9)));
    upload();
    for (const float thin : {1e-4f, 1e-7f, 0.f})
    {
        std::vector<glm::vec3> points = tests::random_positions(14 * 9, 8, 0.5f);
        for (glm::vec3& p : points)
            p = {p.x, 0.3f * p.x + thin * p.y, 0.7f * p.x + thin * p.z};
        place(sheet, points);
        CHECK(check_cloth(*this, sheet) > 1000);
    }
}

TEST_CASE_FIXTURE(IntersectionHarness, "small coordinates beside large ones have exact signs")
{
    const voile::ClothId pair = voile::engine::take(solver.add_cloth(tests::flat_grid(2, 4)));
    const voile::ClothId sheet = voile::engine::take(solver.add_cloth(tests::flat_grid(12, 11, {0, 100, 0})));
    upload();
    SUBCASE("an edge ends above a triangle by less than its coordinates can tell")
    {
        voile::engine::take(solver.set_enabled(sheet, false));
        step({.duration = 1e-6f, .substeps = 1});
        std::vector<glm::vec3> points(8, glm::vec3(0));
        points[0] = {-1, 0, -1};
        points[1] = {3, 0, -1};
        points[2] = {-1, 0, 3};
        points[3] = {3, 4, 3};
        points[4] = {0, 5, 0};
        points[5] = {0.25f, 6, 0};
        points[7] = {0.125f, 7, 0.125f};
        for (const float height : {1e-5f, 1e-12f, 1e-20f, 1e-30f, 0.f, -1e-30f, -1e-12f})
        {
            points[6] = {0, height, 0};
            place(pair, points);
            (void)check_cloth(*this, pair);
        }
    }
    SUBCASE("each coordinate has a size of its own")
    {
        voile::engine::take(solver.set_enabled(pair, false));
        step({.duration = 1e-6f, .substeps = 1});
        for (const uint32_t least : {20u, 60u, 100u})
        {
            std::vector<glm::vec3> points = tests::random_positions(12 * 11, 9, 0.5f);
            std::mt19937 random(7);
            for (glm::vec3& p : points)
                for (int axis = 0; axis < 3; ++axis)
                    if (random() % 2 == 0)
                        p[axis] = std::ldexp(p[axis], -static_cast<int>(random() % least));
            place(sheet, points);
            CHECK(check_cloth(*this, sheet) > 1000);
        }
    }
    SUBCASE("a sheet whose plane is 0 to within far less than rounding does not intersect itself")
    {
        voile::engine::take(solver.set_enabled(pair, false));
        step({.duration = 1e-6f, .substeps = 1});
        std::vector<glm::vec3> points;
        std::mt19937 random(3);
        for (const glm::vec4& p : positions(sheet))
            points.emplace_back(p.x, std::ldexp(static_cast<float>(random() % 1024), -70), p.z);
        place(sheet, points);
        CHECK(check_cloth(*this, sheet) == 0);
    }
}

TEST_CASE_FIXTURE(IntersectionHarness, "sheets intersect where they cross, overlap in a plane, or touch in one vertex")
{
    const voile::ClothId first = voile::engine::take(solver.add_cloth(tests::flat_grid(9, 9)));
    voile::GridCloth tilted = tests::flat_grid(9, 9, {0.3f, 0.01f, 0.2f});
    tilted.transform[0] = {0.8f, 0.6f, 0, 0};
    tilted.transform[1] = {-0.6f, 0.8f, 0, 0};
    const voile::ClothId second = voile::engine::take(solver.add_cloth(tilted));
    upload();
    const std::vector<glm::vec4> flat = positions(first);
    const auto check = [&]
    {
        const voile::IntersectionCounts found = counts();
        CHECK(found.uncertain_pairs == 0);
        CHECK(found.cloth_pairs == tests::count_pairs_both_ways(exact(first), exact(second)));
        return found.cloth_pairs;
    };
    CHECK(check() > 10); // they cross
    const auto displaced = [&](const glm::vec3& displacement)
    {
        std::vector<glm::vec3> result;
        for (const glm::vec4& p : flat)
            result.push_back(glm::vec3(p) + displacement);
        return result;
    };
    for (const glm::vec3 displacement : {glm::vec3(0), glm::vec3(0.05f, 0, 0.03f), glm::vec3(0.0625f, 0, 0.125f)})
    {
        place(second, displaced(displacement)); // in one plane
        CHECK(check() > 100);
    }
    std::vector<glm::vec3> above = displaced({0.031f, 0.5f, 0.042f});
    place(second, above);
    CHECK(check() == 0);
    above[40].y = 0; // one vertex in the plane, in the middle of a triangle
    place(second, above);
    CHECK(check() == 6); // the six edges around it
    above[40].y = 1e-6f;
    place(second, above);
    CHECK(check() == 0);
    above[40].y = -1e-6f; // a planted fault
    place(second, above);
    CHECK(check() == 6);
    const std::vector<uint32_t> marked = marks(second);
    CHECK(marked[40] == 1);
    CHECK(std::count(marked.begin(), marked.end(), 1u) == 7); // the vertex, and the other ends of its edges
    const std::vector<uint32_t> crossed = marks(first);
    CHECK(std::count(crossed.begin(), crossed.end(), 1u) == 3); // the corners of the triangle
}

TEST_CASE_FIXTURE(IntersectionHarness,
                  "only cloths with a common layer intersect, and removed and disabled ones do not")
{
    const tests::ClothMesh sheet = tests::jittered_sheet(7, 6);
    const voile::CookedCloth cooked = voile::engine::take(voile::cook(sheet.cloth()));
    std::vector<voile::ClothId> cloths;
    const auto add = [&](uint32_t i)
    {
        glm::mat4 transform(1.f);
        transform[3] = {0.02f * static_cast<float>(i % 7), 0.004f * static_cast<float>(i % 5),
                        0.01f * static_cast<float>(i % 3), 1};
        voile::MeshCloth mesh;
        mesh.cooked = cooked;
        mesh.transform = transform;
        voile::GridCloth grid =
            tests::flat_grid(5 + 9 * (i % 3), 6, glm::vec3(transform[3]) + glm::vec3(0.1f, 0, 0.1f));
        grid.transform[0].y = 0.2f;
        mesh.layers = grid.layers = 1u << i % 3 | (i % 4 == 0 ? 8u : 0u);
        cloths.push_back(i % 2 == 0 ? voile::engine::take(solver.add_cloth(mesh))
                                    : voile::engine::take(solver.add_cloth(grid)));
    };
    const auto layers = [](size_t i) { return 1u << i % 3 | (i % 4 == 0 ? 8u : 0u); };
    for (uint32_t i = 0; i < 20; ++i)
        add(i);
    upload();
    std::vector<size_t> present(20);
    std::iota(present.begin(), present.end(), size_t{0});
    const auto check = [&]
    {
        uint64_t expected = 0;
        for (const size_t a : present)
            for (const size_t b : present)
                if (a == b)
                {
                    const tests::ExactMesh mesh = exact(cloths[a]);
                    expected += tests::count_pairs(mesh, mesh);
                }
                else if ((layers(a) & layers(b)) != 0)
                    expected += tests::count_pairs(exact(cloths[a]), exact(cloths[b]));
        CHECK(expected > 100);
        const voile::IntersectionCounts found = counts();
        CHECK(found.cloth_pairs == expected);
        CHECK(found.uncertain_pairs == 0);
    };
    check();
    voile::engine::take(solver.remove(cloths[3]));
    voile::engine::take(solver.remove(cloths[4]));
    voile::engine::take(solver.set_enabled(cloths[8], false));
    std::erase_if(present, [](size_t i) { return i == 3 || i == 4 || i == 8; });
    step({.duration = 1e-6f, .substeps = 1}); // takes effect with a step
    check();
    add(20); // into the ranges that became free
    present.push_back(20);
    upload();
    check();
}

TEST_CASE_FIXTURE(IntersectionHarness, "triangles with a corner that is not finite are left out of the count alone")
{
    const voile::ClothId sheet = voile::engine::take(solver.add_cloth(tests::flat_grid(9, 8)));
    upload();
    std::vector<glm::vec3> points = tests::random_positions(72, 5, 0.5f);
    const tests::ExactMesh whole = tests::exact_mesh(points, solver.triangles(sheet));
    for (const float bad : {NAN, INFINITY})
    {
        points[30].y = bad;
        place(sheet, points);
        tests::ExactMesh mesh = whole;
        // Edges belong to triangles: an edge is left out with the triangle that owns it, its first one.
        uint64_t most = 0;
        tests::for_each_pair(whole, whole,
                             [&](uint32_t e, uint32_t t)
                             {
                                 const glm::uvec3 c = whole.triangles[t];
                                 const bool touched = glm::any(glm::equal(c, glm::uvec3(30))) ||
                                                      glm::any(glm::equal(whole.edges[e], glm::uvec2(30)));
                                 most += touched ? 0 : 1;
                             });
        const uint32_t found = counts().cloth_pairs;
        CHECK(found <= most);
        CHECK(found > most / 2);
    }
}

TEST_CASE("a solver counts intersections only if its options say so")
{
    tests::ClothHarness plain;
    voile::engine::take(plain.solver.add_cloth(tests::flat_grid(4, 4)));
    plain.upload();
    plain.run(
        [&](VkCommandBuffer cmd)
        {
            const auto refused = plain.solver.record_statistics(cmd, 0, voile::Intersections::counted);
            REQUIRE(!refused);
            CHECK(refused.error().message.find("SolverOptions::intersections") != std::string::npos);
        });
    CHECK(!plain.statistics().intersections.has_value());
    IntersectionHarness counting;
    const voile::ClothId cloth = voile::engine::take(counting.solver.add_cloth(tests::flat_grid(4, 4)));
    counting.upload();
    CHECK(!counting.statistics().intersections.has_value()); // not requested
    CHECK(counting.counts().cloth_pairs == 0);
    CHECK(counting.solver.vertices(cloth).intersections != VK_NULL_HANDLE);
    CHECK(!counting.statistics().intersections.has_value());
}
