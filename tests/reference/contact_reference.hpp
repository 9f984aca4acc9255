// Contact in double precision on the CPU, by brute force over all triangles: crossing of the path, nearest point or
// rays along the normal, response with Coulomb friction.
#pragma once

#include "voile/descriptions.hpp"
#include "voile/solver.hpp"

#include "geometry/bvh_query.hpp"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace reference
{

struct Contact
{
    glm::dvec3 direction{0.0}; // unit, to the side on which the vertex belongs
    double gap = 0;            // m along it
    double start = 0;          // m, the same at the start of the substep
};

struct TriangleMesh
{
    std::vector<glm::dvec3> positions;
    std::vector<glm::uvec3> triangles;
    bool closed = false;
};

inline glm::dvec3 face_normal(const TriangleMesh& mesh, const glm::uvec3& t)
{
    return glm::normalize(
        glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]));
}

// The first triangle that the path crosses. Leaving a closed mesh is no crossing.
inline std::optional<Contact> crossing_contact(const TriangleMesh& mesh, const glm::dvec3& from, const glm::dvec3& to)
{
    double first = 2;
    std::optional<Contact> result;
    for (const glm::uvec3& t : mesh.triangles)
    {
        const glm::dvec3 n = face_normal(mesh, t);
        if (mesh.closed && glm::dot(to - from, n) >= 0)
            continue;
        const auto hit =
            voile::ray_triangle(from, to - from, mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]);
        if (!hit || *hit > 1 || *hit >= first)
            continue;
        first = *hit;
        const glm::dvec3 side = glm::dot(from - to, n) >= 0 ? n : -n;
        const glm::dvec3 point = from + first * (to - from);
        result = Contact{side, glm::dot(to - point, side), glm::dot(from - point, side)};
    }
    return result;
}

// By the plane of the contact. A vertex that is outside now and was under that plane came around an edge.
inline Contact with_start(Contact contact, const glm::dvec3& from, const glm::dvec3& to)
{
    contact.start = contact.gap - glm::dot(to - from, contact.direction);
    if (contact.gap >= 0)
        contact.start = std::max(contact.start, 0.0);
    return contact;
}

inline std::optional<Contact> nearest_contact(const TriangleMesh& mesh, const glm::dvec3& from, const glm::dvec3& to,
                                              double thickness)
{
    double nearest = thickness;
    double best_alignment = 0;
    glm::dvec3 point(0);
    glm::dvec3 face(0);
    for (const glm::uvec3& t : mesh.triangles)
    {
        const voile::NearestPoint found =
            voile::nearest_on_triangle(to, mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]);
        const glm::dvec3 n = face_normal(mesh, t);
        const double alignment = std::abs(glm::dot(to - found.point, n)) / std::max(found.distance, 1e-12);
        const double tie = 1e-5 * thickness; // at a shared edge the triangle that faces the vertex counts
        if (found.distance < nearest - tie ||
            (found.distance < nearest + tie && alignment > best_alignment && best_alignment > 0))
        {
            nearest = found.distance;
            best_alignment = alignment;
            point = found.point;
            face = n;
        }
    }
    if (nearest >= thickness)
        return std::nullopt;
    const double height = glm::dot(to - point, face);
    if (nearest < 0.01 * thickness) // too short for a direction in float: the face gives it
    {
        const glm::dvec3 side = !mesh.closed && height < 0 ? -face : face;
        return with_start({side, glm::dot(to - point, side)}, from, to);
    }
    const bool inside = mesh.closed && height < 0;
    const double sign = inside ? -1 : 1;
    return with_start({sign * glm::normalize(to - point), sign * nearest}, from, to);
}

inline std::optional<Contact> ray_contact(const TriangleMesh& mesh, const glm::dvec3& from, const glm::dvec3& to,
                                          const glm::dvec3& normal, double thickness)
{
    double nearest = thickness;
    std::optional<Contact> result;
    for (const glm::uvec3& t : mesh.triangles)
        for (const double sign : {1.0, -1.0})
        {
            const auto hit =
                voile::ray_triangle(to, sign * normal, mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]);
            if (!hit || *hit >= nearest)
                continue;
            nearest = *hit;
            const glm::dvec3 point = to + sign * *hit * normal;
            glm::dvec3 n = face_normal(mesh, t);
            if (!mesh.closed && glm::dot(from - point, n) < 0)
                n = -n;
            result = with_start({n, glm::dot(to - point, n)}, from, to);
        }
    return result;
}

// m/s: the speed at which a vertex under a surface, or closer than the thickness, is lifted.
constexpr double k_lift_speed = 0.75;

// The vertex ends on the offset surface and does not approach it. A vertex that was too close before is lifted slowly,
// one that was inside no faster and without a velocity of its own. It sticks within the cone of static friction, else
// slides.
inline void respond(const Contact& contact, double thickness, double mu_s, double mu_k, double h,
                    const glm::dvec3& from, glm::dvec3& x, glm::dvec3& v)
{
    const glm::dvec3 n = contact.direction;
    const double lift = std::min(thickness, contact.start + k_lift_speed * h) - contact.gap;
    x += (contact.start < 0 ? lift : std::max(lift, 0.0)) * n;
    if (contact.start < 0)
        v -= glm::dot(v, n) * n;
    const double normal_impulse = std::max(-glm::dot(v, n), 0.0);
    v += normal_impulse * n;
    if (normal_impulse == 0)
        return;
    const glm::dvec3 tangential = v - glm::dot(v, n) * n;
    if (glm::length(tangential) <= mu_s * normal_impulse)
    {
        v -= tangential;
        const glm::dvec3 slid = x - from;
        x -= slid - glm::dot(slid, n) * n;
        return;
    }
    // The coefficient falls from static to kinetic within 1 mm/s of slip.
    const double speed = glm::length(tangential);
    const double range = 1e-3;
    const double fall = (mu_s - mu_k) * normal_impulse;
    double left = std::max(speed - mu_k * normal_impulse, 0.0);
    if (fall < range)
        left = std::min(left, (speed - mu_s * normal_impulse) * range / (range - fall));
    const double braking = 1 - left / speed;
    v -= braking * tangential;
    x -= 0.5 * h * braking * tangential;
}

} // namespace reference
