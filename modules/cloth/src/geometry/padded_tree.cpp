// Building a padded tree by halving.
#include "geometry/padded_tree.hpp"

#include "geometry/bvh_split.hpp"
#include "geometry/owned_edges.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace voile
{

namespace
{

using Range = std::span<Primitive>;

// Half of a range, the larger one first.
size_t middle(Range range)
{
    return (range.size() + 1) / 2;
}

void halve(Range range, int axis)
{
    const auto begin = range.begin();
    std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(middle(range)), range.end(),
                     [axis](const Primitive& a, const Primitive& b)
                     {
                         const float center_a = a.min[axis] + a.max[axis];
                         const float center_b = b.min[axis] + b.max[axis];
                         // The order is total, so that the halves do not depend on the library's algorithm.
                         return center_a != center_b ? center_a < center_b : a.triangle < b.triangle;
                     });
}

Box bounds(Range range)
{
    Box box;
    for (const Primitive& primitive : range)
        box.add(Box{primitive.min, primitive.max});
    return box;
}

void halve_well(Range range)
{
    int best = 0;
    float least = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis)
    {
        halve(range, axis);
        const float area =
            bounds(range.first(middle(range))).half_area() + bounds(range.subspan(middle(range))).half_area();
        if (area < least)
        {
            least = area;
            best = axis;
        }
    }
    if (best != 2) // else it is halved so already
        halve(range, best);
}

void halve_widest(Range range)
{
    const Box box = bounds(range);
    const glm::vec3 size = box.max - box.min;
    halve(range, size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2));
}

class Builder
{
public:
    Builder(std::span<const glm::uvec3> triangles, PaddedSplit split, PaddedTree& tree)
        : triangles_(triangles), edges_(owned_edges(triangles)), split_(split), tree_(tree)
    {
    }

    // Fills the slots under box `box` of a level.
    void fill(Range range, uint32_t level, uint32_t box, bool repeat)
    {
        if (level == tree_.levels)
        {
            const uint32_t triangle = range.front().triangle;
            const uint32_t edges = uint32_t{edges_[triangle]} << VOILE_PADDED_EDGE_SHIFT;
            tree_.leaves[box] = {triangles_[triangle], triangle | edges | (repeat ? VOILE_PADDED_REPEAT : 0)};
            return;
        }
        const uint32_t sibling = box + (1u << level);
        if (range.size() == 1) // on the last level but one; halves differ by one triangle at most
        {
            fill(range, level + 1, box, false);
            fill(range, level + 1, sibling, true);
            return;
        }
        if (range.size() > 2) // of two, either order is right
            split_ == PaddedSplit::widest ? halve_widest(range) : halve_well(range);
        fill(range.first(middle(range)), level + 1, box, false);
        fill(range.subspan(middle(range)), level + 1, sibling, false);
    }

private:
    std::span<const glm::uvec3> triangles_;
    std::vector<uint8_t> edges_;
    PaddedSplit split_;
    PaddedTree& tree_;
};

} // namespace

uint32_t padded_levels(uint32_t triangles)
{
    return static_cast<uint32_t>(std::bit_width(triangles - 1));
}

PaddedTree build_padded_tree(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                             PaddedSplit split)
{
    std::vector<Primitive> primitives(triangles.size());
    for (uint32_t t = 0; t < triangles.size(); ++t)
        primitives[t] = make_primitive(positions, triangles, t);
    PaddedTree tree;
    tree.triangles = static_cast<uint32_t>(triangles.size());
    tree.levels = padded_levels(tree.triangles);
    tree.leaves.resize(size_t{1} << tree.levels);
    Builder(triangles, split, tree).fill(primitives, 0, 0, false);
    return tree;
}

} // namespace voile
