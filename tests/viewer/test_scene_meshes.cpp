// The meshes that the sample scenes are made with.
#include "samples/scenes/figure.hpp"
#include "samples/scenes/garments.hpp"
#include "samples/scenes/gem.hpp"
#include "samples/scenes/heart.hpp"

#include "support/close_to.hpp"
#include "support/mesh_checks.hpp"
#include "voile/mesh_checks.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace
{

// Width (x) and depth (z) of the cut through the mesh at a height.
glm::dvec2 cut_size(const voile::engine::Mesh& mesh, double y)
{
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high(-std::numeric_limits<double>::infinity());
    for (const glm::uvec3& t : mesh.triangles)
        for (int i = 0; i < 3; ++i)
        {
            const glm::dvec3 a = mesh.positions[t[i]];
            const glm::dvec3 b = mesh.positions[t[(i + 1) % 3]];
            if ((a.y < y) == (b.y < y))
                continue;
            const glm::dvec3 p = glm::mix(a, b, (y - a.y) / (b.y - a.y));
            low = glm::min(low, glm::dvec2(p.x, p.z));
            high = glm::max(high, glm::dvec2(p.x, p.z));
        }
    return high - low;
}

// The highest vertex whose x is within half an edge's length of the one given.
double top_at(const voile::engine::Mesh& mesh, float x)
{
    double top = -1;
    for (const glm::vec3& p : mesh.positions)
        if (std::abs(p.x - x) < 0.04f)
            top = std::max(top, double{p.y});
    return top;
}

void check_near(const glm::vec3& found, const glm::dvec3& wanted, double tolerance)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        CAPTURE(axis);
        CHECK(std::abs(found[axis] - wanted[axis]) <= tolerance);
    }
}

// The longest edge over the shortest.
double edge_ratio(const voile::engine::Mesh& mesh)
{
    double shortest = std::numeric_limits<double>::infinity();
    double longest = 0;
    for (const glm::uvec3& t : mesh.triangles)
        for (int i = 0; i < 3; ++i)
        {
            const double length = glm::distance(mesh.positions[t[i]], mesh.positions[t[(i + 1) % 3]]);
            shortest = std::min(shortest, length);
            longest = std::max(longest, length);
        }
    return longest / shortest;
}

} // namespace

TEST_CASE("the reference heart is closed, wound outward and of the scene's resolution")
{
    const voile::engine::Mesh heart = scenes::make_reference_heart();
    CHECK(heart.triangles.size() == 11264);
    CHECK(heart.positions.size() == 5634); // Euler: V - E + F = 2
    CHECK(is_closed(heart));
    CHECK(signed_volume(heart) > 0);
    CHECK(edge_ratio(heart) < 10);
}

TEST_CASE("the reference heart has the scene's dimensions")
{
    const voile::engine::Mesh heart = scenes::make_reference_heart();
    const voile::engine::Bounds box = voile::engine::bounds(heart);
    check_near(box.min, {3.385, 1.507, 5.958}, 1e-3);
    check_near(box.max, {6.615, 4.534, 8.042}, 1e-3);

    struct Cut
    {
        double y, width, depth;
    };
    for (const Cut& cut : {Cut{1.6, 0.78, 0.82}, Cut{2.6, 2.68, 1.90}, Cut{3.3, 3.23, 2.08}, Cut{4.4, 2.70, 1.29}})
    {
        const glm::dvec2 size = cut_size(heart, cut.y);
        CAPTURE(cut.y);
        CAPTURE(size.x);
        CAPTURE(size.y);
        CHECK(std::abs(size.x / cut.width - 1.) < 0.03);
        CHECK(std::abs(size.y / cut.depth - 1.) < 0.03);
    }
}

TEST_CASE("the reference heart has two lobes with a cleft between them")
{
    const voile::engine::Mesh heart = scenes::make_reference_heart();
    double left = 0;
    double right = 0;
    for (float offset = 0.3f; offset < 1.4f; offset += 0.05f)
    {
        left = std::max(left, top_at(heart, 5.f - offset));
        right = std::max(right, top_at(heart, 5.f + offset));
    }
    CHECK(left > 4.5);
    CHECK(right > 4.5);
    CHECK(top_at(heart, 5.f) < std::min(left, right) - 0.2);
}

TEST_CASE("the drape heart is closed, wound outward and of even triangles")
{
    const voile::engine::Mesh heart = scenes::make_drape_heart();
    CHECK(heart.triangles.size() == 11264);
    CHECK(heart.positions.size() == 5634);
    CHECK(is_closed(heart));
    CHECK(signed_volume(heart) > 0);
    CHECK(edge_ratio(heart) < 10);
    const voile::engine::Bounds box = voile::engine::bounds(heart);
    CHECK(box.min.y == tests::close_to(-0.6, 1e-7));
    CHECK(box.max.y == tests::close_to(0.74, 0.01));
}

