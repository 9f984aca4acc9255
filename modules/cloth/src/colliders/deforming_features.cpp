#include "colliders/deforming_features.hpp"

#include "colliders/collider_model.hpp"
#include "geometry/closedness.hpp"
#include "geometry/spatial_cell.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
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
constexpr float k_everywhere = std::numeric_limits<float>::infinity();

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
    float sharpness;
    shared::FeatureSource source; // its stand-in: counted as they were found
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
        find_clusters();
        add_vertices();
        find_stand_ins();
        std::vector<uint32_t> order(found_.size());
        std::iota(order.begin(), order.end(), 0u);
        std::ranges::stable_sort(order, {}, [&](uint32_t i) { return found_[i].slot; });
        std::vector<uint32_t> places(found_.size()); // of what was found, in the order
        for (uint32_t i = 0; i < order.size(); ++i)
            places[order[i]] = i;
        for (const uint32_t i : order)
        {
            const Found& found = found_[i];
            uint32_t& slot = result_.slots[found.slot];
            if (slot == 0)
                slot = static_cast<uint32_t>(result_.sources.size()) << VOILE_SLOT_FEATURE_BITS;
            ++slot;
            result_.sources.push_back(found.source);
            result_.sources.back().stand_in = places[found.source.stand_in];
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
            if (glm::distance(positions_[hinge.a], positions_[hinge.b]) <= scale_.finest_spacing() / 2)
                continue;
            const auto n = normals(hinge);
            found_.push_back({owners_[i],
                              1 - glm::dot(n.front(), n.back()),
                              {hinge.a, hinge.b, static_cast<uint32_t>(result_.hinges.size()), 1, k_everywhere, 0}});
            result_.hinges.push_back(hinge);
        }
    }

    void find_clusters()
    {
        std::unordered_map<uint64_t, uint32_t> cells;
        for (uint32_t i = 0; i < hinges_.size(); ++i)
            for (const uint32_t v : {hinges_[i].a, hinges_[i].b})
            {
                const auto [cell, is_new] =
                    cells.emplace(spatial_cell(positions_[v], scale_.finest_spacing()), clusters_.size());
                if (is_new)
                    clusters_.emplace_back();
                Cluster& cluster = clusters_[cell->second];
                if (cluster.hinges.empty() || cluster.hinges.back() != i)
                    cluster.hinges.push_back(i);
                if (1 - cosines_[v] > cluster.sharpness)
                {
                    cluster.sharpness = 1 - cosines_[v];
                    cluster.vertex = v;
                }
            }
    }

    [[nodiscard]] glm::vec3 along(const Found& found) const
    {
        return positions_[found.source.b] - positions_[found.source.a];
    }

    [[nodiscard]] glm::vec3 middle(const Found& found) const
    {
        return 0.5f * (positions_[found.source.a] + positions_[found.source.b]);
    }

    // Whether `other` can do what `found` does, if it is near: vertices, or edges with about the same direction, of
    // which it is not much shorter.
    [[nodiscard]] bool can_stand_in(const Found& other, const Found& found) const
    {
        const glm::vec3 a = along(found);
        const glm::vec3 b = along(other);
        const float own = glm::length(a);
        const float others = glm::length(b);
        if (own == 0 || others == 0)
            return own == others;
        return others >= 0.75f * own && std::abs(glm::dot(a, b)) >= 0.9f * own * others;
    }

    // In grids that are coarser and coarser: the sharpest of each cell stays.
    void find_stand_ins()
    {
        std::vector<uint32_t> left(found_.size());
        std::iota(left.begin(), left.end(), 0u);
        std::ranges::stable_sort(left, std::greater(), [&](uint32_t i) { return found_[i].sharpness; });
        for (float spacing = 2 * scale_.finest_spacing(); spacing <= scale_.edge; spacing *= 2)
        {
            std::unordered_map<uint64_t, std::vector<uint32_t>> cells; // those that stay
            const auto has_stand_in = [&](uint32_t i)
            {
                std::vector<uint32_t>& staying = cells[spatial_cell(middle(found_[i]), spacing)];
                const auto other =
                    std::ranges::find_if(staying, [&](uint32_t j) { return can_stand_in(found_[j], found_[i]); });
                if (other == staying.end())
                {
                    staying.push_back(i);
                    return false;
                }
                found_[i].source.reach = spacing;
                found_[i].source.stand_in = *other;
                return true;
            };
            std::erase_if(left, has_stand_in);
        }
    }

    void add_vertices()
    {
        for (const Cluster& cluster : clusters_)
        {
            found_.push_back({slots_[cluster.vertex],
                              cluster.sharpness,
                              {cluster.vertex, cluster.vertex, static_cast<uint32_t>(result_.hinges.size()),
                               static_cast<uint32_t>(cluster.hinges.size()), k_everywhere, 0}});
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
    std::vector<Cluster> clusters_;            // in the order of their first hinges
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
