// Arguments of the small samples: [--headless [FRAMES]].
#pragma once

#include "voile/engine/assets/words.hpp"
#include "voile/engine/gpu/device.hpp"

#include <charconv>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace samples
{

struct Arguments
{
    bool headless = false;
    uint64_t frames = 60;
};

// StartupError says what is wrong.
inline Arguments parse_arguments(int count, char** arguments)
{
    Arguments result;
    if (count < 2)
        return result;
    if (arguments[1] != std::string_view("--headless") || count > 3)
        throw voile::engine::StartupError("arguments: [--headless [FRAMES]]");
    result.headless = true;
    if (count < 3)
        return result;
    const char* end = arguments[2] + std::strlen(arguments[2]);
    const auto read = std::from_chars(arguments[2], end, result.frames);
    if (read.ec != std::errc{} || read.ptr != end || result.frames == 0)
        throw voile::engine::StartupError("FRAMES: " + voile::engine::quoted_word(arguments[2]) +
                                          " is no number above 0");
    return result;
}

} // namespace samples
