// Validates an OBJ file in one pass over its lines. Format: Wavefront, "Object Files (.obj)", Advanced Visualizer
// manual, appendix B1.
#include "assets/obj_check.hpp"

#include "voile/engine/assets/words.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

namespace voile::engine
{

namespace
{

// The lists that a face's corner refers to, in the order of its indices.
enum List : size_t
{
    positions,
    texture_coordinates,
    normals
};
// Cloth takes no larger ones. A picture is not repeated a million times.
constexpr double k_most_texture_coordinate = 1e6; // either way

constexpr std::array<std::string_view, 3> k_list_names = {"position", "texture coordinate", "normal"};

class Checker
{
public:
    explicit Checker(const std::string& name) : name_(name) {}

    Result<CheckedObj> run(std::string_view text);

private:
    // A reference to an element that no line has defined yet. It is checked at the end.
    struct Forward
    {
        List list;
        int64_t index;
        uint32_t line;
    };

    void read_statement(std::string_view& text);
    void check_statement();
    void check_vertex();
    void check_vector(List list, size_t least, size_t most, size_t kept);
    bool check_numbers(List list);
    void check_face();
    void check_corner(std::string_view corner);
    void check_index(List list, std::string_view digits, std::string_view corner);
    void check_forward_references();
    void fail(const std::string& reason) { fail_at(line_, reason); }
    void fail_at(uint32_t line, const std::string& reason);

