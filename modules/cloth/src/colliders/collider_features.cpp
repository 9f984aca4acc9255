// The features of all colliders: primitives, and the hierarchies over what there is.
#include "colliders/collider_features.hpp"

#include "colliders/mesh_features.hpp"
#include "geometry/bvh.hpp"

#include <algorithm>

namespace voile
{

namespace
{

using shared::Feature;

float longest_edge(const Model& model, uint32_t index)
{
    const ClothModel& cloth = model.cloths[index];
    if (!cloth.mesh)
        return glm::length(cloth.spacing); // the diagonal of a cell, whose triangles have it as a side
    float longest = 0;
    const auto place = [&](uint32_t vertex)
    { return glm::vec3(model.start[model.records[index].first_vertex + vertex]); };
    for (const glm::uvec3& t : cloth.triangles)
        for (int corner = 0; corner < 3; ++corner)
            longest = std::max(longest, glm::distance(place(t[corner]), place(t[(corner + 1) % 3])));
    return longest;
}

// Whether a chord between two vertices on something round of this radius sinks towards it by more than is allowed.
bool is_thin(float radius, const FeatureScale& scale)
{
    return 8 * k_allowed_share * scale.thickness * radius < scale.edge * scale.edge;
}

std::vector<Feature> box_features(const shared::ColliderRecord& record)
{
    const glm::vec3 half(record.shape);
    std::vector<Feature> features;
    for (int corner = 0; corner < 8; ++corner)
    {
        const glm::vec3 sign((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
        const glm::vec3 place = sign * half;
        features.push_back({place, 0, place, std::sqrt(1 / 3.f), glm::normalize(sign), 0});
        for (int axis = 0; axis < 3; ++axis)
        {
            if (sign[axis] > 0)
                continue; // an edge from each corner at the lower end of its axis
            glm::vec3 other = place;
            other[axis] += 2 * half[axis];
            glm::vec3 outwards = sign;
            outwards[axis] = 0;
            features.push_back({place, 0, other, std::sqrt(0.5f), glm::normalize(outwards), 0});
        }
    }
    return features;
}

// Pushes in all directions.
Feature round_feature(const glm::vec3& a, const glm::vec3& b, float radius)
{
    return {a, radius, b, -1, glm::vec3(0, 1, 0), 0};
}

std::vector<Feature> features_of(const Model& model, const shared::ColliderRecord& record, const FeatureScale& scale)
{
    if (scale.edge == 0)
        return {};
    const glm::vec3 end(record.shape); // of a capsule
    const float radius = record.shape.w;
    switch (record.kind)
    {
    case VOILE_COLLIDER_MESH:
        return mesh_features(model, record, scale);
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

// Appends them, ordered by the leaves of a hierarchy over their boxes.
void append(FeatureLists& lists, const std::vector<Feature>& features, float edge)
{
    shared::FeatureSet set{};
    set.edge = edge;
    if (features.empty())
    {
        lists.sets.push_back(set);
        return;
    }
    set.first_node = static_cast<uint32_t>(lists.nodes.size());
    set.first_feature = static_cast<uint32_t>(lists.features.size());
    set.features = static_cast<uint32_t>(features.size());
    std::vector<glm::vec3> corners; // of triangles that have the boxes of the features
    std::vector<glm::uvec3> triangles;
    for (const Feature& feature : features)
    {
        const auto first = static_cast<uint32_t>(corners.size());
        corners.push_back(glm::min(feature.a, feature.b) - feature.radius);
        corners.push_back(glm::max(feature.a, feature.b) + feature.radius);
        triangles.emplace_back(first, first + 1, first + 1);
    }
    const Bvh bvh = build_bvh(corners, triangles);
    for (const shared::BvhTriangle& triangle : bvh.triangles)
        lists.features.push_back(features[triangle.index]);
    const shared::BvhNode& root = bvh.nodes.front();
    set.box_min = glm::min(root.left_min, root.right_min);
    set.box_max = glm::max(root.left_max, root.right_max);
    lists.nodes.insert(lists.nodes.end(), bvh.nodes.begin(), bvh.nodes.end());
    lists.sets.push_back(set);
}

} // namespace

FeatureScale feature_scale(const Model& model, uint32_t layers)
{
    FeatureScale scale;
    for (uint32_t c = 0; c < model.records.size(); ++c)
    {
        if ((model.records[c].layers & layers) == 0)
            continue;
        const float thickness = model.records[c].thickness;
        scale.thickness = scale.edge == 0 ? thickness : std::min(scale.thickness, thickness);
        scale.edge = std::max(scale.edge, longest_edge(model, c));
    }
    return scale;
}

FeatureLists find_features(const Model& model)
{
    FeatureLists lists;
    for (const shared::ColliderRecord& record : model.colliders)
    {
        const FeatureScale scale = feature_scale(model, record.layers);
        append(lists, features_of(model, record, scale), scale.edge);
    }
    return lists;
}

} // namespace voile
