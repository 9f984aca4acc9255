// Validates the text of an OBJ file before tinyobjloader parses it. tinyobjloader turns a missing or unreadable number
// into zero and accepts any index. The check finds each such line and names it.
#pragma once

#include "voile/result.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace voile::engine
{

// Only the statements that make up a mesh: one per line, continued lines joined, only the numbers that the mesh uses,
// every index absolute and in range.
struct CheckedObj
{
    std::string text;
    std::vector<uint32_t> face_sizes; // corners of each face; tinyobjloader counts them in a byte
};

// Errors: "NAME:LINE: REASON" for the first faulty line, "NAME: REASON" for the file as a whole.
Result<CheckedObj> check_obj(std::string_view text, const std::string& name);

} // namespace voile::engine
