#include "colliders/deforming_features.hpp"

#include "colliders/collider_model.hpp"
#include "geometry/closedness.hpp"
#include "geometry/spatial_cell.hpp"

#include <algorithm>
#include <unordered_map>

namespace voile
{

namespace
{

// One side of an edge: a triangle along it.
struct Side
{
    uint64_t edge; // both vertices, the smaller one first
    uint32_t slot;
    uint32_t from; // the triangle runs from here to `to`
    uint32_t to;
    uint32_t opposite;
};

constexpr uint32_t k_no_slot = UINT32_MAX;

// The vertices of a cell that are one feature.
struct Cluster
{
    uint32_t vertex = 0; // the sharpest
    float sharpness = -1;
    std::vector<uint32_t> hinges;
};

// A feature before features are ordered by slots.
struct Found
{
    uint32_t slot;
    shared::FeatureSource source;
};

class DeformingFeatureFinder
{
public:
    DeformingFeatureFinder(const DeformingMesh& mesh, uint32_t triangles, const FeatureScale& scale)
        : positions_(mesh.positions), scale_(scale), welded_(weld(mesh.positions)),
          slots_(mesh.positions.size(), k_no_slot), normals_(mesh.positions.size(), glm::vec3(0)),
          cosines_(mesh.positions.size(), 1.f)
    {
        result_.slots.resize(mesh.leaves.size());
        for (uint32_t slot = 0; slot < triangles; ++slot)
            add_triangle(slot, mesh.leaves[slot].corners);
        std::ranges::stable_sort(sides_, {}, &Side::edge);
    }

    DeformingFeatures find()
    {
        find_hinges();
        add_edges();
        add_vertices();
        std::ranges::stable_sort(found_, {}, &Found::slot);
        for (const Found& found : found_)
        {
            uint32_t& slot = result_.slots[found.slot];
            if (slot == 0)
                slot = static_cast<uint32_t>(result_.sources.size()) << VOILE_SLOT_FEATURE_BITS;
            ++slot;
            result_.sources.push_back(found.source);
        }
        return std::move(result_);
    }

private:
    void add_triangle(uint32_t slot, const glm::uvec3& corners)
    {
        for (int side = 0; side < 3; ++side)
        {
            const uint32_t from = welded_[corners[side]];
            const uint32_t to = welded_[corners[(side + 1) % 3]];
            const auto [low, high] = std::minmax(from, to);
            sides_.push_back({uint64_t{low} << 32 | high, slot, from, to, welded_[corners[(side + 2) % 3]]});
            slots_[from] = std::min(slots_[from], slot);
        }
    }

    [[nodiscard]] glm::vec3 normal(uint32_t a, uint32_t b, uint32_t c) const
    {
        const glm::vec3 n = glm::cross(positions_[b] - positions_[a], positions_[c] - positions_[a]);
        return n / std::max(glm::length(n), 1e-30f);
    }

    // The normals on both sides; of a border twice the same.
    [[nodiscard]] std::array<glm::vec3, 2> normals(const shared::FeatureHinge& hinge) const
    {
        const glm::vec3 first = normal(hinge.a, hinge.b, hinge.c);
        return {first, hinge.d == VOILE_NO_VERTEX ? first : normal(hinge.b, hinge.a, hinge.d)};
    }

    void find_hinges()
    {
        for (auto first = sides_.begin(); first != sides_.end();)
        {
            const auto last = std::find_if(first, sides_.end(), [&](const Side& s) { return s.edge != first->edge; });
            const bool two = last - first == 2;
            hinges_.push_back({first->from, first->to, first->opposite, two ? first[1].opposite : VOILE_NO_VERTEX});
            owners_.push_back(first->slot);
            first = last;
        }
        for (const shared::FeatureHinge& hinge : hinges_)
            for (const glm::vec3& n : normals(hinge))
                for (const uint32_t v : {hinge.a, hinge.b})
                    normals_[v] += n;
        for (const shared::FeatureHinge& hinge : hinges_)
            for (const glm::vec3& n : normals(hinge))
                for (const uint32_t v : {hinge.a, hinge.b})
                    cosines_[v] =
                        std::min(cosines_[v], glm::dot(n, normals_[v]) / std::max(glm::length(normals_[v]), 1e-30f));
    }

    void add_edges()
    {
        for (size_t i = 0; i < hinges_.size(); ++i)
        {
            const shared::FeatureHinge& hinge = hinges_[i];
            if (glm::distance(positions_[hinge.a], positions_[hinge.b]) <= scale_.spacing() / 2)
                continue;
            found_.push_back({owners_[i], {hinge.a, hinge.b, static_cast<uint32_t>(result_.hinges.size()), 1}});
            result_.hinges.push_back(hinge);
        }
    }

    void add_vertices()
    {
        std::unordered_map<uint64_t, uint32_t> cells;
        std::vector<Cluster> clusters; // in the order of their first hinges
        for (uint32_t i = 0; i < hinges_.size(); ++i)
            for (const uint32_t v : {hinges_[i].a, hinges_[i].b})
            {
                const auto [cell, is_new] =
                    cells.emplace(spatial_cell(positions_[v], scale_.spacing()), clusters.size());
                if (is_new)
                    clusters.emplace_back();
                Cluster& cluster = clusters[cell->second];
                if (cluster.hinges.empty() || cluster.hinges.back() != i)
                    cluster.hinges.push_back(i);
                if (1 - cosines_[v] > cluster.sharpness)
                {
                    cluster.sharpness = 1 - cosines_[v];
                    cluster.vertex = v;
                }
            }
        for (const Cluster& cluster : clusters)
        {
            found_.push_back({slots_[cluster.vertex],
                              {cluster.vertex, cluster.vertex, static_cast<uint32_t>(result_.hinges.size()),
                               static_cast<uint32_t>(cluster.hinges.size())}});
            for (const uint32_t hinge : cluster.hinges)
                result_.hinges.push_back(hinges_[hinge]);
        }
    }

    const std::vector<glm::vec3>& positions_;
    FeatureScale scale_;
    std::vector<uint32_t> welded_;
    std::vector<uint32_t> slots_; // of each vertex the first one that has it
    std::vector<Side> sides_;
    std::vector<shared::FeatureHinge> hinges_; // of all edges
    std::vector<uint32_t> owners_;             // of their slots
    std::vector<glm::vec3> normals_;           // of the vertices: sums
    std::vector<float> cosines_;               // of the largest angle between that and the normal of a triangle
    std::vector<Found> found_;
    DeformingFeatures result_;
};

} // namespace

DeformingFeatures deforming_features(const DeformingMesh& mesh, const shared::ColliderRecord& record,
                                     const FeatureScale& scale)
{
    if (scale.edge == 0)
        return {};
    return DeformingFeatureFinder(mesh, record.triangles, scale).find();
}

} // namespace voile
