// Camera control.
#include "voile/engine/app/camera_control.hpp"

#include <algorithm>
#include <cmath>

namespace voile::engine
{

namespace
{

constexpr float k_radians_per_pixel = 0.005f;
constexpr float k_steepest = 1.5f; // radians above or below the horizon

// `offset` turned about the vertical and towards it.
glm::vec3 turned(const glm::vec3& offset, float azimuth_change, float elevation_change)
{
    const float distance = glm::length(offset);
    const float azimuth = std::atan2(offset.x, offset.z) + azimuth_change;
    const float elevation =
        glm::clamp(std::asin(glm::clamp(offset.y / distance, -1.f, 1.f)) + elevation_change, -k_steepest, k_steepest);
    return distance * glm::vec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                std::cos(elevation) * std::cos(azimuth));
}

float key_axis(const Input& input, Key plus, Key minus)
{
    return static_cast<float>(input.is_held(plus)) - static_cast<float>(input.is_held(minus));
}

} // namespace

CameraAxes axes_of(const Camera& camera)
{
    const glm::vec3 forward = glm::normalize(camera.target - camera.position);
    const bool vertical = std::abs(forward.x) + std::abs(forward.z) < 1e-4f;
    const glm::vec3 right = glm::normalize(glm::cross(forward, vertical ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0)));
    return {right, glm::cross(right, forward), forward};
}

void orbit(Camera& camera, const glm::vec2& pixels)
{
    camera.position = camera.target + turned(camera.position - camera.target, -pixels.x * k_radians_per_pixel,
                                             pixels.y * k_radians_per_pixel);
}

void look(Camera& camera, const glm::vec2& pixels)
{
    camera.target = camera.position + turned(camera.target - camera.position, -pixels.x * k_radians_per_pixel,
                                             -pixels.y * k_radians_per_pixel);
}

void pan(Camera& camera, const glm::vec2& heights)
{
    const float height = 2 * glm::distance(camera.position, camera.target) *
                         std::tan(glm::radians(0.5f * camera.fov)); // m, at the target
    const CameraAxes axes = axes_of(camera);
    const glm::vec3 moved = height * (heights.y * axes.up - heights.x * axes.right);
    camera.position += moved;
    camera.target += moved;
}

void zoom(Camera& camera, float turns)
{
    camera.position = camera.target + std::pow(0.9f, turns) * (camera.position - camera.target);
}

void fly(Camera& camera, const glm::vec3& distance)
{
    const CameraAxes axes = axes_of(camera);
    const glm::vec3 moved = distance.x * axes.right + distance.y * axes.up + distance.z * axes.forward;
    camera.position += moved;
    camera.target += moved;
}

void show_all(Camera& camera, const glm::vec3& center, float radius, float aspect)
{
    const float half = glm::radians(0.5f * camera.fov);
    const float narrow = std::min(half, std::atan(aspect * std::tan(half)));
    const glm::vec3 forward = axes_of(camera).forward;
    camera.target = center;
    camera.position = center - 1.05f * radius / std::sin(narrow) * forward;
}

void steer(Camera& camera, const Input& input, float seconds, float radius, bool left)
{
    constexpr float k_speed = 0.5f; // radii per second
    constexpr float k_fast = 2;
    constexpr float k_longest = 0.1f; // s: a stall is no long flight
    const glm::vec2 left_drag = left ? input.left.dragged : glm::vec2(0);
    const glm::vec2 panned = input.middle.dragged + (input.shift ? left_drag : glm::vec2(0));
    if (panned != glm::vec2(0))
        pan(camera, panned / input.height);
    if (left_drag != glm::vec2(0) && !input.shift)
        orbit(camera, left_drag);
    if (input.right.dragged != glm::vec2(0))
        look(camera, input.right.dragged);
    if (input.right.held)
        fly(camera, (input.shift ? k_fast : k_speed) * radius * std::min(seconds, k_longest) *
                        glm::vec3(key_axis(input, Key::d, Key::a), key_axis(input, Key::e, Key::q),
                                  key_axis(input, Key::w, Key::s)));
    if (input.wheel != 0)
        zoom(camera, input.wheel);
}

} // namespace voile::engine
