// A JSON document as a tree. Its nodes have line numbers, so messages about a value can name its line.
#pragma once

#include "voile/result.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace viewer
{

struct JsonNode
{
    enum class Kind
    {
        null_value,
        boolean,
        number,
        string,
        array,
        object
    };

    Kind kind = Kind::null_value;
    uint32_t line = 0; // from 1; of a container, the line of its opening bracket
    bool boolean = false;
    bool integer = false; // a number written without fraction and exponent
    double number = 0;
    std::string text;
    std::vector<std::string> keys; // of an object, in the file's order, each once
    std::vector<JsonNode> items;   // of an array, or of an object beside `keys`

    // nullptr if this is no object or has no such key.
    [[nodiscard]] const JsonNode* find(std::string_view key) const;
};

// "a string", "an array" ..., for messages.
const char* describe(JsonNode::Kind kind);

// Parses strict JSON (no comments, no trailing commas). `file` only serves the messages. Errors, one line each: an
// empty text, a syntax error (FILE:LINE:COLUMN: reason), a number that no double holds, a key that appears twice in an
// object, more than 64 levels of nesting.
voile::Result<JsonNode> parse_json(std::string_view text, const std::string& file);

} // namespace viewer
