// The features of all colliders, and the hierarchies over them.
#include "colliders/collider_features.hpp"

#include "colliders/collider_model.hpp"
#include "colliders/feature_depths.hpp"
#include "colliders/mesh_features.hpp"
#include "geometry/bvh.hpp"

#include <algorithm>

namespace voile
{

namespace
{

// Whether a chord between two vertices on something round of this radius sinks towards it by more than is allowed.
bool is_thin(float radius, const FeatureScale& scale)
{
    return 8 * k_allowed_fraction * scale.thickness * radius < scale.edge * scale.edge;
}

std::vector<shared::Feature> box_features(const shared::ColliderRecord& record)
{
    const glm::vec3 half(record.shape);
    std::vector<shared::Feature> features; // their depths along the diagonals
    for (int corner = 0; corner < 8; ++corner)
    {
        const glm::vec3 sign((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
        const glm::vec3 position = sign * half;
        const float corner_depth = std::sqrt(3.f) * std::min({half.x, half.y, half.z});
        features.push_back({position, 0, position, std::sqrt(1 / 3.f), glm::normalize(sign), corner_depth});
        for (int axis = 0; axis < 3; ++axis)
        {
            if (sign[axis] > 0)
                continue; // an edge from each corner at the lower end of its axis
            glm::vec3 other = position;
            other[axis] += 2 * half[axis];
            glm::vec3 outwards = sign;
            outwards[axis] = 0;
            const float depth = std::sqrt(2.f) * std::min(half[(axis + 1) % 3], half[(axis + 2) % 3]);
            features.push_back({position, 0, other, std::sqrt(0.5f), glm::normalize(outwards), depth});
        }
    }
    return features;
}

// Pushes in all directions.
shared::Feature round_feature(const glm::vec3& a, const glm::vec3& b, float radius)
{
    return {a, radius, b, -1, glm::vec3(0, 1, 0), 0};
}

std::vector<shared::Feature> features_of(const ColliderModel& collider, const FeatureScale& scale)
{
    const shared::ColliderRecord& record = collider.record;
    if (scale.edge == 0)
        return {};
    const glm::vec3 end(record.shape); // of a capsule
    const float radius = record.shape.w;
    switch (record.kind)
    {
    case VOILE_COLLIDER_MESH:
    {
        if (!collider.hierarchy)
            return {};
        std::vector<shared::Feature> features = mesh_features(*collider.hierarchy, record.flags, scale);
        if ((record.flags & VOILE_COLLIDER_CLOSED) != 0)
            find_depths(*collider.hierarchy, scale.edge, features);
        return features;
    }
    case VOILE_COLLIDER_BOX:
        return box_features(record);
    case VOILE_COLLIDER_SPHERE:
        if (is_thin(radius, scale))
            return {round_feature(glm::vec3(0), glm::vec3(0), radius)};
        return {};
    case VOILE_COLLIDER_CAPSULE:
        if (is_thin(radius, scale))
            return {round_feature(-end, -end, radius), round_feature(-end, end, radius),
                    round_feature(end, end, radius)};
        return {};
    default:
        return {};
    }
}

// The same mesh, with the same sides.
bool same_mesh(const ColliderModel& a, const ColliderModel& b)
{
    constexpr uint32_t k_flags = VOILE_COLLIDER_CLOSED | VOILE_COLLIDER_ONE_SIDED;
    return a.hierarchy && a.hierarchy == b.hierarchy && ((a.record.flags ^ b.record.flags) & k_flags) == 0;
}

} // namespace

FeatureScale feature_scale(const Model& model, uint32_t layers)
{
    FeatureScale scale;
    for (const auto [index, cloth] : model.cloths)
    {
        if ((cloth.record.layers & layers) == 0)
            continue;
        const float thickness = cloth.record.thickness;
        scale.thickness = scale.edge == 0 ? thickness : std::min(scale.thickness, thickness);
        scale.edge = std::max(scale.edge, cloth.longest_edge);
    }
    return scale;
}

ColliderFeatures make_features(const ColliderModel& collider, const FeatureScale& scale)
{
    ColliderFeatures result;
    result.scale = scale;
    result.set.edge = scale.edge;
    if (collider.deforming)
    {
        result.deforming = deforming_features(*collider.deforming, collider.record, scale);
        result.set.features = static_cast<uint32_t>(result.deforming.sources.size());
        return result;
    }
    const std::vector<shared::Feature> features = features_of(collider, scale);
    if (features.empty())
        return result;
    result.set.features = static_cast<uint32_t>(features.size());
    std::vector<glm::vec3> corners; // of triangles that have the boxes of the features
    std::vector<glm::uvec3> triangles;
    for (const shared::Feature& feature : features)
    {
        const auto first = static_cast<uint32_t>(corners.size());
        corners.push_back(glm::min(feature.a, feature.b) - feature.radius);
        corners.push_back(glm::max(feature.a, feature.b) + feature.radius);
        triangles.emplace_back(first, first + 1, first + 1);
    }
    Bvh bvh = build_bvh(corners, triangles);
    result.features.reserve(features.size()); // ordered by the leaves
    for (const shared::BvhTriangle& triangle : bvh.triangles)
        result.features.push_back(features[triangle.index]);
    const shared::BvhNode& root = bvh.nodes.front();
    result.set.box_min = glm::min(root.left_min, root.right_min);
    result.set.box_max = glm::max(root.left_max, root.right_max);
    result.nodes = std::move(bvh.nodes);
    return result;
}

bool needs_features(const ColliderModel& collider, const Model& model)
{
    return collider.features_due || !collider.features ||
           !covers(collider.features->scale, feature_scale(model, collider.record.layers));
}

void update_features(ColliderModels& colliders, const Model& model)
{
    for (auto [index, collider] : colliders.colliders)
    {
        if (!needs_features(collider, model))
            continue;
        const FeatureScale scale = feature_scale(model, collider.record.layers);
        std::shared_ptr<const ColliderFeatures> found;
        for (const auto [other_index, other] : colliders.colliders)
            if (other.features && other.features->scale == scale && same_mesh(collider, other))
                found = other.features;
        if (!found)
            found = std::make_shared<const ColliderFeatures>(make_features(collider, scale));
        const DeformingFeatures& deforming = found->deforming;
        colliders.features.acquire(found,
                                   {found->nodes.size(), found->features.size(), deforming.sources.size(),
                                    deforming.hinges.size(), deforming.slots.size(), 2 * deforming.sources.size()});
        colliders.features.release(collider.features.get());
        collider.features = std::move(found);
        collider.features_due = false;
        collider.features_new = true;
    }
}

} // namespace voile
