// Small helpers for the words of messages and file names.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace viewer
{

// The text in quotation marks, fit for a message (voile::gpu::printable).
std::string in_quotes(std::string_view text);

// A path in quotation marks.
std::string path_in_quotes(const std::filesystem::path& path);

// "viewer: note: TEXT" on standard error.
void note(const std::string& text);

// A number as people write it: 0.2, not 0.200000003.
std::string number_text(double value);
std::string number_text(float value);

// "; did you mean "x"?": a candidate that is close, else the only one that begins with the word, else nothing.
std::string suggestion(const std::string& word, const std::vector<std::string>& candidates);

// ".obj" of "Cloth.OBJ".
std::string lower_extension(const std::filesystem::path& path);

} // namespace viewer
