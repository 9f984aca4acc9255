// Building a hierarchy by binned SAH.
#include "bvh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace cloth
{

namespace
{

constexpr float k_infinity = std::numeric_limits<float>::infinity();
constexpr uint32_t k_bins = 16;

struct Box
{
    glm::vec3 min{k_infinity};
    glm::vec3 max{-k_infinity};

    void add(const glm::vec3& p)
    {
        min = glm::min(min, p);
        max = glm::max(max, p);
    }

    void add(const Box& other)
    {
        min = glm::min(min, other.min);
        max = glm::max(max, other.max);
    }

    [[nodiscard]] float half_area() const
    {
        const glm::vec3 d = max - min;
        return d.x < 0 ? 0 : d.x * d.y + d.y * d.z + d.z * d.x;
    }
};

struct Primitive
{
    Box box;
    glm::vec3 centroid; // of the box
    uint32_t triangle;
};

struct Split
{
    int axis = -1;    // none
    uint32_t bin = 0; // the first bin of the right side
    float cost = k_infinity;
};

// Which bin of its node a centroid falls into.
struct Binning
{
    glm::vec3 origin;
    glm::vec3 scale{0.f}; // 0 along an axis without extent

    explicit Binning(const Box& centroids) : origin(centroids.min)
    {
        for (int axis = 0; axis < 3; ++axis)
        {
            const float extent = centroids.max[axis] - centroids.min[axis];
            const float bins = static_cast<float>(k_bins) * (1 - 1e-6f);
            scale[axis] = extent > 0 && bins / extent < k_infinity ? bins / extent : 0;
        }
    }

    [[nodiscard]] uint32_t bin(const glm::vec3& centroid, int axis) const
    {
        return std::min(static_cast<uint32_t>((centroid[axis] - origin[axis]) * scale[axis]), k_bins - 1);
    }
};

class Builder
{
public:
    Builder(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles, uint32_t leaf_size)
        : positions_(positions), triangles_(triangles), leaf_size_(leaf_size)
    {
        primitives_.reserve(triangles.size());
        for (uint32_t t = 0; t < triangles.size(); ++t)
        {
            Primitive primitive{{}, {}, t};
            for (int corner = 0; corner < 3; ++corner)
                primitive.box.add(positions[triangles[t][corner]]);
            primitive.centroid = 0.5f * (primitive.box.min + primitive.box.max);
            primitives_.push_back(primitive);
        }
    }

    Bvh build()
    {
        bvh_.triangles.reserve(primitives_.size());
        bvh_.nodes.reserve(primitives_.size());
        if (primitives_.size() <= leaf_size_)
        {
            const Box box = bounds(primitives_);
            const uint32_t leaf = add_leaf(primitives_);
            bvh_.nodes.push_back({box.min, leaf, box.max, 0, glm::vec3(k_infinity), leaf, glm::vec3(-k_infinity), 0});
            bvh_.depth = 1;
        }
        else
            add_node(primitives_, 1);
        return std::move(bvh_);
    }

private:
    using Range = std::span<Primitive>;

    static Box bounds(Range range)
    {
        Box box;
        for (const Primitive& primitive : range)
            box.add(primitive.box);
        return box;
    }

    uint32_t add_leaf(Range range)
    {
        const auto first = static_cast<uint32_t>(bvh_.triangles.size());
        for (const Primitive& primitive : range)
        {
            const glm::uvec3& t = triangles_[primitive.triangle];
            bvh_.triangles.push_back({positions_[t.x], primitive.triangle, positions_[t.y], 0, positions_[t.z], 0});
        }
        return VOILE_BVH_LEAF_BIT | static_cast<uint32_t>(range.size() - 1) << VOILE_BVH_COUNT_SHIFT | first;
    }

    uint32_t add_child(Range range, uint32_t depth)
    {
        return range.size() <= leaf_size_ ? add_leaf(range) : add_node(range, depth);
    }

    // `depth` counts this node. Returns its index.
    uint32_t add_node(Range range, uint32_t depth)
    {
        bvh_.depth = std::max(bvh_.depth, depth);
        const auto index = static_cast<uint32_t>(bvh_.nodes.size());
        bvh_.nodes.emplace_back();
        const size_t middle = partition(range, depth);
        const Range left = range.first(middle);
        const Range right = range.subspan(middle);
        const Box left_box = bounds(left);
        const Box right_box = bounds(right);
        const uint32_t left_child = add_child(left, depth + 1);
        const uint32_t right_child = add_child(right, depth + 1);
        bvh_.nodes[index] = {left_box.min, left_child, left_box.max, 0, right_box.min, right_child, right_box.max, 0};
        return index;
    }

    // Reorders the range into two sides that are not empty; returns where the right one begins.
    size_t partition(Range range, uint32_t depth) const
    {
        Box centroids;
        for (const Primitive& primitive : range)
            centroids.add(primitive.centroid);
        // A balanced subtree of this many triangles still fits below; past that, balance matters more than cost.
        const bool deep = depth + static_cast<uint32_t>(std::bit_width(range.size())) >= VOILE_BVH_MAX_DEPTH;
        const Binning binning(centroids);
        const Split split = deep ? Split{} : best_split(range, binning);
        if (split.axis >= 0)
        {
            const auto right = std::stable_partition(range.begin(), range.end(),
                                                     [&](const Primitive& p)
                                                     { return binning.bin(p.centroid, split.axis) < split.bin; });
            return static_cast<size_t>(right - range.begin());
        }
        return halve(range, centroids);
    }

    static size_t halve(Range range, const Box& centroids)
    {
        const glm::vec3 extent = centroids.max - centroids.min;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const size_t middle = range.size() / 2;
        std::nth_element(range.begin(), range.begin() + static_cast<std::ptrdiff_t>(middle), range.end(),
                         [axis](const Primitive& a, const Primitive& b) {
                             return a.centroid[axis] != b.centroid[axis] ? a.centroid[axis] < b.centroid[axis]
                                                                         : a.triangle < b.triangle;
                         });
        return middle;
    }

    static Split best_split(Range range, const Binning& binning)
    {
        Split best;
        for (int axis = 0; axis < 3; ++axis)
        {
            if (binning.scale[axis] == 0)
                continue;
            std::array<Box, k_bins> boxes;
            std::array<uint32_t, k_bins> counts{};
            for (const Primitive& primitive : range)
            {
                const uint32_t bin = binning.bin(primitive.centroid, axis);
                boxes[bin].add(primitive.box);
                ++counts[bin];
            }
            sweep(boxes, counts, axis, best);
        }
        return best;
    }

    // The cheapest of the planes between bins along one axis, if it beats `best`.
    static void sweep(const std::array<Box, k_bins>& boxes, const std::array<uint32_t, k_bins>& counts, int axis,
                      Split& best)
    {
        std::array<float, k_bins> right_costs{};
        Box box;
        uint32_t count = 0;
        for (uint32_t bin = k_bins - 1; bin > 0; --bin)
        {
            box.add(boxes[bin]);
            count += counts[bin];
            right_costs[bin] = count > 0 ? box.half_area() * static_cast<float>(count) : k_infinity;
        }
        box = {};
        count = 0;
        for (uint32_t bin = 1; bin < k_bins; ++bin)
        {
            box.add(boxes[bin - 1]);
            count += counts[bin - 1];
            const float cost = count > 0 ? box.half_area() * static_cast<float>(count) + right_costs[bin] : k_infinity;
            if (cost < best.cost)
                best = {axis, bin, cost};
        }
    }

    std::span<const glm::vec3> positions_;
    std::span<const glm::uvec3> triangles_;
    uint32_t leaf_size_;
    std::vector<Primitive> primitives_;
    Bvh bvh_;
};

} // namespace

Bvh build_bvh(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles, const BvhOptions& options)
{
    return Builder(positions, triangles, std::clamp(options.triangles_per_leaf, 1u, 4u)).build();
}

} // namespace cloth
