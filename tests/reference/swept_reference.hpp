// A point on a straight path against a convex solid, in double precision, by search only: the signed distance of a
// convex solid is convex along the path.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <functional>

namespace reference
{

// m, from the surface; negative inside.
using SignedDistance = std::function<double(const glm::dvec3&)>;

inline double sphere_distance(const glm::dvec3& center, double radius, const glm::dvec3& p)
{
    return glm::distance(p, center) - radius;
}

inline double capsule_distance(const glm::dvec3& a, const glm::dvec3& b, double radius, const glm::dvec3& p)
{
    const glm::dvec3 axis = b - a;
    const double t = std::clamp(glm::dot(p - a, axis) / std::max(glm::dot(axis, axis), 1e-300), 0.0, 1.0);
    return glm::distance(p, a + t * axis) - radius;
}

inline double box_distance(const glm::dvec3& min, const glm::dvec3& max, const glm::dvec3& p)
{
    const glm::dvec3 outside = glm::max(min - p, p - max);
    return glm::length(glm::max(outside, 0.0)) + std::min(std::max({outside.x, outside.y, outside.z}), 0.0);
}

// The normal where the distance is smooth.
inline glm::dvec3 normal_at(const SignedDistance& distance, const glm::dvec3& p, double step)
{
    glm::dvec3 n(0);
    for (int axis = 0; axis < 3; ++axis)
    {
        glm::dvec3 offset(0);
        offset[axis] = step;
        n[axis] = distance(p + offset) - distance(p - offset);
    }
    return glm::normalize(n);
}

struct Sweep
{
    double deepest = 0; // m, the smallest distance on the path
    double entry = 2;   // where the path enters, as a fraction of it; 2: nowhere
};

// A path that starts outside.
inline Sweep sweep(const SignedDistance& distance, const glm::dvec3& from, const glm::dvec3& to)
{
    const auto at = [&](double t) { return distance(from + t * (to - from)); };
    double low = 0;
    double high = 1;
    for (int i = 0; i < 90; ++i)
    {
        const double third = (high - low) / 3;
        if (at(low + third) < at(high - third))
            high -= third;
        else
            low += third;
    }
    Sweep result;
    double inside = 0.5 * (low + high);
    for (const double t : {0.0, 1.0})
        if (at(t) < at(inside))
            inside = t;
    result.deepest = at(inside);
    if (result.deepest >= 0)
        return result;
    double outside = 0;
    for (int i = 0; i < 60; ++i)
    {
        const double middle = 0.5 * (outside + inside);
        (at(middle) < 0 ? inside : outside) = middle;
    }
    result.entry = inside;
    return result;
}

} // namespace reference
