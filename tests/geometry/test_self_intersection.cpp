// Pairs of triangles of a mesh that intersect, against separating axes in whole numbers.
#include "geometry/orientation.hpp"
#include "support/exact_intersections.hpp"
#include "voile/mesh_checks.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

namespace
{

using Random = std::mt19937;

int exact_orientation(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d)
{
    using tests::whole;
    const tests::WholeVector origin = whole(d);
    return dot(cross(whole(a) - origin, whole(b) - origin), whole(c) - origin).sign();
}

bool lies_in_plane(const tests::TriangleCorners& points, const tests::TriangleCorners& plane)
{
    return std::none_of(points.begin(), points.end(),
                        [&](const glm::vec3& p) { return exact_orientation(plane[0], plane[1], plane[2], p) != 0; });
}

bool an_edge_meets(const tests::TriangleCorners& edges, const tests::TriangleCorners& face)
{
    for (size_t i = 0; i < 3; ++i)
        if (tests::intersect_by_axes({edges[i], edges[(i + 1) % 3]}, face))
            return true;
    return false;
}

struct Counts
{
    uint64_t intersecting = 0;
    uint64_t in_plane = 0; // of triangles that meet within a plane
};

Counts exact_counts(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles)
{
    Counts counts;
    const auto corners = [&](const glm::uvec3& t) {
        return tests::TriangleCorners{positions[t.x], positions[t.y], positions[t.z]};
    };
    for (size_t i = 0; i < triangles.size(); ++i)
        for (size_t j = 0; j < i; ++j)
        {
            const auto a = corners(triangles[i]);
            const auto b = corners(triangles[j]);
            if (!an_edge_meets(a, b) && !an_edge_meets(b, a))
                continue;
            ++(lies_in_plane(a, b) && lies_in_plane(b, a) ? counts.in_plane : counts.intersecting);
        }
    return counts;
}

// Points near each other, in general position, in few planes, or in planes that rounding bends.
const std::vector<std::function<glm::vec3(Random&)>> k_points{
    [](Random& random)
    {
        std::uniform_real_distribution<float> at(-1, 1);
        return glm::vec3(at(random), at(random), at(random));
    },
    [](Random& random)
    {
        std::uniform_int_distribution<int> at(0, 3);
        return 0.1f * glm::vec3(at(random), at(random), at(random));
    },
    [](Random& random)
    {
        std::uniform_int_distribution<int> at(0, 4);
        const float along = static_cast<float>(at(random));
        return glm::vec3(0.3f * along, 0.7f * static_cast<float>(at(random)), 0.1f * along + 0.2f);
    },
};

} // namespace

TEST_CASE("the side of a plane is exact, whatever the points")
{
    Random random(7);
    std::uniform_int_distribution<int> exponent(-149, 127);
    size_t in_plane = 0;
    for (int i = 0; i < 3000; ++i)
    {
        glm::vec3 p[4];
        for (glm::vec3& point : p)
        {
            point = k_points[static_cast<size_t>(i) % 3](random);
            if (i % 5 == 0) // over the whole range of float
                for (int axis = 0; axis < 3; ++axis)
                    point[axis] = std::ldexp(point[axis], exponent(random));
        }
        const int exact = exact_orientation(p[0], p[1], p[2], p[3]);
        in_plane += exact == 0 ? 1 : 0;
        CHECK(voile::orientation(p[0], p[1], p[2], p[3]) == exact);
    }
    CHECK(in_plane > 300);
    CHECK(in_plane < 2700);
}

TEST_CASE("triangles that intersect or touch are counted, those in one plane are not")
{
    Random random(11);
    Counts all;
    for (int soup = 0; soup < 30; ++soup)
    {
        std::vector<glm::vec3> positions;
        std::vector<glm::uvec3> triangles;
        for (uint32_t i = 0; i < 20; ++i)
        {
            for (int corner = 0; corner < 3; ++corner)
                positions.push_back(k_points[static_cast<size_t>(soup) % 3](random));
            triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
        }
        const Counts counts = exact_counts(positions, triangles);
        CAPTURE(soup);
        CHECK(voile::count_self_intersections(positions, triangles) == counts.intersecting);
        all.intersecting += counts.intersecting;
        all.in_plane += counts.in_plane;
    }
    CHECK(all.intersecting > 1000);
    CHECK(all.in_plane > 100);
}

TEST_CASE("a flat strip that stands at an angle does not intersect itself")
{
    // Its triangles lie in one plane up to rounding, and are apart or have a common corner.
    for (const float angle : {0.1f, 0.7f, 1.1f, 2.3f})
    {
        std::vector<glm::vec3> positions;
        std::vector<glm::uvec3> triangles;
        for (uint32_t row = 0; row < 40; ++row)
            for (uint32_t column = 0; column < 4; ++column)
            {
                const float along = 0.017f * static_cast<float>(column);
                positions.emplace_back(0.3f + along * std::cos(angle), -0.039f * static_cast<float>(row),
                                       along * std::sin(angle));
                const uint32_t v = 4 * row + column;
                if (row > 0 && column > 0)
                    triangles.insert(triangles.end(), {{v - 5, v - 1, v - 4}, {v - 4, v - 1, v}});
            }
        CHECK(voile::count_self_intersections(positions, triangles) == 0);
    }
}
