// Checks in double precision whether cloth and collider intersect as surfaces, and how deep. A check of vertices alone
// misses that.
#pragma once

#include "colliders/mesh_input.hpp"
#include "geometry/bvh.hpp"
#include "geometry/bvh_query.hpp"
#include "geometry/closedness.hpp"
#include "voile/engine/assets/mesh.hpp"
#include "voile/engine/gpu/device.hpp"
#include "voile/mesh_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace tests
{

struct Crossings
{
    uint64_t collider_edges = 0; // pairs of a collider's edge and a triangle of the cloth that it pierces
    uint64_t cloth_edges = 0;    // pairs of a cloth's edge and a triangle of the collider that it pierces
    double depth = 0;            // m: of a closed collider, how far the cloth that is cut lies below its surface; of an
                                 // open one, how far the shorter end of an edge of the cloth sticks through

    [[nodiscard]] uint64_t count() const { return collider_edges + cloth_edges; }
};

// Which of its edges a triangle owns, one bit each: an edge of a mesh belongs to the first triangle that has it.
// Vertices at the same position count as one.
inline std::vector<uint8_t> owned_edges(std::span<const uint32_t> welded, std::span<const glm::uvec3> triangles)
{
    std::set<std::pair<uint32_t, uint32_t>> known;
    std::vector<uint8_t> result;
    result.reserve(triangles.size());
    for (const glm::uvec3& t : triangles)
    {
        uint8_t own = 0;
        for (int i = 0; i < 3; ++i)
            if (known.insert(std::minmax({welded[t[i]], welded[t[(i + 1) % 3]]})).second)
                own = static_cast<uint8_t>(own | 1 << i);
        result.push_back(own);
    }
    return result;
}

// For a mesh without coincident vertices.
inline std::vector<uint32_t> all_different(std::span<const glm::uvec3> triangles)
{
    uint32_t count = 0;
    for (const glm::uvec3& t : triangles)
        count = std::max({count, t.x + 1, t.y + 1, t.z + 1});
    std::vector<uint32_t> result(count);
    std::iota(result.begin(), result.end(), 0u);
    return result;
}

// Tests a cloth's triangles against those of a rigid collider. The cloth's positions are in the collider's space.
class CrossingCheck
{
public:
    CrossingCheck(const voile::engine::Mesh& collider, std::span<const glm::uvec3> cloth_triangles)
        : collider_(collider), cloth_(cloth_triangles.begin(), cloth_triangles.end()),
          collider_edges_(owned_edges(voile::weld(collider.positions), collider.triangles)),
          cloth_edges_(owned_edges(all_different(cloth_triangles), cloth_triangles)),
          bvh_(voile::build_bvh(collider.positions, collider.triangles)),
          distance_(voile::engine::take(
              voile::MeshDistance::create({.positions = collider.positions, .triangles = collider.triangles})))
    {
    }

    [[nodiscard]] Crossings count(std::span<const glm::dvec3> positions) const
    {
        Crossings result;
        for (size_t i = 0; i < cloth_.size(); ++i)
        {
            const Corners own{positions[cloth_[i].x], positions[cloth_[i].y], positions[cloth_[i].z]};
            const uint64_t before = result.count();
            const auto visit = [&](uint32_t other) { add_pair(i, own, other, result); };
            voile::visit_box(bvh_, glm::min(own[0], glm::min(own[1], own[2])),
                             glm::max(own[0], glm::max(own[1], own[2])), visit);
            if (distance_.closed() && result.count() > before)
                result.depth = std::max(result.depth, depth_below(own));
        }
        return result;
    }

    [[nodiscard]] const voile::MeshDistance& distance() const { return distance_; }

private:
    using Corners = std::array<glm::dvec3, 3>;

    void add_pair(size_t cloth, const Corners& own, uint32_t other, Crossings& result) const
    {
        const glm::uvec3& t = collider_.triangles[other];
        const Corners theirs{collider_.positions[t.x], collider_.positions[t.y], collider_.positions[t.z]};
        for (size_t i = 0; i < 3; ++i)
        {
            const auto bit = 1u << i;
            if ((collider_edges_[other] & bit) != 0 && cuts(theirs[i], theirs[(i + 1) % 3], own))
                ++result.collider_edges;
            if ((cloth_edges_[cloth] & bit) == 0 || !cuts(own[i], own[(i + 1) % 3], theirs))
                continue;
            ++result.cloth_edges;
            if (!distance_.closed())
                result.depth = std::max(result.depth, shorter_end(own[i], own[(i + 1) % 3], theirs));
        }
    }

    static bool cuts(const glm::dvec3& from, const glm::dvec3& to, const Corners& face)
    {
        const auto t = voile::ray_triangle(from, to - from, face[0], face[1], face[2]);
        return t && *t <= 1;
    }

    static double shorter_end(const glm::dvec3& from, const glm::dvec3& to, const Corners& face)
    {
        const glm::dvec3 normal = glm::normalize(glm::cross(face[1] - face[0], face[2] - face[0]));
        return std::min(std::abs(glm::dot(from - face[0], normal)), std::abs(glm::dot(to - face[0], normal)));
    }

    // The deepest of 28 points of a triangle.
    [[nodiscard]] double depth_below(const Corners& corners) const
    {
        constexpr int k_parts = 6;
        double deepest = 0;
        for (int i = 0; i <= k_parts; ++i)
            for (int j = 0; i + j <= k_parts; ++j)
            {
                const glm::dvec3 point = (static_cast<double>(i) * corners[0] + static_cast<double>(j) * corners[1] +
                                          static_cast<double>(k_parts - i - j) * corners[2]) /
                                         static_cast<double>(k_parts);
                deepest = std::max(deepest, -distance_.nearest(point).signed_distance);
            }
        return deepest;
    }

    voile::engine::Mesh collider_;
    std::vector<glm::uvec3> cloth_;
    std::vector<uint8_t> collider_edges_;
    std::vector<uint8_t> cloth_edges_;
    voile::Bvh bvh_;
    voile::MeshDistance distance_;
};

} // namespace tests
