// The hierarchy against brute force: its structure, rays, nearest points, and the signed distance built on it.
#include "geometry/bvh_query.hpp"
#include "support/bvh_checks.hpp"
#include "support/close_to.hpp"
#include "voile/mesh_checks.hpp"

#include "voile/engine/assets/shapes.hpp"
#include "voile/engine/gpu/device.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>

namespace
{

struct Soup
{
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
};

void add_triangle(Soup& soup, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c)
{
    const auto first = static_cast<uint32_t>(soup.positions.size());
    soup.positions.insert(soup.positions.end(), {a, b, c});
    soup.triangles.emplace_back(first, first + 1, first + 2);
}

Soup random_soup(uint32_t count, float size, uint32_t seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> coordinate(-1, 1);
    Soup soup{"random " + std::to_string(count), {}, {}};
    const auto point = [&] { return glm::vec3(coordinate(random), coordinate(random), coordinate(random)); };
    for (uint32_t i = 0; i < count; ++i)
    {
        const glm::vec3 center = point();
        add_triangle(soup, center, center + size * point(), center + size * point());
    }
    return soup;
}

std::vector<Soup> soups()
{
    std::vector<Soup> result;
    for (const uint32_t count : {1u, 2u, 3u, 5u, 64u, 1234u})
        result.push_back(random_soup(count, 0.2f, count));
    result.push_back(random_soup(300, 2, 7)); // large triangles that overlap

    Soup same{"one triangle 100 times", {}, {}};
    for (int i = 0; i < 100; ++i)
        add_triangle(same, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    result.push_back(same);

    Soup shrinking{"sizes from 1 to 1e-30", {}, {}}; // splits off one at a time: the deepest possible tree
    for (int i = 0; i < 200; ++i)
    {
        const float s = std::pow(0.7f, static_cast<float>(i));
        add_triangle(shrinking, {s, 0, 0}, {s, s, 0}, {s, 0, s});
    }
    result.push_back(shrinking);

    const voile::engine::Mesh sphere = voile::engine::make_sphere({0.2f, 0.1f, -0.3f}, 0.9f, 24);
    result.push_back({"sphere", sphere.positions, sphere.triangles});
    return result;
}

// Checks the subtree under a child and returns its depth.
uint32_t check_child(const voile::Bvh& bvh, uint32_t child, const glm::vec3& min, const glm::vec3& max,
                     std::vector<uint32_t>& seen)
{
    if ((child & VOILE_BVH_LEAF_BIT) != 0)
    {
        const uint32_t first = child & VOILE_BVH_FIRST_MASK;
        const uint32_t count = ((child >> VOILE_BVH_COUNT_SHIFT) & VOILE_BVH_COUNT_MASK) + 1;
        for (uint32_t t = first; t < first + count; ++t)
        {
            REQUIRE(t < bvh.triangles.size());
            const auto& triangle = bvh.triangles[t];
            ++seen.at(triangle.index);
            for (const glm::vec3& p : {triangle.a, triangle.b, triangle.c})
            {
                CHECK(glm::all(glm::greaterThanEqual(p, min)));
                CHECK(glm::all(glm::lessThanEqual(p, max)));
            }
        }
        return 0;
    }
    REQUIRE(child < bvh.nodes.size());
    const auto& node = bvh.nodes[child];
    for (const auto& [inner_min, inner_max] :
         {std::pair(node.left_min, node.left_max), std::pair(node.right_min, node.right_max)})
    {
        if (inner_min.x > inner_max.x) // the empty half of a root with one leaf
            continue;
        CHECK(glm::all(glm::greaterThanEqual(inner_min, min)));
        CHECK(glm::all(glm::lessThanEqual(inner_max, max)));
    }
    uint32_t depth = check_child(bvh, node.left, node.left_min, node.left_max, seen);
    if (node.right_min.x <= node.right_max.x)
        depth = std::max(depth, check_child(bvh, node.right, node.right_min, node.right_max, seen));
    return depth + 1;
}

// The order in which a left-first walk visits nodes. The leaves' triangles must be consecutive.
void walk(const voile::Bvh& bvh, uint32_t child, std::vector<uint32_t>& order, uint32_t& triangles)
{
    if ((child & VOILE_BVH_LEAF_BIT) != 0)
    {
        REQUIRE((child & VOILE_BVH_FIRST_MASK) == triangles);
        triangles += ((child >> VOILE_BVH_COUNT_SHIFT) & VOILE_BVH_COUNT_MASK) + 1;
        return;
    }
    order.push_back(child);
    REQUIRE(child < bvh.nodes.size());
    walk(bvh, bvh.nodes[child].left, order, triangles);
    walk(bvh, bvh.nodes[child].right, order, triangles);
}

std::optional<voile::RayHit> brute_hit(const Soup& soup, const glm::dvec3& origin, const glm::dvec3& direction,
                                       double limit)
{
    std::optional<voile::RayHit> best;
    for (uint32_t i = 0; i < soup.triangles.size(); ++i)
    {
        const glm::uvec3& t = soup.triangles[i];
        const auto hit =
            voile::ray_triangle(origin, direction, soup.positions[t.x], soup.positions[t.y], soup.positions[t.z]);
        if (hit && *hit <= limit && (!best || *hit < best->t))
            best = voile::RayHit{*hit, i};
    }
    return best;
}

// The nearest point of a barycentric grid of samples: an upper bound without case distinctions.
double sampled_distance(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, int steps)
{
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j)
        {
            const double u = static_cast<double>(i) / steps;
            const double v = static_cast<double>(j) / steps;
            best = std::min(best, glm::distance(p, (1 - u - v) * a + u * b + v * c));
        }
    return best;
}

voile::MeshCollider collider(const voile::engine::Mesh& mesh)
{
    return {.positions = mesh.positions, .triangles = mesh.triangles};
}

} // namespace

