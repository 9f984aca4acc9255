// CornerTree: built by median splits, searched depth first.
#include "assets/corner_tree.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

namespace voile::engine
{

namespace
{

constexpr uint32_t k_leaf_points = 8;
constexpr uint32_t k_removed = std::numeric_limits<uint32_t>::max();

// Returns false only if no point of the box lies in the triangle or on its edges, the triangle's corners excluded.
// Exact for a box of one point. Every operation of turn() is monotonic in the point's coordinates, rounding included,
// so its value at the box's farthest corner bounds the values at all points of the box.
bool may_touch(const FlatTriangle& triangle, const glm::dvec2& min, const glm::dvec2& max)
{
    const auto [a, b, c] = triangle;
    if (min == max && (min == a || min == b || min == c))
        return false;
    const glm::dvec2 low = glm::min(glm::min(a, b), c);
    const glm::dvec2 high = glm::max(glm::max(a, b), c);
    if (glm::any(glm::lessThan(max, low)) || glm::any(glm::greaterThan(min, high)))
        return false;
    const auto reaches = [&](const glm::dvec2& from, const glm::dvec2& to) {
        return turn(from, to, {to.y > from.y ? min.x : max.x, to.x > from.x ? max.y : min.y}) >= 0;
    };
    return reaches(a, b) && reaches(b, c) && reaches(c, a);
}

} // namespace

CornerTree::CornerTree(std::span<const glm::dvec2> points)
    : points_(points.begin(), points.end()), order_(points.size()), leaves_(points.size())
{
    std::iota(order_.begin(), order_.end(), 0u);
    nodes_.reserve(1 + 4 * points.size() / k_leaf_points);
    const auto count = static_cast<uint32_t>(points.size());
    nodes_.push_back({{}, {}, 0, 0, count, count, 0});
    for (uint32_t node = 0; node < nodes_.size(); ++node)
        build(node);
}

// Sets the box and splits a node with more points than a leaf holds.
void CornerTree::build(uint32_t node)
{
    Node& n = nodes_[node];
    n.min = n.max = points_[order_[n.first]];
    for (uint32_t i = n.first; i < n.end; ++i)
    {
        n.min = glm::min(n.min, points_[order_[i]]);
        n.max = glm::max(n.max, points_[order_[i]]);
    }
    if (n.end - n.first <= k_leaf_points)
    {
        for (uint32_t i = n.first; i < n.end; ++i)
            leaves_[order_[i]] = node;
        return;
    }
    const glm::dvec2 size = n.max - n.min;
    const int axis = size.x > size.y ? 0 : 1;
    const uint32_t middle = n.first + (n.end - n.first) / 2;
    std::nth_element(order_.begin() + n.first, order_.begin() + middle, order_.begin() + n.end,
                     [&](uint32_t a, uint32_t b) { return points_[a][axis] < points_[b][axis]; });
    const uint32_t first = n.first;
    const uint32_t end = n.end;
    n.children = static_cast<uint32_t>(nodes_.size());
    nodes_.push_back({{}, {}, node, first, middle, middle - first, 0}); // n is a dangling reference from here on
    nodes_.push_back({{}, {}, node, middle, end, end - middle, 0});
}

void CornerTree::remove(uint32_t point)
{
    uint32_t node = leaves_[point];
    leaves_[point] = k_removed;
    for (; node != 0; node = nodes_[node].parent)
        --nodes_[node].left;
    --nodes_[0].left;
}

std::optional<uint32_t> CornerTree::find(const FlatTriangle& triangle, uint32_t seed) const
{
    uint32_t bits = seed * 0x9E3779B9u; // child order per level
    std::array<uint32_t, 64> stack{};   // at most one more per level, and 2^32 points have 32 levels
    size_t size = 1;
    while (size > 0)
    {
        const Node& node = nodes_[stack[--size]];
        if (node.left == 0 || !may_touch(triangle, node.min, node.max))
            continue;
        if (node.children > 0)
        {
            bits = std::rotl(bits, 1);
            stack[size++] = node.children + (bits & 1);
            stack[size++] = node.children + (~bits & 1);
            continue;
        }
        for (uint32_t i = node.first; i < node.end; ++i)
            if (leaves_[order_[i]] != k_removed && may_touch(triangle, points_[order_[i]], points_[order_[i]]))
                return order_[i];
    }
    return std::nullopt;
}

} // namespace voile::engine
