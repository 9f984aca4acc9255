// How fine the features of a collider must be.
#pragma once

namespace voile
{

// The fraction of the thickness by which cloth may sink at an edge, or where a mesh bends within an edge's length. At 1
// the cloth would lie on the surface itself, at rest and not stretched.
constexpr float k_allowed_fraction = 0.75f;

// Decides whether contact of a cloth's vertices is enough at a corner or an edge: vertices keep `thickness` from the
// surface, and a chord of length `edge` between two of them sinks towards it by as much as the surface bends.
struct FeatureScale
{
    float edge = 0;      // m, the longest of the cloths
    float thickness = 0; // m, the smallest

    // m: how far apart feature vertices may be where a chord of length `edge` would sink by `sag`, m, towards the
    // surface. A triangle of cloth on a feature vertex at the distance d from one of its edges lets that edge sink by
    // d / (edge / 2) of `sag` at most: the height of a right triangle over its longest edge is half of that. So between
    // two feature vertices the cloth sinks by no more than k_allowed_fraction of the thickness, and an edge of the
    // collider that is shorter than this needs to be no feature.
    [[nodiscard]] float spacing_for(float sag) const { return edge * k_allowed_fraction * thickness / sag; }

    bool operator==(const FeatureScale&) const = default;

    // m: features nearer to each other than this count as one.
    [[nodiscard]] float finest_spacing() const
    {
        const float wanted = edge / 4 < 2 * thickness ? edge / 4 : 2 * thickness;
        return wanted > thickness / 4 ? wanted : thickness / 4;
    }
};

} // namespace voile
