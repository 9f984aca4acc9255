// Binned SAH: where to split a range of triangles.
#include "geometry/bvh_split.hpp"

#include "shared/bvh_layout.h"

#include <algorithm>
#include <array>
#include <bit>

namespace voile
{

// Which bin of its range a centroid falls into.
class Splitter::Binning
{
public:
    explicit Binning(const Box& centroids) : origin_(centroids.min)
    {
        for (int axis = 0; axis < 3; ++axis)
        {
            const float extent = centroids.max[axis] - centroids.min[axis];
            const float bins = static_cast<float>(k_bins) * (1 - 1e-6f);
            scale_[axis] = extent > 0 && bins / extent < std::numeric_limits<float>::infinity() ? bins / extent : 0;
        }
    }

    // Along an axis without extent, or with one beyond float, all lie in bin 0.
    [[nodiscard]] uint32_t bin(const glm::vec3& centroid, int axis) const
    {
        if (scale_[axis] == 0)
            return 0;
        return std::min(static_cast<uint32_t>((centroid[axis] - origin_[axis]) * scale_[axis]), k_bins - 1);
    }

private:
    glm::vec3 origin_;
    glm::vec3 scale_{0.f};
};

Splitter::Halves Splitter::split(const PrimitiveRange& range, std::span<Primitive> scratch, uint32_t depth)
{
    // A balanced subtree of this many triangles still fits below; past that, balance matters more than cost.
    const bool deep = depth + static_cast<uint32_t>(std::bit_width(range.primitives.size())) >= VOILE_BVH_MAX_DEPTH;
    if (deep)
        return halve(range);
    const Binning binning(range.centroids);
    fill(range.primitives, binning);
    const Plane plane = best_plane();
    return plane.axis < 0 ? halve(range) : partition(range.primitives, scratch, binning, plane);
}

// All three axes at once: large ranges do not fit the caches, and reading them is what costs.
void Splitter::fill(std::span<const Primitive> range, const Binning& binning)
{
    for (Bins& bins : bins_)
        bins.occupied = 0;
    for (const Primitive& primitive : range)
    {
        const Box box{primitive.min, primitive.max};
        const glm::vec3 centroid = primitive.centroid();
        for (int axis = 0; axis < 3; ++axis)
        {
            Bins& bins = bins_[static_cast<size_t>(axis)];
            const uint32_t bin = binning.bin(centroid, axis);
            const bool first = (bins.occupied >> bin & 1) == 0;
            if (first)
                bins.boxes[bin] = box;
            else
                bins.boxes[bin].add(box);
            bins.counts[bin] = first ? 1 : bins.counts[bin] + 1;
            bins.occupied |= 1u << bin;
        }
    }
}

Splitter::Plane Splitter::best_plane() const
{
    Plane best;
    for (int axis = 0; axis < 3; ++axis)
        sweep(axis, best);
    return best;
}

// The cheapest of the planes between bins along one axis, if it beats `best`. Most ranges hold a few triangles, so only
// occupied bins are looked at: planes between the same two of them are one plane.
void Splitter::sweep(int axis, Plane& best) const
{
    const Bins& bins = bins_[static_cast<size_t>(axis)];
    if (std::has_single_bit(bins.occupied))
        return;
    std::array<float, k_bins> right_costs{}; // of the occupied bins
    Box box;
    uint32_t count = 0;
    for (uint32_t left = bins.occupied; left != 0;)
    {
        const auto bin = static_cast<uint32_t>(std::bit_width(left)) - 1;
        box.add(bins.boxes[bin]);
        count += bins.counts[bin];
        right_costs[bin] = box.half_area() * static_cast<float>(count);
        left &= ~(1u << bin);
    }
    box = {};
    count = 0;
    for (uint32_t right = bins.occupied; !std::has_single_bit(right);)
    {
        const auto bin = static_cast<uint32_t>(std::countr_zero(right));
        right &= right - 1;
        const auto next = static_cast<uint32_t>(std::countr_zero(right));
        box.add(bins.boxes[bin]);
        count += bins.counts[bin];
        const float cost = box.half_area() * static_cast<float>(count) + right_costs[next];
        if (cost < best.cost)
            best = {axis, next, cost};
    }
}

// Keeps the order of each side.
Splitter::Halves Splitter::partition(std::span<Primitive> range, std::span<Primitive> scratch, const Binning& binning,
                                     const Plane& plane) const
{
    Halves halves;
    size_t left = 0;
    size_t right = 0;
    for (const Primitive& primitive : range)
    {
        const glm::vec3 centroid = primitive.centroid();
        if (binning.bin(centroid, plane.axis) < plane.bin)
        {
            halves.left.centroids.add(centroid);
            range[left++] = primitive;
        }
        else
        {
            halves.right.centroids.add(centroid);
            scratch[right++] = primitive;
        }
    }
    std::copy_n(scratch.begin(), right, range.begin() + static_cast<std::ptrdiff_t>(left));
    halves.left.primitives = range.first(left);
    halves.right.primitives = range.subspan(left);
    const Bins& bins = bins_[static_cast<size_t>(plane.axis)];
    for (uint32_t rest = bins.occupied; rest != 0; rest &= rest - 1)
    {
        const auto bin = static_cast<uint32_t>(std::countr_zero(rest));
        (bin < plane.bin ? halves.left : halves.right).box.add(bins.boxes[bin]);
    }
    return halves;
}

Primitive make_primitive(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles, uint32_t t)
{
    Box box;
    for (int corner = 0; corner < 3; ++corner)
        box.add(positions[triangles[t][corner]]);
    return {box.min, t, box.max, 0};
}

// Halves the triangles in their order along the widest axis, if no plane separates the centroids or the tree is too
// deep.
Splitter::Halves Splitter::halve(const PrimitiveRange& range)
{
    const glm::vec3 extent = range.centroids.max - range.centroids.min;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const size_t middle = range.primitives.size() / 2;
    std::nth_element(range.primitives.begin(), range.primitives.begin() + static_cast<std::ptrdiff_t>(middle),
                     range.primitives.end(),
                     [axis](const Primitive& a, const Primitive& b)
                     {
                         const float at_a = a.centroid()[axis];
                         const float at_b = b.centroid()[axis];
                         return at_a != at_b ? at_a < at_b : a.triangle < b.triangle;
                     });
    Halves halves;
    halves.left.primitives = range.primitives.first(middle);
    halves.right.primitives = range.primitives.subspan(middle);
    for (PrimitiveRange* half : {&halves.left, &halves.right})
        for (const Primitive& primitive : half->primitives)
            half->add(primitive);
    return halves;
}

} // namespace voile
