// Lines, words and numbers of untrusted text files.
#pragma once

#include "voile/gpu/printable.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace voile::engine
{

// The separators between words of a line.
inline constexpr std::string_view k_blank = " \t\r\v\f";

// Takes the first line off the text, without its end: a line feed, a carriage return, or a carriage return and a line
// feed.
std::string_view take_line(std::string_view& text);

// Appends the line's words.
void split(std::string_view line, std::vector<std::string_view>& words);

// Empty if the word is not a number. A number too large for a float is infinite, one too small for a double is zero.
std::optional<double> parse_number(std::string_view word);

// A path, printable (gpu::printable). A long path keeps its end, after "...".
std::string path_text(const std::filesystem::path& path, size_t most = 240);

// A word in quotation marks, printable.
std::string quoted_word(std::string_view word);

} // namespace voile::engine
