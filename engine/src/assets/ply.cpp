// Reads PLY: the header (ply_header) describes the body, which is read value by value.
#include "voile/engine/assets/ply.hpp"

#include "assets/mesh_builder.hpp"
#include "assets/ply_header.hpp"
#include "voile/engine/assets/file.hpp"
#include "voile/engine/assets/words.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace voile::engine
{

namespace
{

constexpr PlyFormat k_native_format =
    std::endian::native == std::endian::little ? PlyFormat::binary_little_endian : PlyFormat::binary_big_endian;
constexpr std::string_view k_blank_lines = " \t\r\n\v\f";

class BodyReader
{
public:
    BodyReader(const PlyHeader& header, std::string_view body, const std::string& name)
        : header_(header), body_(body), name_(name), line_(header.lines)
    {
    }

    Result<Polygons> run();

private:
    void read_entry(const PlyElement& element);
    void begin_line();
    void end_line();
    void read_corners(const PlyProperty& property);
    uint32_t read_count(PlyType type);
    double read(PlyType type);
    double read_word(PlyType type);
    template <typename T>
    double read_bytes();
    void fail(const std::string& reason);
    void fail_at_end();
    [[nodiscard]] std::string location() const; // "mesh.ply:12: ", without a line in a binary file
    [[nodiscard]] std::string entry() const;    // "vertex 3 of 8"

    const PlyHeader& header_;
    std::string_view body_; // the unread rest
    const std::string& name_;
    Polygons polygons_;
    std::string error_;                   // the first error
    std::vector<std::string_view> words_; // of the current line, if ASCII
    size_t next_word_ = 0;
    uint32_t line_;
    const PlyElement* element_ = nullptr; // the element being read
    uint32_t index_ = 0;                  // within the element
};

std::string BodyReader::location() const
{
    return name_ + (header_.is_ascii() ? ':' + std::to_string(line_) + ": " : ": ");
}

std::string BodyReader::entry() const
{
    return gpu::printable(element_->name) + " " + std::to_string(index_ + 1) + " of " + std::to_string(element_->count);
}

void BodyReader::fail(const std::string& reason)
{
    if (error_.empty())
        error_ = location() + (header_.is_ascii() ? "" : entry() + ": ") + reason;
}

void BodyReader::fail_at_end()
{
    if (error_.empty())
        error_ = location() + "file ends before " + entry() + " is complete";
}

template <typename T>
double BodyReader::read_bytes()
{
    std::array<char, sizeof(T)> bytes{};
    if (body_.size() < bytes.size())
    {
        fail_at_end();
        return 0;
    }
    std::copy_n(body_.begin(), bytes.size(), bytes.begin());
    body_.remove_prefix(bytes.size());
    if (header_.format != k_native_format)
        std::reverse(bytes.begin(), bytes.end());
    return static_cast<double>(std::bit_cast<T>(bytes));
}

double BodyReader::read_word(PlyType type)
{
    if (next_word_ == words_.size())
    {
        fail(gpu::printable(element_->name) + " has too few values");
        return 0;
    }
    const std::string_view word = words_[next_word_++];
    const std::optional<double> value = parse_number(word);
    const bool is_float = type == PlyType::Float32 || type == PlyType::Float64;
    if (!value)
        fail(quoted_word(word) + " is not a number");
    else if (!is_float && (std::abs(*value) > std::numeric_limits<uint32_t>::max() || *value != std::floor(*value)))
        fail(quoted_word(word) + " is not a whole number of 32 bits");
    return error_.empty() ? *value : 0;
}

// Every value of every type fits in a double. Zero after a failure.
double BodyReader::read(PlyType type)
{
    if (header_.is_ascii())
        return read_word(type);
    switch (type)
    {
    case PlyType::Int8:
        return read_bytes<int8_t>();
    case PlyType::Uint8:
        return read_bytes<uint8_t>();
    case PlyType::Int16:
        return read_bytes<int16_t>();
    case PlyType::Uint16:
        return read_bytes<uint16_t>();
    case PlyType::Int32:
        return read_bytes<int32_t>();
    case PlyType::Uint32:
        return read_bytes<uint32_t>();
    case PlyType::Float32:
        return read_bytes<float>();
    case PlyType::Float64:
        return read_bytes<double>();
    }
    return 0;
}

uint32_t BodyReader::read_count(PlyType type)
{
    const double count = read(type);
    if (count < 0)
        fail("list has " + std::to_string(static_cast<int64_t>(count)) + " values");
    return error_.empty() ? static_cast<uint32_t>(count) : 0;
}

void BodyReader::read_corners(const PlyProperty& property)
{
    const uint32_t count = read_count(property.count_type);
    if (count < 3)
        fail("face has " + std::to_string(count) + (count == 1 ? " corner" : " corners") + ", needs 3");
    for (uint32_t i = 0; i < count && error_.empty(); ++i)
    {
        const double index = read(property.type);
        if (index < 0 || index >= header_.vertices)
            fail("face refers to vertex " + std::to_string(static_cast<int64_t>(index)) + ", indices go from 0 to " +
                 std::to_string(header_.vertices - 1));
        else
            polygons_.corners.push_back({static_cast<int32_t>(index)});
    }
    polygons_.face_sizes.push_back(count);
}

void BodyReader::begin_line()
{
    words_.clear();
    next_word_ = 0;
    while (words_.empty() && !body_.empty())
    {
        split(take_line(body_), words_);
        ++line_;
    }
    if (words_.empty())
        fail_at_end();
}

void BodyReader::end_line()
{
    if (next_word_ != words_.size())
        fail(gpu::printable(element_->name) + " has too many values, " + quoted_word(words_[next_word_]) +
             " is left over");
}

// Reads one entry of an element, such as a vertex or face. In ASCII this is one line.
void BodyReader::read_entry(const PlyElement& element)
{
    if (header_.is_ascii())
        begin_line();
    glm::dvec3 position(0.);
    for (const PlyProperty& property : element.properties)
    {
        if (!error_.empty())
            return;
        if (property.role == PlyRole::Corners)
            read_corners(property);
        else if (property.is_list)
            for (uint32_t left = read_count(property.count_type); left > 0 && error_.empty(); --left)
                read(property.type);
        else if (const double value = read(property.type); property.role != PlyRole::Skipped)
        {
            if (!(std::abs(value) <= double{std::numeric_limits<float>::max()}))
                fail("coordinate is not finite");
            position[static_cast<int>(property.role) - static_cast<int>(PlyRole::X)] = value;
        }
    }
    if (element.name == "vertex")
        polygons_.positions.emplace_back(position);
    if (header_.is_ascii())
        end_line();
}

Result<Polygons> BodyReader::run()
{
    for (const PlyElement& element : header_.elements)
    {
        element_ = &element;
        if (element.properties.empty())
            continue;
        for (index_ = 0; index_ < element.count && error_.empty(); ++index_)
            read_entry(element);
    }
    if (!error_.empty())
        return Error{error_};
    const size_t rest = body_.find_first_not_of(k_blank_lines);
    if (rest == std::string_view::npos)
        return std::move(polygons_);
    line_ += 1 + static_cast<uint32_t>(std::count(body_.begin(), body_.begin() + static_cast<ptrdiff_t>(rest), '\n'));
    return Error{location() + "data follows the last " + gpu::printable(header_.elements.back().name)};
}

} // namespace

Result<Mesh> load_ply(const std::filesystem::path& path, MeshReport* report, MeshVertices vertices)
{
    const std::string name = path_text(path);
    const Result<std::string> text = read_file(path);
    if (!text)
        return text.error();
    std::string_view body = text.value();
    const Result<PlyHeader> header = take_ply_header(body, name);
    if (!header)
        return header.error();
    Result<Polygons> polygons = BodyReader(header.value(), body, name).run();
    if (!polygons)
        return polygons.error();
    return build_mesh(std::move(polygons.value()), name, report, vertices);
}

} // namespace voile::engine
