// One step of building a hierarchy: a range of triangles is split into two.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <span>

namespace voile
{

struct Box
{
    glm::vec3 min{std::numeric_limits<float>::infinity()};
    glm::vec3 max{-std::numeric_limits<float>::infinity()};

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

    // 0 where it is empty.
    [[nodiscard]] float half_area() const
    {
        const glm::vec3 d = max - min;
        return d.x < 0 ? 0 : d.x * d.y + d.y * d.z + d.z * d.x;
    }
};

// A triangle's box. 32 bytes without a constructor: there are millions of them.
struct Primitive
{
    glm::vec3 min;
    uint32_t triangle;
    glm::vec3 max;
    uint32_t padding;

    [[nodiscard]] glm::vec3 centroid() const { return 0.5f * (min + max); } // of the box
};

Primitive make_primitive(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles, uint32_t t);

// Primitives, the box around them and the box around their centroids.
struct PrimitiveRange
{
    std::span<Primitive> primitives;
    Box box;
    Box centroids;

    void add(const Primitive& primitive)
    {
        box.add(Box{primitive.min, primitive.max});
        centroids.add(primitive.centroid());
    }
};

// Splits ranges; each thread has one of its own, for the room that it keeps.
class Splitter
{
public:
    struct Halves
    {
        PrimitiveRange left; // neither is empty
        PrimitiveRange right;
    };
    // Reorders the range, of 2 primitives or more; `scratch` is as large. `depth` is that of the node that the range
    // becomes, 1 for the root: where the tree grows too deep, halves are equally large.
    Halves split(const PrimitiveRange& range, std::span<Primitive> scratch, uint32_t depth);

private:
    static constexpr uint32_t k_bins = 16;
    class Binning;
    // What lies in a bin of an axis; of an empty one (its bit in `occupied` is 0) nothing is set.
    struct Bins
    {
        uint32_t occupied = 0;
        std::array<Box, k_bins> boxes;
        std::array<uint32_t, k_bins> counts;
    };
    struct Plane
    {
        int axis = -1;    // none
        uint32_t bin = 0; // the first one on the right that is not empty
        float cost = std::numeric_limits<float>::infinity();
    };
    void fill(std::span<const Primitive> range, const Binning& binning);
    [[nodiscard]] Plane best_plane() const;
    void sweep(int axis, Plane& best) const;
    [[nodiscard]] Halves partition(std::span<Primitive> range, std::span<Primitive> scratch, const Binning& binning,
                                   const Plane& plane) const;
    static Halves halve(const PrimitiveRange& range);

    std::array<Bins, 3> bins_{};
};

} // namespace voile
