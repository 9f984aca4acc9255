// Reads typed values out of a scene's JSON tree and words what is wrong with them. The first error is kept; every call
// after it does nothing, so that a parser reads straight down.
#pragma once

#include "samples/viewer/json_tree.hpp"
#include "samples/viewer/text.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace viewer
{

// A value in the tree with the words for where it is ("cloths[0].grid"). Absent where the file does not have it.
struct Field
{
    const JsonNode* node = nullptr;
    std::string path;

    explicit operator bool() const { return node != nullptr; }
    [[nodiscard]] uint32_t line() const { return node != nullptr ? node->line : 0; }
};

struct Range
{
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    bool min_excluded = false;
    bool or_zero = false; // 0 is valid as well, and means none
};
constexpr Range k_any{};
constexpr Range k_positive{0, std::numeric_limits<double>::infinity(), true};
constexpr Range k_not_negative{0};
constexpr Range k_duration{0, 1000}; // s
// Bounds as their decimals read: 0.0001 is not 9.9999997e-05.
Range between(float min, float max);
inline Range within(float most)
{
    return between(-most, most);
}

class SceneReader
{
public:
    explicit SceneReader(std::string file) : file_(std::move(file)) {} // its name in messages

    [[nodiscard]] bool failed() const { return error_.has_value(); }
    [[nodiscard]] voile::Error error() const { return voile::Error{error_.value_or("")}; }

    void fail(uint32_t line, const std::string& message);
    // FILE:LINE: PATH REASON
    void fail(const Field& field, const std::string& reason);

    // True if it is an object whose keys are all among `keys`.
    bool object(const Field& field, const std::vector<std::string>& keys);
    // True if it is an array of `length` items, or of any length where that is 0.
    bool array(const Field& field, size_t length = 0);

    // Absent where the object does not have the key.
    [[nodiscard]] static Field child(const Field& object, const char* key);
    [[nodiscard]] static Field item(const Field& array, size_t index);
    // As child(), but a missing key is an error.
    Field required(const Field& object, const char* key);

    // Each leaves `out` as it is where the field is absent.
    void read(const Field& field, bool& out);
    void read(const Field& field, std::string& out); // not empty
    void read(const Field& field, Range range, float& out);
    void read(const Field& field, Range range, std::optional<float>& out);
    void read(const Field& field, Range range, glm::vec2& out);
    void read(const Field& field, Range range, glm::vec3& out);
    void read_integer(const Field& field, uint32_t min, uint32_t max, uint32_t& out);
    // The index of the word; `what` says what it is one of ("an integrator").
    std::optional<size_t> read_word(const Field& field, const char* what, std::initializer_list<const char*> words);
    std::optional<size_t> read_word(const Field& field, const char* what, std::span<const char* const> words);

private:
    bool expect(const Field& field, JsonNode::Kind kind, const char* expected);

    std::string file_;
    std::optional<std::string> error_;
};

} // namespace viewer
