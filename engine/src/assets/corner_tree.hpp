// CornerTree: the corners of a flat polygon. Finds corners inside a triangle.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace voile::engine
{

// Twice the area of a triangle; positive if it is counter-clockwise.
inline double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

using FlatTriangle = std::array<glm::dvec2, 3>; // counter-clockwise

// A k-d tree (Bentley 1975) with removal. A query visits boxes that overlap the triangle and still hold points.
class CornerTree
{
public:
    explicit CornerTree(std::span<const glm::dvec2> points);

    void remove(uint32_t point);
    // Finds a remaining point that lies in the triangle or on its edges, but at none of its corners. If there are
    // several, different seeds find different ones.
    [[nodiscard]] std::optional<uint32_t> find(const FlatTriangle& triangle, uint32_t seed) const;

private:
    struct Node
    {
        glm::dvec2 min;
        glm::dvec2 max;
        uint32_t parent;
        uint32_t first; // of its points in order_
        uint32_t end;
        uint32_t left;     // points not yet removed
        uint32_t children; // the first of two; 0 for a leaf
    };

    void build(uint32_t node);

    std::vector<glm::dvec2> points_;
    std::vector<uint32_t> order_;  // points, those of a leaf side by side
    std::vector<uint32_t> leaves_; // the node of each point; k_removed after removal
    std::vector<Node> nodes_;
};

} // namespace voile::engine
