// Traversal on the host.
#include "geometry/bvh_query.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace voile
{

namespace
{

// Visits leaves in the order of `entry`, a lower bound of what a box can offer: the first that pass `bound()`.
// entry(min, max) gives that bound, infinite for a box that is missed; visit(triangle) may lower what bound() returns.
template <typename Entry, typename Bound, typename Visit>
void traverse(const Bvh& bvh, const Entry& entry, const Bound& bound, const Visit& visit)
{
    struct Item
    {
        double key;
        uint32_t child;
    };
    std::vector<Item> stack{{0, 0}};
    while (!stack.empty())
    {
        const Item item = stack.back();
        stack.pop_back();
        if (item.key > bound())
            continue;
        if ((item.child & VOILE_BVH_LEAF_BIT) != 0)
        {
            const uint32_t first = item.child & VOILE_BVH_FIRST_MASK;
            const uint32_t count = ((item.child >> VOILE_BVH_COUNT_SHIFT) & VOILE_BVH_COUNT_MASK) + 1;
            for (uint32_t t = first; t < first + count; ++t)
                visit(bvh.triangles[t]);
            continue;
        }
        const shared::BvhNode& node = bvh.nodes[item.child];
        Item near{entry(node.left_min, node.left_max), node.left};
        Item far{entry(node.right_min, node.right_max), node.right};
        if (far.key < near.key)
            std::swap(near, far);
        for (const Item& next : {far, near})
            if (next.key <= bound())
                stack.push_back(next);
    }
}

constexpr double k_miss = std::numeric_limits<double>::infinity();

// The distance at which the ray enters the box, grown by a rounding so that a hit on the box's face is not lost; slabs
// (Kay and Kajiya 1986).
double box_entry(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& min, const glm::dvec3& max)
{
    double enter = 0;
    double leave = k_miss;
    for (int axis = 0; axis < 3; ++axis)
    {
        if (!(min[axis] <= max[axis]))
            return k_miss;
        if (direction[axis] == 0)
        {
            if (origin[axis] < min[axis] || origin[axis] > max[axis])
                return k_miss;
            continue;
        }
        double t0 = (min[axis] - origin[axis]) / direction[axis];
        double t1 = (max[axis] - origin[axis]) / direction[axis];
        if (t0 > t1)
            std::swap(t0, t1);
        enter = std::max(enter, t0 - 1e-12 * std::abs(t0));
        leave = std::min(leave, t1 + 1e-12 * std::abs(t1));
    }
    return enter <= leave ? enter : k_miss;
}

} // namespace

std::optional<double> ray_triangle(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& a,
                                   const glm::dvec3& b, const glm::dvec3& c)
{
    const glm::dvec3 e1 = b - a;
    const glm::dvec3 e2 = c - a;
    const glm::dvec3 p = glm::cross(direction, e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0)
        return std::nullopt;
    const glm::dvec3 s = origin - a;
    const double u = glm::dot(s, p) / determinant;
    const glm::dvec3 q = glm::cross(s, e1);
    const double v = glm::dot(direction, q) / determinant;
    const double t = glm::dot(e2, q) / determinant;
    if (u < 0 || v < 0 || u + v > 1 || t < 0)
        return std::nullopt;
    return t;
}

std::optional<RayHit> nearest_hit(const Bvh& bvh, const glm::dvec3& origin, const glm::dvec3& direction, double limit)
{
    std::optional<RayHit> best;
    traverse(
        bvh, [&](const glm::vec3& min, const glm::vec3& max) { return box_entry(origin, direction, min, max); },
        [&] { return best ? best->t : limit; },
        [&](const shared::BvhTriangle& triangle)
        {
            const auto t = ray_triangle(origin, direction, triangle.a, triangle.b, triangle.c);
            if (t && (best ? *t < best->t : *t <= limit))
                best = RayHit{*t, triangle.index};
        });
    return best;
}

void visit_box(const Bvh& bvh, const glm::vec3& min, const glm::vec3& max, const std::function<void(uint32_t)>& visit)
{
    traverse(
        bvh,
        [&](const glm::vec3& node_min, const glm::vec3& node_max)
        {
            const bool overlap =
                glm::all(glm::lessThanEqual(node_min, max)) && glm::all(glm::lessThanEqual(min, node_max));
            return overlap ? 0 : k_miss;
        },
        [] { return 0.0; }, [&](const shared::BvhTriangle& triangle) { visit(triangle.index); });
}

NearestPoint nearest_on_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    const auto at = [&](const glm::dvec3& point, Feature feature) {
        return NearestPoint{point, glm::distance(p, point), 0, feature};
    };
    const glm::dvec3 ab = b - a;
    const glm::dvec3 ac = c - a;
    const double d1 = glm::dot(ab, p - a);
    const double d2 = glm::dot(ac, p - a);
    if (d1 <= 0 && d2 <= 0)
        return at(a, Feature::corner_0);
    const double d3 = glm::dot(ab, p - b);
    const double d4 = glm::dot(ac, p - b);
    if (d3 >= 0 && d4 <= d3)
        return at(b, Feature::corner_1);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0)
        return at(a + d1 / (d1 - d3) * ab, Feature::edge_0);
    const double d5 = glm::dot(ab, p - c);
    const double d6 = glm::dot(ac, p - c);
    if (d6 >= 0 && d5 <= d6)
        return at(c, Feature::corner_2);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0)
        return at(a + d2 / (d2 - d6) * ac, Feature::edge_2);
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return at(b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), Feature::edge_1);
    return at(a + (vb * ab + vc * ac) / (va + vb + vc), Feature::face);
}

