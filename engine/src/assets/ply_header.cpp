// The header of a PLY file, line by line.
#include "assets/ply_header.hpp"

#include "voile/engine/assets/words.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <unordered_set>
#include <utility>

namespace voile::engine
{

namespace
{

using Words = std::vector<std::string_view>;
using Names = std::unordered_set<std::string_view>;

std::optional<PlyType> parse_type(std::string_view word)
{
    using enum PlyType;
    constexpr std::array<std::pair<std::string_view, PlyType>, 16> k_types = {{{"char", Int8},
                                                                               {"int8", Int8},
                                                                               {"uchar", Uint8},
                                                                               {"uint8", Uint8},
                                                                               {"short", Int16},
                                                                               {"int16", Int16},
                                                                               {"ushort", Uint16},
                                                                               {"uint16", Uint16},
                                                                               {"int", Int32},
                                                                               {"int32", Int32},
                                                                               {"uint", Uint32},
                                                                               {"uint32", Uint32},
                                                                               {"float", Float32},
                                                                               {"float32", Float32},
                                                                               {"double", Float64},
                                                                               {"float64", Float64}}};
    for (const auto& [name, type] : k_types)
        if (word == name)
            return type;
    return std::nullopt;
}

bool is_integer(PlyType type)
{
    return type != PlyType::Float32 && type != PlyType::Float64;
}

PlyRole role_of(const std::string& element, const PlyProperty& property)
{
    if (element == "vertex" && !property.is_list)
        return property.name == "x"   ? PlyRole::X
               : property.name == "y" ? PlyRole::Y
               : property.name == "z" ? PlyRole::Z
                                      : PlyRole::Skipped;
    const bool is_corners = property.name == "vertex_indices" || property.name == "vertex_index";
    return element == "face" && property.is_list && is_corners ? PlyRole::Corners : PlyRole::Skipped;
}

bool has_role(const PlyElement& element, PlyRole role)
{
    return std::any_of(element.properties.begin(), element.properties.end(),
                       [&](const PlyProperty& p) { return p.role == role; });
}

// Each function that reads a line returns an error, empty on success.

// format ascii 1.0
std::string read_format(const Words& words, PlyHeader& header)
{
    // In the order of PlyFormat.
    constexpr std::array<std::string_view, 3> k_names = {"ascii", "binary_little_endian", "binary_big_endian"};
    if (words.size() != 3 || words[0] != "format")
        return "expected 'format FORMAT 1.0'";
    const auto* const found = std::find(k_names.begin(), k_names.end(), words[1]);
    if (found == k_names.end())
        return "format " + quoted_word(words[1]) + " is not ascii, binary_little_endian or binary_big_endian";
    if (words[2] != "1.0")
        return "version " + quoted_word(words[2]) + " is not 1.0";
    header.format = static_cast<PlyFormat>(found - k_names.begin());
    return {};
}

// element vertex 8
std::string read_element(const Words& words, PlyHeader& header, Names& elements)
{
    if (words.size() != 3)
        return "expected 'element NAME COUNT'";
    PlyElement element;
    element.name = words[1];
    const auto [end, error] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
    if (error != std::errc{} || end != words[2].data() + words[2].size() ||
        element.count > uint32_t{std::numeric_limits<int32_t>::max()})
        return "count " + quoted_word(words[2]) + " is not a whole number from 0 to 2147483647";
    if (!elements.insert(words[1]).second)
        return "element " + quoted_word(words[1]) + " appears twice";
    header.elements.push_back(std::move(element));
    return {};
}

// property float x; property list uchar int vertex_indices
std::string read_property(const Words& words, PlyHeader& header)
{
    const bool is_list = words.size() > 1 && words[1] == "list";
    if (words.size() != (is_list ? 5u : 3u))
        return "expected 'property TYPE NAME' or 'property list COUNT_TYPE TYPE NAME'";
    if (header.elements.empty())
        return "property before any element";
    for (size_t i = is_list ? 2 : 1; i + 1 < words.size(); ++i)
        if (!parse_type(words[i]))
            return "type " + quoted_word(words[i]) + " is not known";

    PlyElement& element = header.elements.back();
    PlyProperty property{std::string(words.back()), *parse_type(words[words.size() - 2]), is_list};
    property.role = role_of(element.name, property);
    if (is_list)
        property.count_type = *parse_type(words[2]);
    if (!is_integer(property.count_type) || (property.role == PlyRole::Corners && !is_integer(property.type)))
        return "list " + quoted_word(property.name) + " is counted or indexed by " +
               std::string(words[is_integer(property.count_type) ? 3 : 2]) + ", needs an integer type";
    if (property.role != PlyRole::Skipped && has_role(element, property.role))
        return "property " + quoted_word(property.name) + " appears twice";
    element.properties.push_back(std::move(property));
    return {};
}

std::string read_statement(const Words& words, PlyHeader& header, Names& elements)
{
    if (words[0] == "element")
        return read_element(words, header, elements);
    if (words[0] == "property")
        return read_property(words, header);
    return quoted_word(words[0]) + " is not a statement of a PLY header";
}

// Returns what a mesh needs and the header lacks.
std::string find_missing(PlyHeader& header)
{
    constexpr std::array<std::pair<PlyRole, const char*>, 3> k_coordinates = {
        {{PlyRole::X, "x"}, {PlyRole::Y, "y"}, {PlyRole::Z, "z"}}};
    const PlyElement* faces = nullptr;
    for (const PlyElement& element : header.elements)
    {
        if (element.name == "face" && element.count > 0)
            faces = &element;
        if (element.name != "vertex" || element.count == 0)
            continue;
        header.vertices = element.count;
        for (const auto& [role, name] : k_coordinates)
            if (!has_role(element, role))
                return std::string("vertices have no property '") + name + "'";
    }
    if (header.vertices == 0)
        return "no vertices";
    if (faces == nullptr)
        return "no faces";
    return has_role(*faces, PlyRole::Corners) ? "" : "faces have no list 'vertex_indices' or 'vertex_index'";
}

} // namespace

Result<PlyHeader> take_ply_header(std::string_view& text, const std::string& name)
{
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
        return Error{name + ": file is empty"};
    PlyHeader header;
    Words words;
    Names elements;
    bool has_format = false;
    for (bool ended = false; !ended;)
    {
        if (text.empty())
            return Error{name + ": file ends before 'end_header'"};
        words.clear();
        split(take_line(text), words);
        ++header.lines;
        std::string reason;
        const bool is_comment = words.empty() || words[0] == "comment" || words[0] == "obj_info";
        if (header.lines == 1)
            reason = words.size() == 1 && words[0] == "ply" ? "" : "not a PLY file, the first line is not 'ply'";
        else if (!is_comment && !has_format)
        {
            reason = read_format(words, header);
            has_format = true;
        }
        else if (words.size() == 1 && words[0] == "end_header")
            ended = true;
        else if (!is_comment)
            reason = read_statement(words, header, elements);
        if (!reason.empty())
            return Error{name + ":" + std::to_string(header.lines) + ": " + reason};
    }
    const std::string missing = find_missing(header);
    if (!missing.empty())
        return Error{name + ": " + missing};
    return header;
}

} // namespace voile::engine
