// Input: what the user does in a window, frame by frame.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <bitset>
#include <filesystem>
#include <string>
#include <vector>

namespace voile::engine
{

// Keys by their position on a US keyboard. Letters and signs have their ASCII codes.
enum class Key : int
{
    space = 32,
    period = 46,
    a = 65,
    d = 68,
    e = 69,
    f = 70,
    q = 81,
    r = 82,
    s = 83,
    w = 87,
    escape = 256,
    enter = 257,
    tab = 258,
    backspace = 259,
    del = 261,
    right = 262,
    left = 263,
    down = 264,
    up = 265,
    home = 268,
    end = 269,
    f1 = 290,
    f2 = 291,
    f12 = 301,
};

struct KeyPress
{
    Key key{};
    bool repeated = false; // the key has been held for a while
    bool control = false;
};

struct MouseButton
{
    bool held = false;      // now
    bool pressed = false;   // since the last frame; `held` may be false again
    bool released = false;  // since the last frame
    glm::vec2 at{0.f};      // the cursor when it was pressed last
    glm::vec2 dragged{0.f}; // pixels that the cursor has moved since the last frame while it was held
};

// Cursor positions are fractions of the window: (0, 0) is its upper left corner, (1, 1) its lower right one.
struct Input
{
    glm::vec2 cursor{0.f};
    float height = 1; // of the window, pixels
    float wheel = 0;  // turns away from the user
    MouseButton left;
    MouseButton right;
    MouseButton middle;
    std::vector<KeyPress> keys;                 // in their order
    std::u32string text;                        // characters that were typed
    std::vector<std::filesystem::path> dropped; // files
    std::bitset<512> held;                      // keys that are down; see is_held
    bool control = false;
    bool shift = false;
    bool alt = false;

    [[nodiscard]] bool is_held(Key key) const { return held[static_cast<size_t>(key)]; }

    // Forgets what has happened, and keeps what is held.
    void begin_frame();
};

} // namespace voile::engine
