#include "samples/viewer/text.hpp"

#include "voile/engine/assets/words.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <limits>
#include <numeric>
#include <utility>

namespace viewer
{
namespace
{

// Damerau 1964, in the form of the optimal string alignment: the fewest insertions, deletions and replacements of a
// character and swaps of neighbors between two words.
size_t edit_distance(const std::string& a, const std::string& b)
{
    std::vector<size_t> before_last(b.size() + 1);
    std::vector<size_t> last(b.size() + 1);
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (size_t i = 1; i <= a.size(); ++i)
    {
        std::swap(before_last, last);
        std::swap(last, row);
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j)
        {
            const size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before_last[j - 2] + 1);
        }
    }
    return row[b.size()];
}

std::string printed(double value, int digits)
{
    std::array<char, 32> text{};
    (void)std::snprintf(text.data(), text.size(), "%.*g", digits, value);
    return text.data();
}

} // namespace

std::string in_quotes(std::string_view text)
{
    return '"' + voile::gpu::printable(text) + '"';
}

std::string path_in_quotes(const std::filesystem::path& path)
{
    return '"' + voile::engine::path_text(path) + '"';
}

void note(const std::string& text)
{
    std::fprintf(stderr, "viewer: note: %s\n", text.c_str());
}

std::string number_text(double value)
{
    return printed(value, std::numeric_limits<double>::digits10);
}

std::string number_text(float value)
{
    return printed(static_cast<double>(value), std::numeric_limits<float>::digits10);
}

std::string suggestion(const std::string& word, const std::vector<std::string>& candidates)
{
    constexpr size_t k_longest_word = 64; // longer words are no mistyped keys
    if (word.size() > k_longest_word)
        return "";
    const std::string* best = nullptr;
    size_t best_distance = std::min<size_t>(3, (word.size() + 1) / 2);
    for (const std::string& candidate : candidates)
    {
        const size_t distance = edit_distance(word, candidate);
        if (distance < best_distance)
        {
            best = &candidate;
            best_distance = distance;
        }
    }
    const auto begins = [&](const std::string& candidate) { return candidate.starts_with(word); };
    if (best == nullptr && word.size() > 1 && std::ranges::count_if(candidates, begins) == 1)
        best = &*std::ranges::find_if(candidates, begins);
    return best == nullptr ? "" : "; did you mean " + in_quotes(*best) + "?";
}

std::string lower_extension(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

} // namespace viewer
