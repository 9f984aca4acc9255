// Selects the feature edges and feature vertices of a mesh.
//
// A triangle is a candidate if the normals around it spread enough (normal_cones.hpp). A smooth mesh has no candidates,
// however many triangles it has. The vertices of an edge between two candidates are features if the angle between them
// is large enough. Where the mesh is narrow, as a wire or a needle, those of every edge with an angle are. Around a
// long edge the mesh must be narrow across the edge, not at its ends: the flats of a cylinder are no features although
// they end at its rims. Of vertices that are close to each other for how much the mesh bends there, one is enough, and
// an edge between two such vertices is no feature itself (FeatureScale::spacing_for).
#include "colliders/mesh_features.hpp"

#include "geometry/closedness.hpp"
#include "geometry/normal_cones.hpp"
#include "geometry/spatial_cell.hpp"
#include "shared/collider_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

namespace voile
{

namespace
{

constexpr float k_flat = 0.035f; // rad; an edge that turns by less is no feature
constexpr float k_any_sag = std::numeric_limits<float>::infinity();

struct Corner
{
    glm::vec3 normal{0.f};      // sum over its triangles, by their angles
    float sag = -1;             // m, of a feature: FeatureScale; the largest of its edges
    bool any_direction = false; // on the border of an open mesh
    float cosine = 1;
};

// One side of an edge: the triangle along it.
struct Side
{
    uint32_t low;
    uint32_t high;
    uint32_t triangle;
    uint32_t opposite; // the triangle's third vertex
    bool upwards;      // it runs from low to high
};

class MeshFeatures
{
public:
    MeshFeatures(const MeshTree& tree, uint32_t flags, const FeatureScale& scale)
        : tree_(tree), scale_(scale), two_sided_((flags & VOILE_COLLIDER_ONE_SIDED) == 0),
          closed_((flags & VOILE_COLLIDER_CLOSED) != 0),
          bend_(std::atan(4 * k_allowed_fraction * scale.thickness / scale.edge)),
          crease_(std::atan(2 * k_allowed_fraction * scale.thickness / scale.edge)), finest_(scale.finest_spacing())
    {
    }