std::optional<NearestPoint> nearest_point(const Bvh& bvh, const glm::dvec3& p, double limit)
{
    std::optional<NearestPoint> best;
    traverse(
        bvh,
        [&](const glm::vec3& min, const glm::vec3& max)
        {
            if (!(min.x <= max.x))
                return k_miss;
            return glm::distance(p, glm::clamp(p, glm::dvec3(min), glm::dvec3(max)));
        },
        [&] { return best ? best->distance : limit; },
        [&](const shared::BvhTriangle& triangle)
        {
            NearestPoint candidate = nearest_on_triangle(p, triangle.a, triangle.b, triangle.c);
            candidate.triangle = triangle.index;
            if (best ? candidate.distance < best->distance : candidate.distance <= limit)
                best = candidate;
        });
    return best;
}

namespace
{

// How the edge from a to b counts for the half line from 0 along +x: 1 if it crosses upwards, -1 if downwards.
int edge_winding(const glm::dvec2& a, const glm::dvec2& b)
{
    const double left = a.x * b.y;
    const double right = b.x * a.y;
    if (a.y <= 0 && b.y > 0 && left > right)
        return 1;
    return a.y > 0 && b.y <= 0 && left < right ? -1 : 0;
}

// Of the part of a triangle above the origin (Sunday 2001, "Inclusion of a point in a polygon").
int winding_above(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    const glm::dvec2 pa(a.z, a.x);
    const glm::dvec2 pb(b.z, b.x);
    const glm::dvec2 pc(c.z, c.x);
    const int winding = edge_winding(pa, pb) + edge_winding(pb, pc) + edge_winding(pc, pa);
    if (winding == 0)
        return 0;
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const auto [lowest, highest] = std::minmax({a.y, b.y, c.y});
    const double height = normal.y == 0 ? lowest : std::clamp(glm::dot(a, normal) / normal.y, lowest, highest);
    return height > 0 ? winding : 0;
}

} // namespace

int line_winding(const Bvh& bvh, const glm::dvec3& p)
{
    const auto entry = [&](const glm::dvec3& min, const glm::dvec3& max)
    {
        const bool reached = min.x <= p.x && p.x <= max.x && min.z <= p.z && p.z <= max.z && p.y <= max.y;
        return reached ? 0 : k_miss;
    };
    int winding = 0;
    traverse(
        bvh, entry, [] { return 0; },
        [&](const shared::BvhTriangle& t)
        { winding += winding_above(glm::dvec3(t.a) - p, glm::dvec3(t.b) - p, glm::dvec3(t.c) - p); });
    return winding;
}

} // namespace voile
