// Lines, words and numbers.
#include "voile/engine/assets/words.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace voile::engine
{

std::string_view take_line(std::string_view& text)
{
    const auto end = std::find_if(text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; });
    const auto length = static_cast<size_t>(end - text.begin());
    const std::string_view line = text.substr(0, length);
    const size_t ending = text.substr(length).starts_with("\r\n") ? 2 : 1;
    text.remove_prefix(std::min(length + ending, text.size()));
    return line;
}

void split(std::string_view line, std::vector<std::string_view>& words)
{
    while (true)
    {
        const size_t begin = line.find_first_not_of(k_blank);
        if (begin == std::string_view::npos)
            return;
        line.remove_prefix(begin);
        const size_t length = std::min(line.find_first_of(k_blank), line.size());
        words.push_back(line.substr(0, length));
        line.remove_prefix(length);
    }
}

std::optional<double> parse_number(std::string_view word)
{
    if (word.starts_with('+') && !word.starts_with("+-"))
        word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::invalid_argument || end != word.data() + word.size())
        return std::nullopt;
    if (error == std::errc::result_out_of_range)
        return word.find("e-") != word.npos || word.find("E-") != word.npos ? 0. : HUGE_VAL;
    return std::abs(value) > double{std::numeric_limits<float>::max()} ? HUGE_VAL : value;
}

std::string path_text(const std::filesystem::path& path, size_t most)
{
    const std::string text = gpu::printable(path.string(), std::string::npos);
    if (text.size() <= most)
        return text;
    size_t begin = text.size() - most;
    while (begin < text.size() && (static_cast<unsigned char>(text[begin]) & 0xc0u) == 0x80u) // inside a character
        ++begin;
    return "..." + text.substr(begin);
}

std::string quoted_word(std::string_view word)
{
    constexpr size_t k_longest = 40;
    return '\'' + gpu::printable(word, k_longest) + '\'';
}

} // namespace voile::engine