    std::vector<shared::Feature> run()
    {
        select_triangles();
        if (chosen_.empty())
            return {};
        add_normals();
        for (auto first = sides_.begin(); first != sides_.end();)
        {
            auto last = first;
            while (last != sides_.end() && last->low == first->low && last->high == first->high)
                ++last;
            add_edge({first, last});
            first = last;
        }
        add_corners();
        return std::move(features_);
    }

private:
    // Selects the candidates and welds their corners. All triangles of an open mesh are candidates: it may have a
    // border anywhere.
    void select_triangles()
    {
        surroundings_ = surroundings(tree_, scale_.edge, spread_that_counts());
        std::vector<glm::vec3> corners;
        for (uint32_t t = 0; t < tree_.triangles.size(); ++t)
        {
            if (closed_ && surroundings_[t].spread < crease_)
                continue;
            chosen_.push_back(t);
            const shared::BvhTriangle& triangle = tree_.triangles[t];
            corners.insert(corners.end(), {triangle.a, triangle.b, triangle.c});
        }
        positions_ = std::move(corners);
        vertices_ = weld(positions_);
        for (uint32_t i = 0; i < chosen_.size(); ++i)
            for (uint32_t corner = 0; corner < 3; ++corner)
            {
                const uint32_t from = vertices_[3 * i + corner];
                const uint32_t to = vertices_[3 * i + (corner + 1) % 3];
                const uint32_t opposite = vertices_[3 * i + (corner + 2) % 3];
                sides_.push_back({std::min(from, to), std::max(from, to), chosen_[i], opposite, from < to});
            }
        std::sort(sides_.begin(), sides_.end(),
                  [](const Side& a, const Side& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
    }

    // rad: where normals spread by more, the spacing is the finest.
    [[nodiscard]] float spread_that_counts() const
    {
        return std::max(crease_, std::atan(4 * k_allowed_fraction * scale_.thickness / finest_));
    }

    [[nodiscard]] bool bends(uint32_t t) const { return surroundings_[t].narrow && surroundings_[t].spread >= bend_; }

    [[nodiscard]] bool bends_across(const glm::vec3& a, const glm::vec3& b) const
    {
        return glm::distance(a, b) <= finest_ || turn_about(tree_, a, b, scale_.edge / 2, bend_) >= bend_;
    }

    // Normals by angle: Thürmer and Wüthrich 1998, "Computing vertex normals from polygonal facets".
    void add_normals()
    {
        corners_.resize(positions_.size());
        const auto for_each_corner = [&](const auto& visit)
        {
            for (uint32_t i = 0; i < chosen_.size(); ++i)
                for (uint32_t corner = 0; corner < 3; ++corner)
                    visit(vertices_[3 * i + corner], unit_normal(tree_.triangles[chosen_[i]]), angle_at(3 * i, corner));
        };
        for_each_corner([&](uint32_t v, const glm::vec3& normal, float angle)
                        { corners_[v].normal += angle * normal; });
        for (Corner& corner : corners_)
            if (glm::length(corner.normal) > 1e-6f)
                corner.normal = glm::normalize(corner.normal);
            else
                corner.any_direction = true;
        for_each_corner([&](uint32_t v, const glm::vec3& normal, float)
                        { corners_[v].cosine = std::min(corners_[v].cosine, glm::dot(corners_[v].normal, normal)); });
    }

    [[nodiscard]] float angle_at(uint32_t first, uint32_t corner) const
    {
        const glm::vec3 p = positions_[first + corner];
        const glm::vec3 a = glm::normalize(positions_[first + (corner + 1) % 3] - p);
        const glm::vec3 b = glm::normalize(positions_[first + (corner + 2) % 3] - p);
        return std::acos(std::clamp(glm::dot(a, b), -1.f, 1.f));
    }

    void add_edge(std::span<const Side> sides)
    {
        const Side& first = sides.front();
        const glm::vec3 a = positions_[first.low];
        const glm::vec3 b = positions_[first.high];
        if (sides.size() == 1 && closed_)
            return; // its other triangle lies where the mesh is flat
        if (sides.size() != 2)
            return keep_edge(first, {a, 0, b, -1, glm::vec3(0, 1, 0), 0}, k_any_sag);
        const glm::vec3 n = unit_normal(tree_.triangles[first.triangle]);
        const bool agree = first.upwards != sides[1].upwards; // on which side is outside
        const glm::vec3 m = (agree ? 1.f : -1.f) * unit_normal(tree_.triangles[sides[1].triangle]);
        const float turn = std::acos(std::clamp(glm::dot(n, m), -1.f, 1.f));
        const bool convex = glm::dot(n, positions_[sides[1].opposite] - a) < 0;
        if (turn < k_flat || (!convex && !two_sided_))
            return;
        const bool narrow = (bends(first.triangle) || bends(sides[1].triangle)) && bends_across(a, b);
        if (turn / 2 < crease_ && !narrow)
            return;
        const float sag = sag_at(turn, narrow ? widest(sides) : 0);
        const glm::vec3 outwards = n + m;
        if (two_sided_ || glm::length(outwards) < 1e-3f)
            return keep_edge(first, {a, 0, b, -1, glm::vec3(0, 1, 0), 0}, sag);
        const glm::vec3 normal = glm::normalize(outwards);
        keep_edge(first, {a, 0, b, glm::dot(normal, n), normal, 0}, sag);
    }

    // rad: the spread around the triangles at an edge.
    [[nodiscard]] float widest(std::span<const Side> sides) const
    {
        return std::max(surroundings_[sides[0].triangle].spread, surroundings_[sides[1].triangle].spread);
    }

    // m: at an edge that turns by `turn`, rad, where normals spread by `spread`, rad.
    [[nodiscard]] float sag_at(float turn, float spread) const
    {
        constexpr float k_steepest = 1.5f; // rad
        return scale_.edge *
               std::max(std::tan(std::min(turn / 2, k_steepest)) / 2, std::tan(std::min(spread, k_steepest)) / 4);
    }

    void keep_edge(const Side& side, const shared::Feature& edge, float sag)
    {
        for (const uint32_t v : {side.low, side.high})
        {
            corners_[v].sag = std::max(corners_[v].sag, sag);
            corners_[v].any_direction |= edge.cosine == -1;
        }
        if (glm::distance(edge.a, edge.b) > std::max(finest_, scale_.spacing_for(sag)))
            features_.push_back(edge);
    }

    // The finest spacing, doubled as often as the mesh's bends allow.
    [[nodiscard]] float spacing_at(const Corner& corner) const
    {
        float spacing = finest_;
        while (2 * spacing <= scale_.spacing_for(corner.sag))
            spacing *= 2;
        return spacing;
    }

    // The sharpest of each cell of a grid. Corners with different spacings have different grids.
    void add_corners()
    {
        std::map<float, std::unordered_map<uint64_t, uint32_t>> grids;
        for (uint32_t v = 0; v < corners_.size(); ++v)
        {
            if (corners_[v].sag < 0)
                continue;
            const float spacing = spacing_at(corners_[v]);
            const auto [cell, is_new] = grids[spacing].emplace(spatial_cell(positions_[v], spacing), v);
            if (!is_new && sharpness(v) > sharpness(cell->second))
                cell->second = v;
        }
        std::vector<uint32_t> kept;
        for (const auto& [spacing, cells] : grids)
            for (const auto& [cell, v] : cells)
                kept.push_back(v);
        std::sort(kept.begin(), kept.end()); // the order of the table is not defined
        for (const uint32_t v : kept)
        {
            const Corner& corner = corners_[v];
            const bool any = corner.any_direction || two_sided_;
            features_.push_back({positions_[v], 0, positions_[v], any ? -1 : corner.cosine, corner.normal, 0});
        }
    }

    [[nodiscard]] float sharpness(uint32_t v) const { return corners_[v].any_direction ? 2 : 1 - corners_[v].cosine; }

    MeshTree tree_;
    FeatureScale scale_;
    bool two_sided_;
    bool closed_;
    float bend_;   // rad: half of the spread of normals that counts where the mesh is narrow
    float crease_; // rad: half of the angle of an edge that counts by itself
    float finest_; // m: FeatureScale::finest_spacing
    std::vector<Surroundings> surroundings_;
    std::vector<uint32_t> chosen_;     // triangles
    std::vector<glm::vec3> positions_; // three per chosen triangle
    std::vector<uint32_t> vertices_;   // and the first one at the same position
    std::vector<Side> sides_;
    std::vector<Corner> corners_; // of the positions; those that are not the first at theirs are empty
    std::vector<shared::Feature> features_;
};

} // namespace

std::vector<shared::Feature> mesh_features(const Bvh& hierarchy, uint32_t flags, const FeatureScale& scale)
{
    return MeshFeatures({hierarchy.nodes, hierarchy.triangles}, flags, scale).run();
}

} // namespace voile