TEST_CASE("every triangle lies in one leaf, every box in its parent, and no tree is too deep")
{
    for (const Soup& soup : soups())
        for (const uint32_t leaf : {1u, 2u, 4u})
        {
            CAPTURE(soup.name);
            CAPTURE(leaf);
            const voile::Bvh bvh = voile::build_bvh(soup.positions, soup.triangles, {.triangles_per_leaf = leaf});
            std::vector<uint32_t> seen(soup.triangles.size());
            const float far = std::numeric_limits<float>::infinity();
            const uint32_t depth = check_child(bvh, 0, glm::vec3(-far), glm::vec3(far), seen);
            CHECK(depth == bvh.depth);
            CHECK(bvh.depth <= VOILE_BVH_MAX_DEPTH);
            CHECK(seen == std::vector<uint32_t>(seen.size(), 1));
        }
}

TEST_CASE("a hierarchy is equal to the bit for any number of threads and any division of the work")
{
    std::vector<Soup> meshes = soups();
    meshes.push_back(random_soup(30000, 0.02f, 8));
    const voile::engine::Mesh sphere = voile::engine::make_sphere({0, 0, 0}, 1, 96);
    meshes.push_back({"finer sphere", sphere.positions, sphere.triangles});
    Soup lopsided = random_soup(20000, 0.02f, 9); // a few triangles far away: small subtrees beside large ones
    for (int i = 0; i < 3; ++i)
        add_triangle(lopsided, {1e4f, 0, 0}, {1e4f, 1, 0}, {1e4f, 0, static_cast<float>(i)});
    lopsided.name = "lopsided";
    meshes.push_back(lopsided);
    for (const Soup& soup : meshes)
        for (const uint32_t leaf : {1u, 2u, 4u})
        {
            CAPTURE(soup.name);
            CAPTURE(leaf);
            constexpr uint32_t k_all = 1u << 30;
            const voile::Bvh whole = voile::build_bvh(soup.positions, soup.triangles, {leaf, 1, k_all});
            const voile::BvhOptions shared_out[] = {{leaf, 1, 64}, {leaf, 2, 1}, {leaf, 3, 500}, {leaf, 8, 64}, {leaf}};
            for (const voile::BvhOptions& options : shared_out)
            {
                CAPTURE(options.threads);
                CAPTURE(options.triangles_per_subtree);
                CHECK(same_bits(voile::build_bvh(soup.positions, soup.triangles, options), whole));
            }
        }
}

