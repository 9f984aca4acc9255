// How fine the features of a collider must be.
#pragma once

namespace voile
{

// Decides whether contact of a cloth's vertices is enough at a corner or an edge: vertices keep `thickness` from the
// surface, and a chord of length `edge` between two of them sinks towards it by as much as the surface bends.
struct FeatureScale
{
    float edge = 0;      // m, the longest of the cloths
    float thickness = 0; // m, the smallest

    bool operator==(const FeatureScale&) const = default;

    // m: the distance of feature vertices, and the shortest feature edge. Coarse cloth would sag between vertices that
    // are farther apart.
    [[nodiscard]] float spacing() const
    {
        const float wanted = edge / 4 < 2 * thickness ? edge / 4 : 2 * thickness;
        return wanted > thickness / 4 ? wanted : thickness / 4;
    }
};

// The fraction of the thickness by which cloth may sink at an edge, or where a mesh bends within an edge's length. At 1
// the cloth would lie on the surface itself, at rest and not stretched.
constexpr float k_allowed_fraction = 0.75f;

} // namespace voile
