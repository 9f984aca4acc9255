// Small helpers for the words of messages and file names.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace viewer
{

// The same string with every control character replaced by '?': it would break a message into lines.
std::string one_line(std::string text);

// At most `most` bytes of a text in UTF-8, cut between characters, with "..." where something was left out.
std::string shortened(const std::string& text, size_t most = 80);

// The text, shortened, in quotation marks.
std::string in_quotes(const std::string& text);

// A number as somebody would write it: 0.2, not 0.200000003.
std::string number_text(double value);
std::string number_text(float value);

// "; did you mean "x"?", or nothing where no candidate is close.
std::string suggestion(const std::string& word, const std::vector<std::string>& candidates);

// ".obj" of "Cloth.OBJ".
std::string lower_extension(const std::filesystem::path& path);

} // namespace viewer
