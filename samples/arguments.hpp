// Arguments of the small samples other than foreign_engine: [--headless [FRAMES]], or none.
#pragma once

#include "voile/gpu/printable.hpp"

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace samples
{

struct Arguments
{
    bool headless = false;
    uint32_t frames = 60;
};

inline constexpr uint32_t k_most_frames = 1'000'000; // 4.6 hours of simulated time

inline std::string quoted(const char* argument)
{
    return '\'' + voile::gpu::printable(argument) + '\'';
}

// Prints the usage and returns true if --help is among the arguments.
inline bool print_help(const std::string& usage, int count, char** arguments)
{
    for (int i = 1; i < count; ++i)
        if (arguments[i] == std::string_view("--help"))
        {
            std::printf("%s\n", usage.c_str());
            return true;
        }
    return false;
}

// Empty after --help. std::runtime_error reports an unknown argument or a bad value, and the usage.
inline std::optional<Arguments> parse_arguments(const std::string& sample, int count, char** arguments)
{
    const std::string range = "1 to " + std::to_string(k_most_frames);
    const std::string usage = "usage: " + sample +
                              " [--headless [FRAMES]]\n"
                              "  --headless  simulates FRAMES frames without a window and writes " +
                              sample + ".png\n  FRAMES      " + range + ", 60 by default";
    if (print_help(usage, count, arguments))
        return {};
    Arguments result;
    if (count < 2)
        return result;
    if (arguments[1] != std::string_view("--headless"))
        throw std::runtime_error("unknown argument " + quoted(arguments[1]) + '\n' + usage);
    result.headless = true;
    if (count < 3)
        return result;
    const std::string_view word = arguments[2];
    const auto read = std::from_chars(word.data(), word.data() + word.size(), result.frames);
    if (read.ec != std::errc{} || read.ptr != word.data() + word.size() || result.frames == 0 ||
        result.frames > k_most_frames)
        throw std::runtime_error("FRAMES: " + quoted(arguments[2]) + " is not a whole number from " + range + '\n' +
                                 usage);
    if (count > 3)
        throw std::runtime_error("unknown argument " + quoted(arguments[3]) + '\n' + usage);
    return result;
}

// For a sample without arguments. False after --help.
inline bool parse_no_arguments(const std::string& sample, int count, char** arguments)
{
    const std::string usage = "usage: " + sample;
    if (print_help(usage, count, arguments))
        return false;
    if (count > 1)
        throw std::runtime_error("unknown argument " + quoted(arguments[1]) + '\n' + usage);
    return true;
}

} // namespace samples
