// A font of five by seven squares per letter.
#include "label.hpp"

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace scenes
{

namespace
{

struct Glyph
{
    char letter;
    std::array<uint8_t, 7> rows; // from the top; the highest of five bits is the left square
};

constexpr Glyph k_font[] = {
    {' ', {0, 0, 0, 0, 0, 0, 0}},        {'-', {0, 0, 0, 14, 0, 0, 0}},       {'.', {0, 0, 0, 0, 0, 12, 12}},
    {'0', {14, 17, 19, 21, 25, 17, 14}}, {'1', {4, 12, 4, 4, 4, 4, 14}},      {'2', {14, 17, 1, 2, 4, 8, 31}},
    {'3', {31, 2, 4, 2, 1, 17, 14}},     {'4', {2, 6, 10, 18, 31, 2, 2}},     {'5', {31, 16, 30, 1, 1, 17, 14}},
    {'6', {6, 8, 16, 30, 17, 17, 14}},   {'7', {31, 1, 2, 4, 8, 8, 8}},       {'8', {14, 17, 17, 14, 17, 17, 14}},
    {'9', {14, 17, 17, 15, 1, 2, 12}},   {'a', {0, 0, 14, 1, 15, 17, 15}},    {'c', {0, 0, 14, 16, 16, 17, 14}},
    {'d', {1, 1, 13, 19, 17, 17, 15}},   {'e', {0, 0, 14, 17, 31, 16, 14}},   {'h', {16, 16, 22, 25, 17, 17, 17}},
    {'i', {4, 0, 12, 4, 4, 4, 14}},      {'k', {16, 16, 18, 20, 24, 20, 18}}, {'l', {12, 4, 4, 4, 4, 4, 14}},
    {'m', {0, 0, 26, 21, 21, 17, 17}},   {'n', {0, 0, 22, 25, 17, 17, 17}},   {'o', {0, 0, 14, 17, 17, 17, 14}},
    {'r', {0, 0, 22, 25, 16, 16, 16}},   {'s', {0, 0, 14, 16, 14, 1, 30}},    {'t', {8, 8, 28, 8, 8, 9, 6}},
    {'w', {0, 0, 17, 17, 21, 21, 10}},   {'x', {0, 0, 17, 10, 4, 10, 17}}};

const Glyph& glyph(char letter)
{
    for (const Glyph& known : k_font)
        if (known.letter == letter)
            return known;
    throw std::invalid_argument(std::string("no glyph for ") + letter);
}

// A square as a low box without a back.
void add_square(voile::engine::Mesh& mesh, const glm::vec2& corner, float side)
{
    const float depth = 0.4f * side;
    const auto add_quad = [&](const glm::vec3& a, const glm::vec3& along, const glm::vec3& up)
    {
        const auto first = static_cast<uint32_t>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {a, a + along, a + along + up, a + up});
        mesh.triangles.emplace_back(first, first + 1, first + 2);
        mesh.triangles.emplace_back(first, first + 2, first + 3);
    };
    const glm::vec3 p(corner, 0);
    const glm::vec3 x(side, 0, 0);
    const glm::vec3 y(0, side, 0);
    const glm::vec3 z(0, 0, depth);
    add_quad(p + z, x, y);
    add_quad(p, x, z);
    add_quad(p + y + z, x, -z);
    add_quad(p + z, y, -z);
    add_quad(p + x, y, z);
}

} // namespace

voile::engine::Mesh make_label(std::string_view text, float height)
{
    constexpr int k_columns = 6; // five and a gap
    constexpr int k_rows = 7;
    const float side = height / k_rows;
    const float width = side * static_cast<float>(k_columns * static_cast<int>(text.size()) - 1);
    voile::engine::Mesh mesh;
    for (size_t i = 0; i < text.size(); ++i)
    {
        const Glyph& letter = glyph(text[i]);
        for (int row = 0; row < k_rows; ++row)
            for (int column = 0; column < 5; ++column)
                if ((letter.rows[static_cast<size_t>(row)] >> (4 - column) & 1) != 0)
                    add_square(mesh,
                               {side * static_cast<float>(static_cast<int>(i) * k_columns + column) - 0.5f * width,
                                side * static_cast<float>(k_rows - 1 - row) - 0.5f * height},
                               side);
    }
    return mesh;
}

} // namespace scenes
