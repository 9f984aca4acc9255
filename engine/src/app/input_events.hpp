// Fills an Input from the events of a GLFW window.
#pragma once

#include "voile/engine/app/input.hpp"

struct GLFWwindow;

namespace voile::engine
{

// Takes the window's user pointer and its callbacks. `input` must live as long as the window.
void collect_input(GLFWwindow* window, Input& input);

} // namespace voile::engine