TEST_CASE("the drape heart's vertices satisfy its equation")
{
    // f = g^3 - h with |p| < 1.5, |g| < 1.5 near the surface. A coordinate is rounded to a float twice (the cast, the
    // scaling), each by 2^-24 of at most 1.5. |df| <= |grad f| |dp|; |grad g| <= 2 (9/4) |p| < 7, so 3 g^2 |grad g| <
    // 48, and |grad h| <= 5 |p|^4 < 26: together less than 74, times 2 * 1.5 * 2^-24 in each of three coordinates.
    const double bound = 74. * std::sqrt(3.) * 2. * 1.5 * std::ldexp(1., -24);
    for (const glm::vec3& position : scenes::make_drape_heart().positions)
    {
        const glm::dvec3 p = glm::dvec3(position) / double{0.6f};
        const double xx = p.x * p.x;
        const double zz = p.z * p.z;
        const double g = xx + 9. / 4. * zz + p.y * p.y - 1.;
        const double yyy = p.y * p.y * p.y;
        REQUIRE(std::abs(g * g * g - xx * yyy - 9. / 80. * zz * yyy) <= bound);
    }
}

TEST_CASE("the ground is a flat grid that faces up")
{
    const voile::engine::Mesh ground = scenes::make_ground();
    CHECK(ground.positions.size() == 2500);
    CHECK(ground.triangles.size() == 4802);
    const voile::engine::Bounds box = voile::engine::bounds(ground);
    check_near(box.min, {5.08 - 50., 0., 5.08 - 50.}, 1e-5);
    check_near(box.max, {5.08 + 50., 0., 5.08 + 50.}, 1e-5);
    CHECK(total_area(ground) == tests::close_to(10000., 1e-9)); // nothing covered twice
    for (const glm::uvec3& t : ground.triangles)
    {
        const glm::vec3 a = ground.positions[t.x];
        REQUIRE(glm::cross(ground.positions[t.y] - a, ground.positions[t.z] - a).y > 0);
    }
}

TEST_CASE("the jelly starts as the gem and keeps its faces and its volume")
{
    const voile::engine::Mesh gem = scenes::make_gem();
    const voile::engine::Mesh first = scenes::make_jelly(0);
    for (size_t i = 0; i < gem.positions.size(); ++i)
        CHECK(glm::distance(first.positions[i], gem.positions[i] + glm::vec3(0, 0.4f, 0)) < 1e-6f);
    double lowest = 1; // height of the top, m
    for (uint32_t frame = 0; frame < scenes::k_jelly_frames; ++frame)
    {
        const voile::engine::Mesh jelly = scenes::make_jelly(static_cast<double>(frame) / scenes::k_jelly_rate);
        CHECK(jelly.triangles == gem.triangles);
        CHECK(signed_volume(jelly) == tests::close_to(signed_volume(gem), 6e-7)); // faces stay flat
        CHECK(voile::engine::bounds(jelly).min.y > 0);
        lowest = std::min(lowest, double{voile::engine::bounds(jelly).max.y});
    }
    CHECK(lowest < 0.55);
}

TEST_CASE("the gem is closed once its faces are joined, wound outward, and lies between its two radii")
{
    voile::engine::Mesh gem = scenes::make_gem();
    CHECK(gem.triangles.size() == 80);
    std::vector<glm::vec3> points; // each position once
    for (glm::uvec3& t : gem.triangles)
        for (int i = 0; i < 3; ++i)
        {
            const auto found = std::find(points.begin(), points.end(), gem.positions[t[i]]);
            t[i] = static_cast<uint32_t>(found - points.begin());
            if (found == points.end())
                points.push_back(
                    gem.positions[static_cast<size_t>(&t - gem.triangles.data()) * 3 + static_cast<size_t>(i)]);
        }
    gem.positions = points;
    CHECK(points.size() == 42);
    CHECK(is_closed(gem));
    CHECK(signed_volume(gem) > 0.15); // a ball of 0.36 m has 0.195
    for (const glm::vec3& p : points)
        CHECK(std::min(std::abs(glm::length(p) - 0.4f), std::abs(glm::length(p) - 0.36f)) < 1e-6f);
}

TEST_CASE("the figure is closed, walks with its faces and its volume, and its feet stand on the ground")
{
    const scenes::Figure figure;
    const voile::engine::Mesh& rest = figure.at_rest();
    CHECK(is_closed(rest));
    CHECK(voile::count_self_intersections(rest.positions, rest.triangles) == 0);
    const double volume = signed_volume(rest);
    CHECK(volume > 0.04);
    CHECK(volume < 0.08);
    double lowest = 1;
    double highest = -1;
    for (uint32_t frame = 0; frame < scenes::k_walk_frames; ++frame)
    {
        const voile::engine::Mesh mesh = figure.at(static_cast<double>(frame) / scenes::k_walk_frames);
        CHECK(mesh.triangles == rest.triangles);
        CHECK(std::abs(signed_volume(mesh) / volume - 1) < 0.05);
        const voile::engine::Bounds box = voile::engine::bounds(mesh);
        lowest = std::min(lowest, double{box.min.y});
        highest = std::max(highest, double{box.min.y});
        CHECK(box.max.y > 1.6);
    }
    CHECK(lowest > -0.02);
    CHECK(highest < 0.02); // one foot stands at any time
}