TEST_CASE("the nodes of a hierarchy are in depth-first order")
{
    const Soup soup = random_soup(20000, 0.02f, 10);
    const voile::Bvh bvh =
        voile::build_bvh(soup.positions, soup.triangles, {.threads = 4, .triangles_per_subtree = 300});
    std::vector<uint32_t> order;
    uint32_t triangles = 0;
    walk(bvh, 0, order, triangles);
    REQUIRE(order.size() == bvh.nodes.size());
    for (uint32_t i = 0; i < order.size(); ++i)
        REQUIRE(order[i] == i);
    CHECK(triangles == bvh.triangles.size());
}

TEST_CASE("random rays hit the triangles that brute force finds")
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
    for (const Soup& soup : soups())
    {
        CAPTURE(soup.name);
        const voile::Bvh bvh = voile::build_bvh(soup.positions, soup.triangles);
        uint32_t hits = 0;
        for (int i = 0; i < 400; ++i)
        {
            const glm::dvec3 origin(coordinate(random), coordinate(random), coordinate(random));
            glm::dvec3 direction(coordinate(random), coordinate(random), coordinate(random));
            if (i % 2 == 1) // aimed at a triangle
            {
                const glm::uvec3& t = soup.triangles[static_cast<size_t>(i) % soup.triangles.size()];
                const glm::dvec3 sum = soup.positions[t.x] + soup.positions[t.y] + soup.positions[t.z];
                direction = sum / 3.0 - origin;
            }
            if (i % 8 == 0)
                direction = {0, i % 16 == 0 ? 1 : -1, 0}; // along an axis: division by zero
            const double limit = i % 3 == 0 ? 0.4 : 100;
            const auto expected = brute_hit(soup, origin, direction, limit);
            const auto found = voile::nearest_hit(bvh, origin, direction, limit);
            REQUIRE(found.has_value() == expected.has_value());
            if (!expected)
                continue;
            ++hits;
            CHECK(found->t == expected->t); // the same arithmetic on the same triangle, or its duplicate
        }
        CHECK(hits > 100);
    }
}

TEST_CASE("nearest points equal those of brute force")
{
    std::mt19937 random(4);
    std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
    for (const Soup& soup : soups())
    {
        CAPTURE(soup.name);
        const voile::Bvh bvh = voile::build_bvh(soup.positions, soup.triangles);
        for (int i = 0; i < 100; ++i)
        {
            const glm::dvec3 p(coordinate(random), coordinate(random), coordinate(random));
            double expected = std::numeric_limits<double>::infinity();
            for (const glm::uvec3& t : soup.triangles)
                expected = std::min(expected, voile::nearest_on_triangle(p, soup.positions[t.x], soup.positions[t.y],
                                                                         soup.positions[t.z])
                                                  .distance);
            const auto found = voile::nearest_point(bvh, p, 100);
            REQUIRE(found);
            CHECK(found->distance == expected);
            CHECK_FALSE(voile::nearest_point(bvh, p, 0.999 * expected));
        }
    }
}

TEST_CASE("the nearest point of a triangle is nearer than any sample, by at most the samples' spacing")
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    const auto point = [&] { return glm::dvec3(coordinate(random), coordinate(random), coordinate(random)); };
    std::array<int, 7> features{};
    for (int i = 0; i < 300; ++i)
    {
        const glm::dvec3 a = point();
        const glm::dvec3 b = point();
        const glm::dvec3 c = point();
        const glm::dvec3 p = 2.0 * point();
        const voile::NearestPoint nearest = voile::nearest_on_triangle(p, a, b, c);
        constexpr int k_steps = 40;
        const double sampled = sampled_distance(p, a, b, c, k_steps);
        const double spacing = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)}) / k_steps;
        CHECK(nearest.distance <= sampled + 1e-12);
        CHECK(nearest.distance >= sampled - spacing);
        ++features.at(static_cast<size_t>(nearest.feature));
    }
    for (const int count : features)
        CHECK(count > 0); // every branch was taken
}

