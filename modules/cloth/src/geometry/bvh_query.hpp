// Queries of a hierarchy on the host, in double precision: what the GPU's answers are checked against.
#pragma once

#include "geometry/bvh.hpp"

#include <functional>
#include <optional>

namespace voile
{

struct RayHit
{
    double t = 0; // in units of the direction's length
    uint32_t triangle = 0;
};

// The nearest hit of origin + t * direction with 0 <= t <= limit, from both sides (Möller and Trumbore 1997).
std::optional<RayHit> nearest_hit(const Bvh& bvh, const glm::dvec3& origin, const glm::dvec3& direction, double limit);

// Where a ray hits a triangle, if it does.
std::optional<double> ray_triangle(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& a,
                                   const glm::dvec3& b, const glm::dvec3& c);

// Calls visit(triangle) for every triangle of the leaves that overlap the box.
void visit_box(const Bvh& bvh, const glm::vec3& min, const glm::vec3& max, const std::function<void(uint32_t)>& visit);

// Which part of a triangle a point of it is: of a corner 0 to 2, of the edge from corner i (3 + i), or of its face.
enum class Feature : uint8_t
{
    corner_0,
    corner_1,
    corner_2,
    edge_0,
    edge_1,
    edge_2,
    face,
};

struct NearestPoint
{
    glm::dvec3 point{0.0};
    double distance = 0; // m
    uint32_t triangle = 0;
    Feature feature = Feature::face;
};

// The point of the mesh nearest to `p`, or nothing if none is within `limit`.
std::optional<NearestPoint> nearest_point(const Bvh& bvh, const glm::dvec3& p, double limit);

// The same for one triangle (Ericson 2004, Real-Time Collision Detection, 5.1.5).
NearestPoint nearest_on_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

// How often a closed mesh winds around a point: the signed crossings of the line along +y. Both triangles of an edge
// give the same result for it, to the bit.
int line_winding(const Bvh& bvh, const glm::dvec3& p);

} // namespace voile