    const std::string& name_;
    CheckedObj checked_;
    std::string error_;                   // the first error
    std::vector<std::string_view> words_; // of the current statement
    uint32_t line_ = 0;                   // on which the current statement begins, from 1
    uint32_t lines_read_ = 0;             // including continuation lines
    std::array<int64_t, 3> counts_{};     // of each list so far
    std::vector<Forward> forward_;
};

void Checker::fail_at(uint32_t line, const std::string& reason)
{
    if (error_.empty())
        error_ = name_ + ":" + std::to_string(line) + ": " + reason;
}

// Takes one statement off the text: a line, and the next as long as a backslash ends it. Comments are cut first, so
// that a path like C:\models\ at the end of a comment continues nothing.
void Checker::read_statement(std::string_view& text)
{
    words_.clear();
    line_ = lines_read_ + 1;
    bool continued = true;
    while (continued && !text.empty())
    {
        std::string_view line = take_line(text);
        ++lines_read_;
        line = line.substr(0, line.find('#'));
        line = line.substr(0, line.find_last_not_of(k_blank) + 1);
        continued = line.ends_with('\\');
        if (continued)
            line.remove_suffix(1);
        split(line, words_);
    }
}

bool Checker::check_numbers(List list)
{
    for (size_t i = 1; i < words_.size(); ++i)
    {
        const std::optional<double> value = parse_number(words_[i]);
        if (!value)
            fail(quoted_word(words_[i]) + " is not a number");
        else if (!std::isfinite(*value))
            fail("coordinate is not finite");
        else if (list == texture_coordinates && std::abs(*value) > k_most_texture_coordinate)
            fail("texture coordinate is " + quoted_word(words_[i]) + ", must be within 1e6");
    }
    return error_.empty();
}

// Checks a statement of `least` to `most` numbers and keeps the first `kept`.
void Checker::check_vector(List list, size_t least, size_t most, size_t kept)
{
    const size_t count = words_.size() - 1;
    const std::string what = list == positions ? "vertex" : std::string(k_list_names[list]);
    if (count < least || count > most)
        fail(what + " has " + std::to_string(count) + (count == 1 ? " coordinate" : " coordinates") + ", needs " +
             std::to_string(least) + (list == texture_coordinates ? " to " + std::to_string(most) : ""));
    if (!error_.empty() || !check_numbers(list))
        return;
    ++counts_[list];
    for (size_t i = 0; i <= std::min(kept, count); ++i)
        checked_.text.append(words_[i]).push_back(' ');
    checked_.text.push_back('\n');
}

// x y z, then optionally a weight (used only by free-form curves), a color, or both.
void Checker::check_vertex()
{
    if (words_.size() == 6)
        fail("vertex has 5 numbers, needs 3, 4 with a weight or 6 with a color");
    check_vector(positions, 3, 7, 3);
}

void Checker::check_index(List list, std::string_view digits, std::string_view corner)
{
    int64_t index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (error != std::errc{} || end != digits.data() + digits.size())
        return fail("face corner " + quoted_word(corner) + " is not position[/texture coordinate][/normal]");
    const std::string refers = "face refers to " + std::string(k_list_names[list]) + " " + std::to_string(index);
    if (index == 0)
        return fail(refers + ", indices start at 1");
    if (index < -counts_[list])
        return fail(refers + " after only " + std::to_string(counts_[list]));
    if (index > counts_[list])
        forward_.push_back({list, index, line_});
    checked_.text += std::to_string(index < 0 ? counts_[list] + 1 + index : index);
}

// p, p/t, p//n or p/t/n
void Checker::check_corner(std::string_view corner)
{
    std::string_view rest = corner;
    for (const List list : {positions, texture_coordinates, normals})
    {
        const size_t slash = std::min(rest.find('/'), rest.size());
        const bool left_out = list == texture_coordinates && slash == 0 && rest.size() > 1;
        if (!left_out)
            check_index(list, rest.substr(0, slash), corner);
        if (slash == rest.size())
        {
            checked_.text.push_back(' ');
            return;
        }
        checked_.text.push_back('/');
        rest.remove_prefix(slash + 1);
    }
    fail("face corner " + quoted_word(corner) + " is not position[/texture coordinate][/normal]");
}

void Checker::check_face()
{
    const size_t corners = words_.size() - 1;
    if (corners < 3)
        return fail("face has " + std::to_string(corners) + (corners == 1 ? " corner" : " corners") + ", needs 3");
    checked_.text += "f ";
    for (size_t i = 1; i < words_.size() && error_.empty(); ++i)
        check_corner(words_[i]);
    checked_.text.push_back('\n');
    checked_.face_sizes.push_back(static_cast<uint32_t>(corners));
}

// Skips names, groups, materials, lines and curves, whatever they contain.
void Checker::check_statement()
{
    if (words_.empty())
        return;
    if (words_[0] == "v")
        check_vertex();
    else if (words_[0] == "vt")
        check_vector(texture_coordinates, 1, 3, 2);
    else if (words_[0] == "vn")
        check_vector(normals, 3, 3, 3);
    else if (words_[0] == "f")
        check_face();
}

void Checker::check_forward_references()
{
    for (const Forward& reference : forward_)
        if (reference.index > counts_[reference.list])
            fail_at(reference.line, "face refers to " + std::string(k_list_names[reference.list]) + " " +
                                        std::to_string(reference.index) + " of " +
                                        std::to_string(counts_[reference.list]));
}

Result<CheckedObj> Checker::run(std::string_view text)
{
    if (constexpr std::string_view k_byte_order_mark = "\xEF\xBB\xBF"; text.starts_with(k_byte_order_mark))
        text.remove_prefix(k_byte_order_mark.size());
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
        return Error{name_ + ": file is empty"};
    if (const size_t zero = text.find('\0'); zero != std::string_view::npos)
        return Error{name_ + ": not a text file, byte " + std::to_string(zero) + " is zero"};
    while (!text.empty() && error_.empty())
    {
        read_statement(text);
        check_statement();
    }
    check_forward_references();
    if (!error_.empty())
        return Error{error_};
    if (counts_[positions] == 0)
        return Error{name_ + ": no vertices"};
    if (checked_.face_sizes.empty())
        return Error{name_ + ": no faces"};
    return std::move(checked_);
}

} // namespace

Result<CheckedObj> check_obj(std::string_view text, const std::string& name)
{
    return Checker(name).run(text);
}

} // namespace voile::engine