TEST_CASE("the signed distance of a sphere's mesh is right inside and outside, with either winding")
{
    const glm::vec3 center(0.3f, -0.2f, 0.5f);
    voile::engine::Mesh mesh = voile::engine::make_sphere(center, 1, 48);
    // A chord of a band of 1/48 of half a turn lies 1 - cos(pi / 96) inside the sphere, the squares of bands twice
    // that.
    const double sagitta = 2 * (1 - std::cos(3.14159265358979 / 96)) + 1e-6;
    std::mt19937 random(6);
    std::uniform_real_distribution<double> coordinate(-2, 2);
    for (const bool inside_out : {false, true})
    {
        if (inside_out)
            for (glm::uvec3& t : mesh.triangles)
                std::swap(t.y, t.z);
        const auto distance = voile::MeshDistance::create(collider(mesh));
        REQUIRE(distance);
        CHECK(distance.value().closed());
        for (int i = 0; i < 500; ++i)
        {
            const glm::dvec3 p(coordinate(random), coordinate(random), coordinate(random));
            const double exact = glm::distance(p, glm::dvec3(center)) - 1;
            const double found = distance.value().nearest(p).signed_distance;
            CHECK(found >= exact - 1e-6);
            CHECK(found <= exact + sagitta);
        }
    }
}

TEST_CASE("the distance to an open mesh gives its side and its boundary")
{
    const voile::engine::Mesh ground = voile::engine::make_ground(1);
    const auto distance = voile::MeshDistance::create(collider(ground));
    REQUIRE(distance);
    CHECK_FALSE(distance.value().closed());
    CHECK(distance.value().has_sides());
    CHECK(distance.value().nearest({0.1, 0.25, 0.3}).signed_distance == tests::close_to(0.25, 1e-9));
    CHECK(distance.value().nearest({0.1, -0.25, 0.3}).signed_distance == tests::close_to(-0.25, 1e-9));
    CHECK_FALSE(distance.value().nearest({0.1, 0.25, 0.3}).on_boundary);
    CHECK(distance.value().nearest({3, 0.25, 0.3}).on_boundary);
    CHECK(distance.value().crossing({0.1, 1, 0.3}, {0.1, -3, 0.3}).value_or(-1) == tests::close_to(0.25, 1e-9));
    CHECK_FALSE(distance.value().crossing({0.1, 1, 0.3}, {0.1, 0.5, 0.3}));
}

TEST_CASE("an open bowl has no inside, a closed sphere has")
{
    voile::engine::Mesh sphere = voile::engine::make_sphere({0, 0, 0}, 1, 12);
    const voile::MeshDistance closed = voile::engine::take(voile::MeshDistance::create(collider(sphere)));
    CHECK(closed.has_sides());
    CHECK(closed.winding_number({0.1, 0.2, 0.3}) == tests::close_to(1, 1e-9));
    CHECK(std::abs(closed.winding_number({0.8, 0.8, 0.1})) < 1e-9);
    std::erase_if(sphere.triangles, [&](const glm::uvec3& t) { return sphere.positions[t.x].y > 0.6f; });
    const voile::MeshDistance bowl = voile::engine::take(voile::MeshDistance::create(collider(sphere)));
    CHECK_FALSE(bowl.has_sides());
    // The cap above y = 0.6 is missing. It covers (1 - 0.6) / 2 of the directions from the center, plus or minus a
    // band.
    CHECK(bowl.winding_number({0, 0, 0}) == tests::close_to(0.8, 0.1));
    CHECK(bowl.winding_number({0, -0.9, 0}) > 0.8);
    CHECK(bowl.winding_number({0.7, -0.9, 0}) < 0.1);       // past the surface, within the box
    CHECK(std::abs(bowl.winding_number({0, 9, 0})) < 0.01); // the opening is there
}

TEST_CASE("intersecting triangles are counted in pairs, neighbors are not")
{
    const std::vector<glm::vec3> positions{{0, 0, 0},        {1, 0, 0},       {0, 0, 1},
                                           {1, 0, 1},                                          // a square, y = 0
                                           {0.2f, -1, 0.2f}, {0.3f, 1, 0.2f}, {0.2f, 1, 0.3f}, // pierces one half
                                           {5, 0, 0},        {6, 0, 0},       {5, 0, 1}};      // far away
    const std::vector<glm::uvec3> triangles{{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
    CHECK(voile::count_self_intersections(positions, triangles) == 1);
    CHECK(voile::count_self_intersections(positions, std::span(triangles).first(2)) == 0);
    CHECK(voile::count_self_intersections(positions, {}) == 0);
}
