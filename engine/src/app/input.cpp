// Input: GLFW's callbacks.
#include "app/input_events.hpp"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

namespace voile::engine
{

namespace
{

static_assert(static_cast<int>(Key::space) == GLFW_KEY_SPACE && static_cast<int>(Key::period) == GLFW_KEY_PERIOD &&
              static_cast<int>(Key::a) == GLFW_KEY_A && static_cast<int>(Key::w) == GLFW_KEY_W &&
              static_cast<int>(Key::escape) == GLFW_KEY_ESCAPE &&
              static_cast<int>(Key::backspace) == GLFW_KEY_BACKSPACE && static_cast<int>(Key::del) == GLFW_KEY_DELETE &&
              static_cast<int>(Key::up) == GLFW_KEY_UP && static_cast<int>(Key::end) == GLFW_KEY_END &&
              static_cast<int>(Key::f1) == GLFW_KEY_F1 && static_cast<int>(Key::f12) == GLFW_KEY_F12);

Input& input_of(GLFWwindow* window)
{
    return *static_cast<Input*>(glfwGetWindowUserPointer(window));
}

void set_modifiers(Input& input, int modifiers)
{
    input.control = (modifiers & GLFW_MOD_CONTROL) != 0;
    input.shift = (modifiers & GLFW_MOD_SHIFT) != 0;
    input.alt = (modifiers & GLFW_MOD_ALT) != 0;
}

void on_key(GLFWwindow* window, int key, int, int action, int modifiers)
{
    Input& input = input_of(window);
    set_modifiers(input, modifiers);
    if (key < 0 || static_cast<size_t>(key) >= input.held.size())
        return;
    input.held[static_cast<size_t>(key)] = action != GLFW_RELEASE;
    if (action != GLFW_RELEASE)
        input.keys.push_back({static_cast<Key>(key), action == GLFW_REPEAT, input.control});
}

void on_button(GLFWwindow* window, int number, int action, int modifiers)
{
    Input& input = input_of(window);
    set_modifiers(input, modifiers);
    MouseButton* button = number == GLFW_MOUSE_BUTTON_LEFT     ? &input.left
                          : number == GLFW_MOUSE_BUTTON_RIGHT  ? &input.right
                          : number == GLFW_MOUSE_BUTTON_MIDDLE ? &input.middle
                                                               : nullptr;
    if (button == nullptr)
        return;
    button->held = action == GLFW_PRESS;
    (button->held ? button->pressed : button->released) = true;
    if (button->held)
        button->at = input.cursor;
}

void on_cursor(GLFWwindow* window, double x, double y)
{
    Input& input = input_of(window);
    int width = 0;
    int height = 0;
    glfwGetWindowSize(window, &width, &height);
    const glm::vec2 size(std::max(width, 1), std::max(height, 1));
    const glm::vec2 cursor = glm::vec2(x, y) / size;
    for (MouseButton* button : {&input.left, &input.right, &input.middle})
        if (button->held)
            button->dragged += (cursor - input.cursor) * size;
    input.cursor = cursor;
    input.height = size.y;
}

void on_drop(GLFWwindow* window, int count, const char** paths)
{
    for (int i = 0; i < count; ++i)
        input_of(window).dropped.emplace_back(paths[i]);
}

// Keys and buttons that are released while another window has the focus are never reported.
void on_focus(GLFWwindow* window, int focused)
{
    Input& input = input_of(window);
    if (focused == GLFW_TRUE)
        return;
    input.held.reset();
    set_modifiers(input, 0);
}

} // namespace

void Input::begin_frame()
{
    wheel = 0;
    for (MouseButton* button : {&left, &right, &middle})
    {
        button->pressed = button->released = false;
        button->dragged = {};
    }
    keys.clear();
    text.clear();
    dropped.clear();
}

void collect_input(GLFWwindow* window, Input& input)
{
    glfwSetWindowUserPointer(window, &input);
    glfwSetKeyCallback(window, on_key);
    glfwSetMouseButtonCallback(window, on_button);
    glfwSetCursorPosCallback(window, on_cursor);
    glfwSetScrollCallback(window, [](GLFWwindow* self, double, double turns)
                          { input_of(self).wheel += static_cast<float>(turns); });
    glfwSetCharCallback(window, [](GLFWwindow* self, unsigned int character)
                        { input_of(self).text.push_back(static_cast<char32_t>(character)); });
    glfwSetDropCallback(window, on_drop);
    glfwSetWindowFocusCallback(window, on_focus);
}

} // namespace voile::engine
