#include "samples/viewer/scene_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace viewer
{
namespace
{

std::string range_text(Range range)
{
    if (range.or_zero)
    {
        range.or_zero = false;
        return range_text(range) + ", or 0 for none";
    }
    const bool below = std::isfinite(range.max);
    const bool above = std::isfinite(range.min);
    if (range.min_excluded && below)
        return "it must be larger than " + number_text(range.min) + " and at most " + number_text(range.max);
    if (above && below)
        return "it must be within " + number_text(range.min) + " to " + number_text(range.max);
    if (above)
        return (range.min_excluded ? "it must be larger than " : "it must be at least ") + number_text(range.min);
    return "it must be at most " + number_text(range.max);
}

} // namespace

Range between(float min, float max)
{
    return {std::strtod(number_text(min).c_str(), nullptr), std::strtod(number_text(max).c_str(), nullptr)};
}

void SceneReader::fail(uint32_t line, const std::string& message)
{
    if (!error_)
        error_ = file_ + ":" + std::to_string(line) + ": " + message;
}

void SceneReader::fail(const Field& field, const std::string& reason)
{
    fail(field.line(), (field.path.empty() ? "the scene" : field.path) + " " + reason);
}

bool SceneReader::expect(const Field& field, JsonNode::Kind kind, const char* expected)
{
    if (failed() || !field)
        return false;
    if (field.node->kind != kind)
        fail(field, std::string("is ") + describe(field.node->kind) + "; expected " + expected);
    return !failed();
}

bool SceneReader::object(const Field& field, const std::vector<std::string>& keys)
{
    if (!expect(field, JsonNode::Kind::object, "an object"))
        return false;
    for (size_t i = 0; i < field.node->keys.size(); ++i)
    {
        const std::string& key = field.node->keys[i];
        if (std::find(keys.begin(), keys.end(), key) != keys.end())
            continue;
        fail(field.node->items[i].line, "unknown key " + in_quotes(key) + " in " +
                                            (field.path.empty() ? "the scene" : field.path) + suggestion(key, keys));
        return false;
    }
    return true;
}

bool SceneReader::array(const Field& field, size_t length)
{
    const std::string expected = length == 0 ? "an array" : "an array of " + std::to_string(length) + " numbers";
    if (!expect(field, JsonNode::Kind::array, expected.c_str()))
        return false;
    const size_t count = field.node->items.size();
    if (length != 0 && count != length)
        fail(field, "has " + std::to_string(count) + (count == 1 ? " item" : " items") + "; expected " + expected);
    return !failed();
}

Field SceneReader::child(const Field& object, const char* key)
{
    const std::string path = object.path.empty() ? key : object.path + "." + key;
    return Field{object.node != nullptr ? object.node->find(key) : nullptr, path};
}

Field SceneReader::item(const Field& array, size_t index)
{
    return Field{&array.node->items[index], array.path + "[" + std::to_string(index) + "]"};
}

Field SceneReader::required(const Field& object, const char* key)
{
    Field field = child(object, key);
    if (!field && !failed())
        fail(object, "has no " + in_quotes(key));
    return field;
}

void SceneReader::read(const Field& field, bool& out)
{
    if (expect(field, JsonNode::Kind::boolean, "true or false"))
        out = field.node->boolean;
}

void SceneReader::read(const Field& field, std::string& out)
{
    if (!expect(field, JsonNode::Kind::string, "a string"))
        return;
    if (field.node->text.empty())
        return fail(field, "is empty");
    if (field.node->text.find('\0') != std::string::npos)
        return fail(field, "holds a null character");
    out = field.node->text;
}

void SceneReader::read(const Field& field, Range range, float& out)
{
    if (!expect(field, JsonNode::Kind::number, "a number"))
        return;
    const double value = field.node->number;
    // What a float cannot hold would become infinite here, or a zero that slips past the range.
    if (std::abs(value) > static_cast<double>(std::numeric_limits<float>::max()))
        return fail(field, "is " + number_text(value) + ", beyond single precision");
    const auto narrowed = static_cast<double>(static_cast<float>(value));
    const bool too_small = value < range.min || (range.min_excluded && narrowed <= range.min);
    if ((too_small || value > range.max) && !(range.or_zero && value == 0))
        return fail(field, "is " + number_text(value) + "; " + range_text(range));
    out = static_cast<float>(value);
}

void SceneReader::read(const Field& field, Range range, std::optional<float>& out)
{
    if (!field)
        return;
    float value = 0.f;
    read(field, range, value);
    out = value;
}

void SceneReader::read(const Field& field, Range range, glm::vec2& out)
{
    if (!array(field, 2))
        return;
    read(item(field, 0), range, out.x);
    read(item(field, 1), range, out.y);
}

void SceneReader::read(const Field& field, Range range, glm::vec3& out)
{
    if (!array(field, 3))
        return;
    read(item(field, 0), range, out.x);
    read(item(field, 1), range, out.y);
    read(item(field, 2), range, out.z);
}

void SceneReader::read_integer(const Field& field, uint32_t min, uint32_t max, uint32_t& out)
{
    if (!expect(field, JsonNode::Kind::number, "a whole number"))
        return;
    const double value = field.node->number;
    if (value != std::floor(value))
        return fail(field, "is " + number_text(value) + "; expected a whole number");
    const Range range{static_cast<double>(min), static_cast<double>(max)};
    if (value < range.min || value > range.max)
        return fail(field, "is " + number_text(value) + "; " + range_text(range));
    out = static_cast<uint32_t>(value);
}

std::optional<size_t> SceneReader::read_word(const Field& field, const char* what,
                                             std::initializer_list<const char*> words)
{
    return read_word(field, what, std::span(words.begin(), words.size()));
}

std::optional<size_t> SceneReader::read_word(const Field& field, const char* what, std::span<const char* const> words)
{
    std::string word;
    read(field, word);
    if (failed() || !field)
        return std::nullopt;
    const auto found = std::find(words.begin(), words.end(), word);
    if (found != words.end())
        return static_cast<size_t>(found - words.begin());
    std::string list;
    for (const char* each : words)
        list += (list.empty() ? "" : ", ") + std::string(each);
    fail(field, "is " + in_quotes(word) + ", which is not " + what + " (" + list + ")" +
                    suggestion(word, {words.begin(), words.end()}));
    return std::nullopt;
}

} // namespace viewer
