// Ear clipping.
#include "engine/assets/triangulate.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace engine
{

namespace
{

// The mean normal of a polygon, as long as twice its area (Newell; Sutherland et al. 1974).
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

// Seen along the axis in which the normal is longest, counter-clockwise.
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

// Twice the area of a triangle; positive if it is counter-clockwise.
double turn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

class EarClipper
{
public:
    explicit EarClipper(std::vector<glm::dvec2> flat) : flat_(std::move(flat)), left_(flat_.size())
    {
        std::iota(left_.begin(), left_.end(), 0u);
    }

    std::vector<glm::uvec3> run()
    {
        std::vector<glm::uvec3> triangles;
        triangles.reserve(flat_.size() - 2);
        while (left_.size() > 3)
        {
            const size_t ear = find_ear();
            triangles.push_back(triangle(ear));
            left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
        }
        triangles.push_back(triangle(1));
        return triangles;
    }

private:
    struct Ear
    {
        double cut; // squared length
        size_t at;
    };

    // The corner at i of those left, between its neighbours.
    [[nodiscard]] glm::uvec3 triangle(size_t i) const
    {
        const size_t count = left_.size();
        return {left_[(i + count - 1) % count], left_[i], left_[(i + 1) % count]};
    }

    // No other corner lies in it or on its edge. One at the same place as a corner of it does not count: that is how
    // a hole is joined to the outline.
    [[nodiscard]] bool is_clear(const glm::uvec3& ear) const
    {
        const glm::dvec2 a = flat_[ear.x];
        const glm::dvec2 b = flat_[ear.y];
        const glm::dvec2 c = flat_[ear.z];
        return std::none_of(left_.begin(), left_.end(),
                            [&](uint32_t i)
                            {
                                const glm::dvec2 p = flat_[i];
                                return p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 &&
                                       turn(c, a, p) >= 0;
                            });
    }

    [[nodiscard]] size_t find_ear()
    {
        ears_.clear();
        for (size_t i = 0; i < left_.size(); ++i)
        {
            const glm::uvec3 t = triangle(i);
            const glm::dvec2 cut = flat_[t.z] - flat_[t.x];
            if (turn(flat_[t.x], flat_[t.y], flat_[t.z]) > 0)
                ears_.push_back({glm::dot(cut, cut), i});
        }
        std::sort(ears_.begin(), ears_.end(),
                  [](const Ear& a, const Ear& b) { return a.cut != b.cut ? a.cut < b.cut : a.at < b.at; });
        for (const Ear& ear : ears_)
            if (is_clear(triangle(ear.at)))
                return ear.at;
        return ears_.empty() ? 0 : ears_.front().at; // crosses itself, or has no area
    }

    std::vector<glm::dvec2> flat_;
    std::vector<uint32_t> left_; // corners not yet cut off, in order
    std::vector<Ear> ears_;
};

} // namespace

std::vector<glm::uvec3> triangulate(std::span<const glm::vec3> corners)
{
    if (corners.size() == 3)
        return {{0, 1, 2}};
    return EarClipper(flatten(corners)).run();
}

} // namespace engine
