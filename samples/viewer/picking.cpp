// Picking.
#include "samples/viewer/picking.hpp"

#include "voile/engine/app/camera_control.hpp"

#include <cmath>
#include <limits>

namespace viewer
{
namespace
{

// The distance to a triangle, or nothing (Möller and Trumbore 1997), from either side.
std::optional<float> triangle_distance(const Ray& ray, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c)
{
    const glm::vec3 ab = b - a;
    const glm::vec3 ac = c - a;
    const glm::vec3 p = glm::cross(ray.direction, ac);
    const float determinant = glm::dot(ab, p);
    if (determinant == 0)
        return std::nullopt;
    const glm::vec3 from_a = ray.origin - a;
    const float u = glm::dot(from_a, p) / determinant;
    const glm::vec3 q = glm::cross(from_a, ab);
    const float v = glm::dot(ray.direction, q) / determinant;
    const float distance = glm::dot(ac, q) / determinant;
    if (u < 0 || v < 0 || u + v > 1 || distance <= 0)
        return std::nullopt;
    return distance;
}

struct Hit
{
    size_t triangle = 0;
    float distance = 0;
};

// The first triangle that the ray hits. Positions have three numbers or four.
template <typename Position>
std::optional<Hit> first_hit(const Ray& ray, std::span<const Position> positions, std::span<const glm::uvec3> triangles)
{
    std::optional<Hit> hit;
    for (size_t i = 0; i < triangles.size(); ++i)
    {
        const glm::uvec3& triangle = triangles[i];
        const auto distance =
            triangle_distance(ray, positions[triangle.x], positions[triangle.y], positions[triangle.z]);
        if (distance && (!hit || *distance < hit->distance))
            hit = Hit{i, *distance};
    }
    return hit;
}

} // namespace

Ray ray_through(const voile::engine::Camera& camera, const glm::vec2& cursor, float aspect)
{
    const voile::engine::CameraAxes axes = voile::engine::axes_of(camera);
    const float half_height = std::tan(glm::radians(0.5f * camera.fov)); // at 1 m
    const float x = (2 * cursor.x - 1) * half_height * aspect;
    const float y = (1 - 2 * cursor.y) * half_height;
    return {camera.position, glm::normalize(axes.forward + x * axes.right + y * axes.up)};
}

glm::vec3 point_in_plane(const voile::engine::Camera& camera, const Ray& ray, const glm::vec3& point)
{
    const glm::vec3 forward = voile::engine::axes_of(camera).forward;
    const float depth = glm::dot(point - ray.origin, forward);
    return ray.origin + depth / glm::dot(ray.direction, forward) * ray.direction;
}

std::optional<PickedVertex> pick_vertex(const Ray& ray, std::span<const glm::vec4> positions,
                                        std::span<const glm::uvec3> triangles)
{
    const auto hit = first_hit(ray, positions, triangles);
    if (!hit)
        return std::nullopt;
    const glm::vec3 point = ray.origin + hit->distance * ray.direction;
    const glm::uvec3& corners = triangles[hit->triangle];
    std::optional<PickedVertex> picked;
    float least = std::numeric_limits<float>::infinity();
    for (const uint32_t vertex : {corners.x, corners.y, corners.z})
    {
        const float distance = glm::distance(glm::vec3(positions[vertex]), point);
        if (positions[vertex].w <= 0 || distance >= least)
            continue;
        least = distance;
        picked = PickedVertex{vertex, hit->distance};
    }
    return picked;
}

std::optional<float> hit_distance(const Ray& ray, const glm::mat4& placed, std::span<const glm::vec3> positions,
                                  std::span<const glm::uvec3> triangles)
{
    const glm::mat4 back = glm::inverse(placed);
    // Not of unit length, so that distances stay those of the world.
    const Ray seen{glm::vec3(back * glm::vec4(ray.origin, 1)), glm::mat3(back) * ray.direction};
    const auto hit = first_hit(seen, positions, triangles);
    return hit ? std::optional(hit->distance) : std::nullopt;
}

} // namespace viewer
