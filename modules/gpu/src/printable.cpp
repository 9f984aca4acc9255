// UTF-8, character by character (RFC 3629).
#include "voile/gpu/printable.hpp"

#include <cstdint>

namespace voile::gpu
{

namespace
{

constexpr char32_t k_no_character = 0xffffffff;

struct Character
{
    std::string_view bytes;
    char32_t code; // k_no_character: a byte that is not UTF-8
};

bool is_continuation(char byte)
{
    return (static_cast<unsigned char>(byte) & 0xc0u) == 0x80u;
}

// The length in bytes of a character that begins with this byte; 1 if none does.
size_t length_of(unsigned char first)
{
    return first < 0xc2 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 1;
}

Character take_character(std::string_view& text)
{
    const auto first = static_cast<unsigned char>(text[0]);
    size_t length = length_of(first);
    char32_t code = length == 1 ? first : first & (0xffu >> (length + 1));
    for (size_t i = 1; i < length; ++i)
    {
        if (i == text.size() || !is_continuation(text[i]))
            length = 1; // not a character
        else
            code = code << 6 | (static_cast<unsigned char>(text[i]) & 0x3fu);
    }
    constexpr char32_t k_least[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = code >= 0xd800 && code < 0xe000;
    if ((length == 1 && first >= 0x80) || code < k_least[length] || surrogate || code > 0x10ffff)
    {
        length = 1;
        code = k_no_character;
    }
    const Character character{text.substr(0, length), code};
    text.remove_prefix(length);
    return character;
}

bool is_shown(char32_t code)
{
    const auto within = [&](char32_t first, char32_t last) { return code >= first && code <= last; };
    const bool control = code < 0x20 || within(0x7f, 0x9f) || within(0x2028, 0x2029);
    const bool direction = code == 0x61c || within(0x200e, 0x200f) || within(0x202a, 0x202e) || within(0x2066, 0x2069);
    return code != k_no_character && !control && !direction;
}

} // namespace

std::string printable(std::string_view text, size_t most)
{
    std::string result;
    while (!text.empty())
    {
        const Character character = take_character(text);
        const std::string_view shown = is_shown(character.code) ? character.bytes : "?";
        if (result.size() + shown.size() > most)
            return result.append("...");
        result += shown;
    }
    return result;
}

} // namespace voile::gpu
