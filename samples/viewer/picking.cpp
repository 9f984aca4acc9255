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
std::optional<float> hit_distance(const Ray& ray, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c)
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
    float nearest = std::numeric_limits<float>::infinity();
    const glm::uvec3* hit = nullptr;
    for (const glm::uvec3& triangle : triangles)
    {
        const auto distance = hit_distance(ray, positions[triangle.x], positions[triangle.y], positions[triangle.z]);
        if (!distance || *distance >= nearest)
            continue;
        nearest = *distance;
        hit = &triangle;
    }
    if (hit == nullptr)
        return std::nullopt;
    const glm::vec3 point = ray.origin + nearest * ray.direction;
    std::optional<PickedVertex> picked;
    float least = std::numeric_limits<float>::infinity();
    for (const uint32_t vertex : {hit->x, hit->y, hit->z})
    {
        const float distance = glm::distance(glm::vec3(positions[vertex]), point);
        if (positions[vertex].w <= 0 || distance >= least)
            continue;
        least = distance;
        picked = PickedVertex{vertex, nearest};
    }
    return picked;
}

} // namespace viewer
