// Self-intersection of a mesh: every pair of triangles whose boxes overlap, once. All decisions are exact.
#include "voile/mesh_checks.hpp"

#include "geometry/bvh_query.hpp"
#include "geometry/orientation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace voile
{

namespace
{

using Corners = std::array<glm::vec3, 3>;

bool edge_cuts(const Corners& edges, const Corners& face)
{
    std::array<int, 3> sides{};
    for (size_t i = 0; i < 3; ++i)
        sides[i] = orientation(face[0], face[1], face[2], edges[i]);
    for (size_t i = 0; i < 3; ++i)
    {
        const size_t next = (i + 1) % 3;
        if (sides[i] * sides[next] > 0 || (sides[i] == 0 && sides[next] == 0))
            continue;
        // The edge meets the plane in one point: inside, if the line passes all sides of the face in one direction.
        bool left = false;
        bool right = false;
        for (size_t side = 0; side < 3; ++side)
        {
            const int turn = orientation(edges[i], edges[next], face[side], face[(side + 1) % 3]);
            left = left || turn > 0;
            right = right || turn < 0;
        }
        if (!(left && right))
            return true;
    }
    return false;
}

bool share_corner(const glm::uvec3& a, const glm::uvec3& b)
{
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (a[i] == b[j])
                return true;
    return false;
}

} // namespace

uint64_t count_self_intersections(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles)
{
    const auto finite = [&](uint32_t i)
    { return std::isfinite(positions[i].x) && std::isfinite(positions[i].y) && std::isfinite(positions[i].z); };
    std::vector<glm::uvec3> kept;
    std::copy_if(triangles.begin(), triangles.end(), std::back_inserter(kept),
                 [&](const glm::uvec3& t) { return finite(t.x) && finite(t.y) && finite(t.z); });
    if (kept.empty())
        return 0;
    const auto corners = [&](uint32_t t) {
        return Corners{positions[kept[t].x], positions[kept[t].y], positions[kept[t].z]};
    };
    const Bvh bvh = build_bvh(positions, kept);
    uint64_t count = 0;
    for (uint32_t t = 0; t < kept.size(); ++t)
    {
        const Corners own = corners(t);
        const glm::vec3 min = glm::min(glm::min(own[0], own[1]), own[2]);
        const glm::vec3 max = glm::max(glm::max(own[0], own[1]), own[2]);
        visit_box(bvh, min, max,
                  [&](uint32_t other)
                  {
                      if (other <= t || share_corner(kept[t], kept[other]))
                          return;
                      const Corners theirs = corners(other);
                      if (edge_cuts(own, theirs) || edge_cuts(theirs, own))
                          ++count;
                  });
    }
    return count;
}

} // namespace voile
