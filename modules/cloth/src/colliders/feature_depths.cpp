// Rays into the mesh, from features to what is behind them.
#include "colliders/feature_depths.hpp"

#include "geometry/bvh_query.hpp"
#include "geometry/parallel.hpp"

#include <cmath>

namespace voile
{

namespace
{

constexpr size_t k_depth_piece = 256; // features

// m, at most `limit`: from a point of the feature to the other side, straight ahead and obliquely.
float extent_behind(const Bvh& hierarchy, const shared::Feature& feature, const glm::vec3& point, float limit)
{
    constexpr float k_oblique = 0.45f; // a tangent: cloth in such directions may be inside (feature_response.glsl)
    constexpr float k_inside = 1e-3f;  // of the limit: from there on what the feature lies on is no obstacle
    const bool corner = feature.a == feature.b;
    const glm::vec3 any = std::abs(feature.normal.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    const glm::vec3 along = corner ? glm::cross(feature.normal, any) : feature.b - feature.a;
    const glm::vec3 across = glm::normalize(glm::cross(feature.normal, along));
    const glm::vec3 origin = point - k_inside * limit * feature.normal;
    double extent = limit;
    for (const float tilt : {-k_oblique, 0.f, k_oblique})
        if (const auto hit = nearest_hit(hierarchy, origin, glm::normalize(tilt * across - feature.normal), extent))
            extent = hit->t;
    return static_cast<float>(extent);
}

} // namespace

void find_depths(const Bvh& hierarchy, float longest, std::span<shared::Feature> features)
{
    const auto depth_of = [&](const shared::Feature& feature)
    {
        if (feature.cosine == -1)
            return 0.f; // it faces no direction
        float extent = 2 * longest;
        for (const float part : {0.5f, 0.05f, 0.95f})
            if (part == 0.5f || glm::distance(feature.a, feature.b) > longest)
                extent = extent_behind(hierarchy, feature, glm::mix(feature.a, feature.b, part), extent);
        return extent / 2;
    };
    parallel_for(features.size(), k_depth_piece,
                 [&](size_t first, size_t last)
                 {
                     for (size_t i = first; i < last; ++i)
                         features[i].depth = depth_of(features[i]);
                 });
}

} // namespace voile
