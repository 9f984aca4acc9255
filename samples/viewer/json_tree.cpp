#include "samples/viewer/json_tree.hpp"

#include "samples/viewer/text.hpp"

#include "voile/gpu/printable.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <unordered_set>

namespace viewer
{
namespace
{

constexpr size_t k_deepest_nesting = 64;
constexpr size_t k_longest_reason = 200; // bytes; the parser quotes the token, which may be a whole file

// "LINE:COLUMN" of a byte, both from 1.
std::string location_text(std::string_view text, size_t offset)
{
    const std::string_view before = text.substr(0, offset);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const size_t newline = before.rfind('\n');
    const size_t column = newline == std::string_view::npos ? offset + 1 : offset - newline;
    return std::to_string(line) + ":" + std::to_string(column);
}

// Feeds the parser and counts how far it has read, which nlohmann::json's callbacks do not report.
class CountingIterator
{
public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    CountingIterator(const char* at, size_t* consumed) : at_(at), consumed_(consumed) {}

    reference operator*() const { return *at_; }
    CountingIterator& operator++()
    {
        ++at_;
        ++*consumed_;
        return *this;
    }
    CountingIterator operator++(int)
    {
        const CountingIterator before = *this;
        ++*this;
        return before;
    }
    bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
    bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

private:
    const char* at_;
    size_t* consumed_;
};

class TreeBuilder : public nlohmann::json_sax<nlohmann::json>
{
public:
    TreeBuilder(std::string_view text, const std::string& file, const size_t* consumed)
        : text_(text), file_(file), consumed_(consumed)
    {
    }

    JsonNode root;
    std::optional<std::string> error;

    bool null() override { return add(make(JsonNode::Kind::null_value)); }
    bool boolean(bool value) override
    {
        JsonNode node = make(JsonNode::Kind::boolean);
        node.boolean = value;
        return add(std::move(node));
    }
    bool number_integer(number_integer_t value) override { return add_number(static_cast<double>(value), true); }
    bool number_unsigned(number_unsigned_t value) override { return add_number(static_cast<double>(value), true); }
    bool number_float(number_float_t value, const string_t&) override { return add_number(value, false); }
    bool string(string_t& value) override
    {
        JsonNode node = make(JsonNode::Kind::string);
        node.text = value;
        return add(std::move(node));
    }
    bool binary(binary_t&) override { return false; } // JSON text has none
    bool start_object(std::size_t) override { return open(JsonNode::Kind::object); }
    bool start_array(std::size_t) override { return open(JsonNode::Kind::array); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }

    bool key(string_t& value) override
    {
        if (!open_keys_.back().insert(value).second)
            return fail("key " + in_quotes(value) + " appears twice in " + path());
        open_.back().keys.push_back(value);
        return true;
    }

    bool parse_error(std::size_t position, const std::string& token,
                     const nlohmann::detail::exception& problem) override
    {
        constexpr int k_number_overflow = 406;
        if (problem.id == k_number_overflow)
            return fail("number " + voile::gpu::printable(token) + " is beyond the largest that can be held");
        // "[json.exception.parse_error.101] parse error at line 3, column 5: REASON": fail() adds the position.
        std::string reason = problem.what();
        if (const size_t at = reason.find(": "); at != std::string::npos)
            reason = reason.substr(at + 2);
        const size_t offset = std::min(position > 0 ? position - 1 : 0, text_.size());
        error = file_ + ":" + location_text(text_, offset) + ": " + voile::gpu::printable(reason, k_longest_reason);
        return false;
    }

private:
    // The parser has read up to the end of the token, and of a number one character more, which may be the line's end.
    // Tokens hold no line ends themselves, so the lines before the last character read are the lines before the token.
    uint32_t line()
    {
        const size_t end = *consumed_ > 0 ? *consumed_ - 1 : 0;
        for (; counted_ < end; ++counted_)
            line_ += text_[counted_] == '\n' ? 1u : 0u;
        return line_;
    }

    JsonNode make(JsonNode::Kind kind)
    {
        JsonNode node;
        node.kind = kind;
        node.line = line();
        return node;
    }

    bool add(JsonNode node)
    {
        if (open_.empty())
            root = std::move(node);
        else
            open_.back().items.push_back(std::move(node));
        return true;
    }

    bool add_number(double value, bool integer)
    {
        JsonNode node = make(JsonNode::Kind::number);
        node.number = value;
        node.integer = integer;
        return add(std::move(node));
    }

    bool open(JsonNode::Kind kind)
    {
        // Deeper trees would only serve to exhaust the stack when they are destroyed.
        if (open_.size() == k_deepest_nesting)
            return fail("more than 64 levels of nesting");
        open_.push_back(make(kind));
        open_keys_.emplace_back();
        return true;
    }

    bool close()
    {
        JsonNode node = std::move(open_.back());
        open_.pop_back();
        open_keys_.pop_back();
        return add(std::move(node));
    }

    [[nodiscard]] std::string path() const
    {
        std::string result;
        for (size_t i = 0; i + 1 < open_.size(); ++i)
        {
            if (open_[i].kind == JsonNode::Kind::array)
                result += '[' + std::to_string(open_[i].items.size()) + ']';
            else
                result += (result.empty() ? "" : ".") + open_[i].keys.back();
        }
        return result.empty() ? "the scene" : voile::gpu::printable(result);
    }

    bool fail(const std::string& reason)
    {
        error = file_ + ":" + std::to_string(line()) + ": " + reason;
        return false;
    }

    std::string_view text_;
    const std::string& file_;
    const size_t* consumed_;
    size_t counted_ = 0;
    uint32_t line_ = 1;
    std::vector<JsonNode> open_;                             // the containers that are not closed yet, outermost first
    std::vector<std::unordered_set<std::string>> open_keys_; // theirs, to find repetitions
};

} // namespace

const JsonNode* JsonNode::find(std::string_view key) const
{
    const auto found = std::find(keys.begin(), keys.end(), key);
    return found == keys.end() ? nullptr : &items[static_cast<size_t>(found - keys.begin())];
}

const char* describe(JsonNode::Kind kind)
{
    switch (kind)
    {
    case JsonNode::Kind::null_value:
        return "null";
    case JsonNode::Kind::boolean:
        return "true or false";
    case JsonNode::Kind::number:
        return "a number";
    case JsonNode::Kind::string:
        return "a string";
    case JsonNode::Kind::array:
        return "an array";
    case JsonNode::Kind::object:
        return "an object";
    }
    return "unknown";
}

voile::Result<JsonNode> parse_json(std::string_view text, const std::string& file)
{
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
        return voile::Error{file + ": the file is empty"};
    // The parser would take it for the end of the text.
    if (const size_t zero = text.find('\0'); zero != std::string_view::npos)
        return voile::Error{file + ":" + location_text(text, zero) + ": byte " + std::to_string(zero) + " is zero"};
    size_t consumed = 0;
    TreeBuilder builder(text, file, &consumed);
    const CountingIterator begin(text.data(), &consumed);
    const CountingIterator end(text.data() + text.size(), &consumed);
    if (!nlohmann::json::sax_parse(begin, end, &builder))
        return voile::Error{builder.error.value_or(file + ": not valid JSON")};
    return std::move(builder.root);
}

} // namespace viewer
