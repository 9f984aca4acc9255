// The header of a PLY file: the elements that follow, their counts and properties.
// Format: Turk 1994, "The PLY Polygon File Format".
#pragma once

#include "voile/result.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace voile::engine
{

enum class PlyFormat
{
    ascii,
    binary_little_endian,
    binary_big_endian
};

enum class PlyType
{
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
    Float32,
    Float64
};

// The use of a property in a mesh.
enum class PlyRole
{
    Skipped,
    X,
    Y,
    Z,
    Corners
};

struct PlyProperty
{
    std::string name;
    PlyType type = PlyType::Float32; // of the value, or of a list's values
    bool is_list = false;
    PlyType count_type = PlyType::Uint8; // of a list's length; never a float
    PlyRole role = PlyRole::Skipped;     // Corners only for a list of integers
};

struct PlyElement
{
    std::string name;
    uint32_t count = 0; // up to 2^31 - 1
    std::vector<PlyProperty> properties;
};

// Has an element "vertex" with X, Y and Z and an element "face" with Corners, both with entries.
struct PlyHeader
{
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;
    uint32_t vertices = 0;
    uint32_t lines = 0; // of the header itself

    [[nodiscard]] bool is_ascii() const { return format == PlyFormat::ascii; }
};

// Takes the header off the text. Errors: "NAME:LINE: REASON", or "NAME: REASON" for the file as a whole.
Result<PlyHeader> take_ply_header(std::string_view& text, const std::string& name);

} // namespace voile::engine
