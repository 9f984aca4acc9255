// Moves of the camera.
#include "voile/engine/app/camera_control.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace
{

using voile::engine::Camera;
using voile::engine::Input;
using voile::engine::Key;

constexpr Camera k_camera{.position = {0, 1, 4}, .target = {0, 1, 0}, .fov = 60};

void check_near(const glm::vec3& a, const glm::vec3& b)
{
    CAPTURE(a.x);
    CAPTURE(a.y);
    CAPTURE(a.z);
    CHECK(glm::distance(a, b) < 1e-5f);
}

Input holding(Key key)
{
    Input input;
    input.right.held = true;
    input.held.set(static_cast<size_t>(key));
    return input;
}

} // namespace

TEST_CASE("a camera orbits, looks, pans, zooms and shows a whole ball")
{
    Camera camera = k_camera;
    voile::engine::orbit(camera, {-100 * std::acos(-1.f), 0}); // a quarter turn
    check_near(camera.position, {4, 1, 0});
    check_near(camera.target, k_camera.target);
    voile::engine::orbit(camera, {0, 1e6f}); // never over the top
    CHECK(camera.position.y < 5);
    CHECK(glm::distance(camera.position, camera.target) == doctest::Approx(4));

    camera = k_camera;
    voile::engine::look(camera, {100 * std::acos(-1.f), 0});
    check_near(camera.position, k_camera.position);
    check_near(camera.target, {4, 1, 4});

    camera = k_camera;
    voile::engine::pan(camera, {0.5f, 0}); // half of the picture's height, which is 8 tan 30° m at the target
    check_near(camera.target, {-4 * std::tan(std::acos(-1.f) / 6), 1, 0});
    check_near(camera.position - camera.target, k_camera.position - k_camera.target);

    camera = k_camera;
    voile::engine::zoom(camera, 1);
    check_near(camera.position, {0, 1, 3.6f});

    camera = k_camera;
    voile::engine::show_all(camera, {1, 2, 3}, 0.5f, 2);
    check_near(camera.target, {1, 2, 3});
    check_near(camera.position, {1, 2, 3 + 1.05f}); // a ball of 0.5 m fills 60° from 1 m away
    voile::engine::show_all(camera, {1, 2, 3}, 0.5f, 0.5f);
    CHECK(camera.position.z > 4.8f); // a narrow picture needs more distance
}

TEST_CASE("keys fly while the right button is held")
{
    Camera camera = k_camera;
    voile::engine::steer(camera, holding(Key::w), 0.1f, 10); // a tenth of a second at five meters per second
    check_near(camera.position, {0, 1, 3.5f});
    check_near(camera.target, {0, 1, -0.5f});
    voile::engine::steer(camera, holding(Key::d), 7, 10); // no frame counts as more than a tenth of a second
    check_near(camera.position, {0.5f, 1, 3.5f});
    Input released = holding(Key::w);
    released.right.held = false;
    voile::engine::steer(camera, released, 0.5f, 2);
    check_near(camera.position, {0.5f, 1, 3.5f});
}