TEST_CASE("a foot of the figure does not slide while it stands")
{
    const scenes::Figure figure;
    const voile::engine::Mesh& rest = figure.at_rest();
    size_t sole = 0; // a vertex in the middle of the left foot
    for (size_t i = 0; i < rest.positions.size(); ++i)
        if (glm::distance(rest.positions[i], glm::vec3(0.1f, 0, 0.04f)) <
            glm::distance(rest.positions[sole], glm::vec3(0.1f, 0, 0.04f)))
            sole = i;
    // In the scene, which turns the figure while it walks.
    const auto in_scene = [&](double seconds)
    {
        const double cycle = static_cast<double>(scenes::k_walk_frames) / scenes::k_walk_rate;
        const glm::dvec3 p = figure.at(std::fmod(seconds / cycle, 1)).positions[sole];
        const double angle = glm::radians(-scenes::k_walk_spin) * seconds;
        const double x = p.x + scenes::k_walk_radius;
        return glm::dvec3(x * std::cos(angle) + p.z * std::sin(angle), p.y,
                          p.z * std::cos(angle) - x * std::sin(angle));
    };
    for (const double seconds : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6})
        CHECK(glm::distance(in_scene(seconds), in_scene(0.05)) < 0.002);
    CHECK(glm::distance(in_scene(0.9), in_scene(0.05)) > 0.1);
}

TEST_CASE("the clothes of the figure start outside of it and do not intersect")
{
    const scenes::Figure figure;
    voile::engine::Mesh all = figure.at(0);
    // Where a thigh bends, the figure's own folds may.
    const uint64_t folds = voile::count_self_intersections(all.positions, all.triangles);
    CHECK(folds < 100);
    for (const voile::engine::Mesh& cloth : {scenes::make_skirt(), scenes::make_cape(figure.at(0))})
    {
        const auto first = static_cast<uint32_t>(all.positions.size());
        all.positions.insert(all.positions.end(), cloth.positions.begin(), cloth.positions.end());
        for (const glm::uvec3& t : cloth.triangles)
            all.triangles.push_back(t + first);
    }
    CHECK(voile::count_self_intersections(all.positions, all.triangles) == folds);
}

TEST_CASE("the cape lies on the shoulders of the figure")
{
    const voile::engine::Mesh figure = scenes::Figure().at(0);
    const voile::engine::Mesh cape = scenes::make_cape(figure);
    double farthest = 0; // of what the scene pins, from the figure's vertices
    double across = 0;
    for (const glm::vec3& p : cape.positions)
        if (p.y > 1.4f)
        {
            double nearest = 1;
            for (const glm::vec3& q : figure.positions)
                nearest = std::min(nearest, double{glm::distance(p, q)});
            farthest = std::max(farthest, nearest);
            across = std::max(across, double{p.x});
        }
    CAPTURE(farthest);
    CHECK(farthest < 0.025); // 0.009 from the skin, whose vertices are 0.02 apart
    CHECK(across > 0.12);    // as far as the shoulders
}

TEST_CASE("a curtain starts in pleats, upright and as wide as its fabric")
{
    const voile::engine::Mesh curtain = scenes::make_curtain();
    const voile::engine::Bounds box = voile::engine::bounds(curtain);
    check_near(box.min, {-0.54, -1.84, -0.06}, 0.008);
    check_near(box.max, {0.54, 0, 0.06}, 0.008);
    // Its texture coordinates are its flat pattern, in which each edge has the same length.
    double width = 0;
    for (const glm::uvec3& t : curtain.triangles)
        for (int i = 0; i < 3; ++i)
        {
            const uint32_t a = t[i];
            const uint32_t b = t[(i + 1) % 3];
            const float flat = glm::distance(curtain.texture_coordinates[a], curtain.texture_coordinates[b]);
            CHECK(std::abs(glm::distance(curtain.positions[a], curtain.positions[b]) / flat - 1) < 1e-3);
            width = std::max(width, double{curtain.texture_coordinates[a].x});
        }
    CHECK(width > 1.6 * (box.max.x - box.min.x));
    CHECK(voile::count_self_intersections(curtain.positions, curtain.triangles) == 0);
    // A row never turns back, and all rows lie below the first: it cannot intersect itself.
    std::vector<glm::vec3> top;
    for (const glm::vec3& p : curtain.positions)
        if (p.y == 0)
            top.push_back(p);
    for (size_t i = 1; i < top.size(); ++i)
        CHECK(top[i].x > top[i - 1].x);
    for (size_t i = 0; i < curtain.positions.size(); ++i)
    {
        CHECK(curtain.positions[i].x == top[i % top.size()].x);
        CHECK(curtain.positions[i].z == top[i % top.size()].z);
    }
}
