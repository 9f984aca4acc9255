// Ear clipping.
#include "voile/engine/assets/triangulate.hpp"

#include "assets/corner_tree.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace voile::engine
{

namespace
{

// The mean normal of a polygon, its length twice the area (Newell; Sutherland et al. 1974).
glm::dvec3 newell_normal(std::span<const glm::vec3> corners)
{
    glm::dvec3 normal(0.);
    for (size_t i = 0; i < corners.size(); ++i)
    {
        // Relative to the first corner, so that a small polygon far from the origin keeps its digits.
        const glm::dvec3 a = glm::dvec3(corners[i]) - glm::dvec3(corners[0]);
        const glm::dvec3 b = glm::dvec3(corners[(i + 1) % corners.size()]) - glm::dvec3(corners[0]);
        normal += glm::cross(a, b);
    }
    return normal;
}

// Projects along the axis of the normal's largest component, counter-clockwise.
std::vector<glm::dvec2> flatten(std::span<const glm::vec3> corners)
{
    const glm::dvec3 normal = newell_normal(corners);
    const glm::dvec3 size = glm::abs(normal);
    const int along = size.x > size.y && size.x > size.z ? 0 : (size.y > size.z ? 1 : 2);
    int u = (along + 1) % 3;
    int v = (along + 2) % 3;
    if (normal[along] < 0)
        std::swap(u, v);
    std::vector<glm::dvec2> flat;
    flat.reserve(corners.size());
    for (const glm::vec3& corner : corners)
        flat.emplace_back(corner[u], corner[v]);
    return flat;
}

// Cuts off the ear with the shortest cut until a triangle is left. An ear that contains another corner waits: it is
// tested again when that corner has been cut off or the ear's own neighbors have changed. A test searches a tree. So
// the time grows little faster than the number of corners.
class EarClipper
{
public:
    explicit EarClipper(std::span<const glm::dvec2> flat)
        : flat_(flat), tree_(flat), corners_(flat.size()), left_(static_cast<uint32_t>(flat.size()))
    {
        for (uint32_t i = 0; i < left_; ++i)
        {
            corners_[i].before = (i + left_ - 1) % left_;
            corners_[i].after = (i + 1) % left_;
        }
        for (uint32_t i = 0; i < left_; ++i)
            consider(i);
    }

    std::vector<glm::uvec3> run()
    {
        std::vector<glm::uvec3> triangles;
        triangles.reserve(flat_.size() - 2);
        for (; left_ > 3; --left_)
        {
            const uint32_t ear = find_ear();
            triangles.push_back(triangle(ear));
            cut_off(ear);
        }
        triangles.push_back(triangle(corners_[first_left()].after));
        return triangles;
    }

private:
    static constexpr uint32_t k_none = std::numeric_limits<uint32_t>::max();

    struct CornerState
    {
        uint32_t before = 0; // its remaining neighbors
        uint32_t after = 0;
        uint32_t changes = 0; // changes of its neighbors so far
        bool is_cut = false;
        uint32_t waiting = k_none; // the last entry of waiting_ that waits for it
    };

    // A convex corner, valid as long as its neighbors do not change.
    struct Ear
    {
        double cut; // squared length
        uint32_t corner;
        uint32_t changes;

        bool operator>(const Ear& other) const { return cut != other.cut ? cut > other.cut : corner > other.corner; }
    };
    using Ears = std::priority_queue<Ear, std::vector<Ear>, std::greater<>>; // the shortest cut first

    struct Waiting
    {
        Ear ear;
        uint32_t next; // in waiting_, for the same corner
    };

    [[nodiscard]] glm::uvec3 triangle(uint32_t corner) const
    {
        return {corners_[corner].before, corner, corners_[corner].after};
    }

    [[nodiscard]] FlatTriangle flat_triangle(uint32_t corner) const
    {
        return {flat_[corners_[corner].before], flat_[corner], flat_[corners_[corner].after]};
    }

    [[nodiscard]] bool is_current(const Ear& ear) const
    {
        return !corners_[ear.corner].is_cut && corners_[ear.corner].changes == ear.changes;
    }

    uint32_t first_left()
    {
        while (corners_[first_left_].is_cut)
            ++first_left_;
        return first_left_;
    }

    void consider(uint32_t corner)
    {
        const FlatTriangle t = flat_triangle(corner);
        if (turn(t[0], t[1], t[2]) <= 0)
            return;
        const glm::dvec2 cut = t[2] - t[0];
        const Ear ear{glm::dot(cut, cut), corner, corners_[corner].changes};
        convex_.push(ear);
        untested_.push(ear);
    }

    void wait(const Ear& ear, uint32_t awaited)
    {
        waiting_.push_back({ear, corners_[awaited].waiting});
        corners_[awaited].waiting = static_cast<uint32_t>(waiting_.size() - 1);
    }

    uint32_t find_ear()
    {
        while (!untested_.empty())
        {
            const Ear ear = untested_.top();
            untested_.pop();
            if (!is_current(ear))
                continue;
            // Different seeds, so that not all ears wait for the same corner and are retested together.
            const auto obstacle = tree_.find(flat_triangle(ear.corner), ear.corner);
            if (!obstacle)
                return ear.corner;
            wait(ear, *obstacle);
        }
        // The polygon crosses itself or has no area.
        while (!convex_.empty() && !is_current(convex_.top()))
            convex_.pop();
        return convex_.empty() ? first_left() : convex_.top().corner;
    }

    void cut_off(uint32_t corner)
    {
        CornerState& state = corners_[corner];
        state.is_cut = true;
        tree_.remove(corner);
        corners_[state.before].after = state.after;
        corners_[state.after].before = state.before;
        for (const uint32_t neighbor : {state.before, state.after})
        {
            ++corners_[neighbor].changes;
            consider(neighbor);
        }
        for (uint32_t i = state.waiting; i != k_none; i = waiting_[i].next)
            if (is_current(waiting_[i].ear))
                untested_.push(waiting_[i].ear);
    }

    std::span<const glm::dvec2> flat_;
    CornerTree tree_; // the remaining corners
    std::vector<CornerState> corners_;
    Ears convex_;   // all
    Ears untested_; // ears without a known blocking corner
    std::vector<Waiting> waiting_;
    uint32_t left_; // remaining corners
    uint32_t first_left_ = 0;
};

} // namespace

std::vector<glm::uvec3> triangulate(std::span<const glm::vec3> corners)
{
    if (corners.size() == 3)
        return {{0, 1, 2}};
    const std::vector<glm::dvec2> flat = flatten(corners);
    return EarClipper(flat).run();
}

} // namespace voile::engine
