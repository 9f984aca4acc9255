// Which parts of a closed mesh lie in others: parallel rays from their vertices cross the parts around them.
#include "geometry/mesh_parts.hpp"

#include "geometry/bvh_split.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace voile
{

namespace
{

// The two farthest vertices of a part along each axis: 2 * axis for the lower end, and the upper one.
struct Extent
{
    std::array<uint32_t, 6> vertices{};
    Box box;
};

std::vector<Extent> extents_of(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                               const MeshParts& parts)
{
    std::vector<Extent> extents(parts.count);
    for (size_t t = 0; t < triangles.size(); ++t)
    {
        Extent& extent = extents[parts.of_triangles[t]];
        for (int corner = 0; corner < 3; ++corner)
        {
            const uint32_t vertex = triangles[t][corner];
            const glm::vec3& p = positions[vertex];
            for (int axis = 0; axis < 3; ++axis)
            {
                const auto end = 2 * static_cast<size_t>(axis);
                if (p[axis] < extent.box.min[axis])
                    extent.vertices[end] = vertex;
                if (p[axis] > extent.box.max[axis])
                    extent.vertices[end + 1] = vertex;
            }
            extent.box.add(p);
        }
    }
    return extents;
}

bool holds(const Box& outer, const Box& inner)
{
    return glm::all(glm::lessThanEqual(outer.min, inner.min)) && glm::all(glm::greaterThanEqual(outer.max, inner.max));
}

// The direction of the rays and the axes across them. Rays run along the shortest axis, so they cross few triangles;
// vertices are sorted along the longest axis.
struct Axes
{
    int ray = 0;
    int across = 0;
    int sorted = 0;
};

Axes axes_of(std::span<const Extent> extents)
{
    Box whole;
    for (const Extent& extent : extents)
        whole.add(extent.box);
    const glm::vec3 size = whole.max - whole.min;
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int a, int b) { return size[a] < size[b]; });
    return {order[0], order[1], order[2]};
}

using Corners = std::array<glm::dvec3, 3>;

// How often the triangle, seen along the rays, winds around a point: 0, or 1 or -1 for its two sides. What an edge adds
// is the same, to the bit, for both of its triangles: no ray passes between them, and none hits both.
int winding(const Axes& axes, const Corners& corners, const glm::dvec3& p)
{
    int result = 0;
    for (size_t i = 0; i < 3; ++i)
    {
        const glm::dvec3& a = corners[i];
        const glm::dvec3& b = corners[(i + 1) % 3];
        const bool upwards = b[axes.sorted] > p[axes.sorted];
        if (upwards == (a[axes.sorted] > p[axes.sorted]))
            continue;
        const glm::dvec3& low = upwards ? a : b;
        const glm::dvec3 edge = (upwards ? b : a) - low;
        const double fraction = (p[axes.sorted] - low[axes.sorted]) / edge[axes.sorted];
        if (low[axes.across] + fraction * edge[axes.across] > p[axes.across])
            result += upwards ? 1 : -1;
    }
    return result;
}

// Whether the triangle's plane lies before the point, as its ray goes. Within the triangle's own bounds, so that a
// plane along the ray takes it nowhere.
bool before(const Axes& axes, const Corners& corners, const glm::dvec3& p)
{
    const glm::dvec3& a = corners[0];
    const glm::dvec3 n = glm::cross(corners[1] - a, corners[2] - a);
    const double slope =
        n[axes.sorted] * (p[axes.sorted] - a[axes.sorted]) + n[axes.across] * (p[axes.across] - a[axes.across]);
    const auto [low, high] = std::minmax({a[axes.ray], corners[1][axes.ray], corners[2][axes.ray]});
    return std::clamp(a[axes.ray] - slope / n[axes.ray], low, high) > p[axes.ray];
}

// From a vertex of a part.
struct Ray
{
    glm::dvec3 from;
    uint32_t part;
    int winding = 0; // of another part around the vertex
};

class Enclosures
{
public:
    Enclosures(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles, const MeshParts& parts)
        : extents_(extents_of(positions, triangles, parts)), axes_(axes_of(extents_)), rays_(parts.count)
    {
        find_rays(positions);
        for (size_t t = 0; t < triangles.size(); ++t)
            if (std::vector<Ray>& rays = rays_[parts.of_triangles[t]]; !rays.empty())
                cross({positions[triangles[t].x], positions[triangles[t].y], positions[triangles[t].z]}, rays);
    }

    [[nodiscard]] std::vector<std::vector<uint32_t>> result() const
    {
        std::vector<std::vector<uint32_t>> enclosing(extents_.size());
        std::vector<uint32_t> inside(extents_.size()); // how many of a part's vertices are
        for (uint32_t outer = 0; outer < rays_.size(); ++outer)
        {
            for (const Ray& ray : rays_[outer])
                inside[ray.part] = 0;
            for (const Ray& ray : rays_[outer])
                if (ray.winding != 0 && ++inside[ray.part] == extents_[ray.part].vertices.size())
                    enclosing[ray.part].push_back(outer);
        }
        return enclosing;
    }

private:
    // For each part, from all those whose boxes lie in its own.
    void find_rays(std::span<const glm::vec3> positions)
    {
        const auto begin_of = [&](uint32_t part) { return extents_[part].box.min[axes_.sorted]; };
        std::vector<uint32_t> order(extents_.size());
        std::iota(order.begin(), order.end(), 0u);
        std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return begin_of(a) < begin_of(b); });
        for (uint32_t outer = 0; outer < extents_.size(); ++outer)
        {
            const Box& box = extents_[outer].box;
            auto inner = std::lower_bound(order.begin(), order.end(), begin_of(outer),
                                          [&](uint32_t part, float value) { return begin_of(part) < value; });
            for (; inner != order.end() && begin_of(*inner) <= box.max[axes_.sorted]; ++inner)
                if (*inner != outer && holds(box, extents_[*inner].box))
                    for (const uint32_t vertex : extents_[*inner].vertices)
                        rays_[outer].push_back({positions[vertex], *inner});
            std::sort(rays_[outer].begin(), rays_[outer].end(),
                      [&](const Ray& a, const Ray& b) { return a.from[axes_.sorted] < b.from[axes_.sorted]; });
        }
    }

    // Adds the winding of a triangle to the rays that hit it.
    void cross(const Corners& corners, std::vector<Ray>& rays) const
    {
        const auto [low, high] =
            std::minmax({corners[0][axes_.sorted], corners[1][axes_.sorted], corners[2][axes_.sorted]});
        auto ray = std::lower_bound(rays.begin(), rays.end(), low,
                                    [&](const Ray& r, double value) { return r.from[axes_.sorted] < value; });
        for (; ray != rays.end() && ray->from[axes_.sorted] <= high; ++ray)
        {
            const int sides = winding(axes_, corners, ray->from);
            if (sides != 0 && before(axes_, corners, ray->from))
                ray->winding += sides;
        }
    }

    std::vector<Extent> extents_;
    Axes axes_;
    std::vector<std::vector<Ray>> rays_; // for each part, those that it may enclose
};

} // namespace

std::vector<std::vector<uint32_t>> enclosing_parts(std::span<const glm::vec3> positions,
                                                   std::span<const glm::uvec3> triangles, const MeshParts& parts)
{
    return Enclosures(positions, triangles, parts).result();
}

} // namespace voile
