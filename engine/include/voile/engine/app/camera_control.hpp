// Moves a camera as the user does: orbit, pan, zoom, look, fly, and a view of everything.
#pragma once

#include "voile/engine/app/input.hpp"
#include "voile/engine/scene/scene.hpp"

namespace voile::engine
{

// The camera's axes in the world, of unit length.
struct CameraAxes
{
    glm::vec3 right;
    glm::vec3 up;
    glm::vec3 forward;
};
CameraAxes axes_of(const Camera& camera);

// Turns the camera around its target. Pixels to the right and down.
void orbit(Camera& camera, const glm::vec2& pixels);
// Turns the camera where it stands.
void look(Camera& camera, const glm::vec2& pixels);
// Moves camera and target so that the target's plane follows the cursor. Fractions of the picture's height.
void pan(Camera& camera, const glm::vec2& heights);
// Moves the camera towards its target, by a tenth of the distance per turn of the wheel.
void zoom(Camera& camera, float turns);
// Moves camera and target along the camera's axes: right, up, forward. m.
void fly(Camera& camera, const glm::vec3& distance);
// Shows a whole ball in the direction in which the camera looks. `aspect`: width over height of the picture.
void show_all(Camera& camera, const glm::vec3& center, float radius, float aspect);

// Steers by the mouse and the keys of a frame of `seconds`:
// - left drag: orbit. With shift, and middle drag: pan. Wheel: zoom. `left`: whether the left button steers.
// - right drag: look. While the right button is held, W S A D Q E fly, at half of `radius` (m) per second, with shift
//   at two.
void steer(Camera& camera, const Input& input, float seconds, float radius, bool left = true);

} // namespace voile::engine
