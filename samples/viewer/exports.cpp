#include "samples/viewer/exports.hpp"

#include "samples/viewer/text.hpp"

#include "voile/engine/assets/words.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace viewer
{
namespace
{

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "the binary formats are written as the memory has them");
static_assert(sizeof(glm::vec3) == 12 && sizeof(glm::uvec3) == 12);

constexpr long k_sample_count_offset = 28; // of PC2's header of 32 bytes
constexpr uint32_t k_most_int32 = static_cast<uint32_t>(std::numeric_limits<int32_t>::max());

// The first vertex with a coordinate that is not finite: such a file would break whoever reads it.
std::optional<size_t> first_not_finite(std::span<const glm::vec3> values)
{
    for (size_t i = 0; i < values.size(); ++i)
    {
        if (!std::isfinite(values[i].x) || !std::isfinite(values[i].y) || !std::isfinite(values[i].z))
            return i;
    }
    return std::nullopt;
}

voile::Result<void> check_surface(const fs::path& path, const ClothSurface& surface)
{
    const auto error = [&](const std::string& reason)
    { return voile::Error{voile::engine::path_text(path) + ": cloth " + in_quotes(surface.name) + " " + reason}; };
    const size_t count = surface.positions.size();
    if (count > k_most_int32 || surface.triangles.size() > k_most_int32)
        return error("has too many vertices or triangles for the format");
    if (!surface.normals.empty() && surface.normals.size() != count)
        return error("has " + std::to_string(surface.normals.size()) + " normals for " + std::to_string(count) +
                     " vertices");
    if (const auto vertex = first_not_finite(surface.positions))
        return error("is not written: the position of vertex " + std::to_string(*vertex) + " is not finite");
    if (const auto vertex = first_not_finite(surface.normals))
        return error("is not written: the normal of vertex " + std::to_string(*vertex) + " is not finite");
    for (size_t i = 0; i < surface.triangles.size(); ++i)
    {
        const glm::uvec3& t = surface.triangles[i];
        if (std::max({t.x, t.y, t.z}) >= count)
            return error("has triangle " + std::to_string(i) + " with an index beyond its " + std::to_string(count) +
                         " vertices");
    }
    return {};
}

class LineWriter
{
public:
    explicit LineWriter(voile::engine::AtomicFile& file) : file_(file) {}

    void vector(std::string_view keyword, const glm::vec3& v)
    {
        text_.clear();
        text_.append(keyword);
        for (const float value : {v.x, v.y, v.z})
            number(value);
        flush();
    }

    // OBJ counts from 1.
    void face(const glm::uvec3& triangle, bool with_normals)
    {
        text_.assign(1, 'f');
        for (const uint32_t index : {triangle.x, triangle.y, triangle.z})
        {
            number(index + 1);
            if (with_normals)
                text_ += "//" + std::to_string(index + 1);
        }
        flush();
    }

private:
    template <typename T>
    void number(T value)
    {
        std::array<char, 32> digits{};
        const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
        text_ += ' ';
        text_.append(digits.data(), result.ptr);
    }

    void flush()
    {
        text_ += '\n';
        file_.write(text_);
    }

    voile::engine::AtomicFile& file_;
    std::string text_;
};

template <typename T>
void put(std::string& bytes, const T& value)
{
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

std::string ply_header(const ClothSurface& surface)
{
    std::string header = "ply\nformat binary_little_endian 1.0\ncomment meters, y up\nelement vertex " +
                         std::to_string(surface.positions.size()) +
                         "\nproperty float x\nproperty float y\nproperty float z\n";
    if (!surface.normals.empty())
        header += "property float nx\nproperty float ny\nproperty float nz\n";
    return header + "element face " + std::to_string(surface.triangles.size()) +
           "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string file_name_part(const std::string& name)
{
    std::string part = name;
    for (char& c : part)
    {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f || std::strchr("/\\:*?\"<>| ", c) != nullptr)
            c = '_';
    }
    return part;
}

} // namespace

std::vector<fs::path> export_paths(const fs::path& path, const std::vector<std::string>& cloth_names)
{
    if (cloth_names.size() == 1)
        return {path};
    std::vector<fs::path> result;
    std::set<fs::path> taken;
    std::map<std::string, int> last_numbers; // of stems that are there more than once
    for (const std::string& name : cloth_names)
    {
        const std::string stem = path.stem().string() + "_" + file_name_part(name);
        fs::path candidate = path.parent_path() / (stem + path.extension().string());
        int& number = last_numbers.try_emplace(stem, 1).first->second;
        while (!taken.insert(candidate).second)
            candidate = path.parent_path() / (stem + "_" + std::to_string(++number) + path.extension().string());
        result.push_back(candidate);
    }
    return result;
}

voile::Result<void> save_surface_obj(const fs::path& path, const ClothSurface& surface)
{
    if (auto sound = check_surface(path, surface); !sound)
        return sound;
    voile::Result<voile::engine::AtomicFile> created = voile::engine::AtomicFile::create(path);
    if (!created)
        return created.error();
    voile::engine::AtomicFile& file = created.value();
    LineWriter lines(file);
    file.write("# meters, y up\no " + voile::gpu::printable(surface.name) + "\n");
    for (const glm::vec3& position : surface.positions)
        lines.vector("v", position);
    for (const glm::vec3& normal : surface.normals)
        lines.vector("vn", normal);
    for (const glm::uvec3& triangle : surface.triangles)
        lines.face(triangle, !surface.normals.empty());
    return file.commit();
}

voile::Result<void> save_surface_ply(const fs::path& path, const ClothSurface& surface)
{
    if (auto sound = check_surface(path, surface); !sound)
        return sound;
    voile::Result<voile::engine::AtomicFile> created = voile::engine::AtomicFile::create(path);
    if (!created)
        return created.error();
    voile::engine::AtomicFile& file = created.value();
    file.write(ply_header(surface));
    std::string bytes;
    for (size_t i = 0; i < surface.positions.size(); ++i)
    {
        bytes.clear();
        put(bytes, surface.positions[i]);
        if (!surface.normals.empty())
            put(bytes, surface.normals[i]);
        file.write(bytes);
    }
    for (const glm::uvec3& triangle : surface.triangles)
    {
        bytes.assign(1, '\3');
        put(bytes, triangle);
        file.write(bytes);
    }
    return file.commit();
}

voile::Result<std::vector<fs::path>> export_surfaces(const fs::path& path, const std::vector<ClothSurface>& surfaces)
{
    const std::string extension = lower_extension(path);
    if (extension != ".obj" && extension != ".ply")
        return voile::Error{voile::engine::path_text(path) + ": does not end in .obj or .ply"};
    std::vector<std::string> names;
    names.reserve(surfaces.size());
    for (const ClothSurface& surface : surfaces)
        names.push_back(surface.name);
    std::vector<fs::path> paths = export_paths(path, names);
    // All are checked before the first is written, so that bad data leaves no part of an export.
    for (size_t i = 0; i < surfaces.size(); ++i)
    {
        if (const voile::Result<void> sound = check_surface(paths[i], surfaces[i]); !sound)
            return sound.error();
    }
    for (size_t i = 0; i < surfaces.size(); ++i)
    {
        const voile::Result<void> saved =
            extension == ".obj" ? save_surface_obj(paths[i], surfaces[i]) : save_surface_ply(paths[i], surfaces[i]);
        if (!saved)
            return saved.error();
    }
    return paths;
}

voile::Result<PointCacheWriter> PointCacheWriter::create(const fs::path& path, uint32_t point_count, float start_frame,
                                                         float sample_rate)
{
    if (point_count > k_most_int32)
        return voile::Error{voile::engine::path_text(path) + ": too many points for the format"};
    voile::Result<voile::engine::AtomicFile> file = voile::engine::AtomicFile::create(path);
    if (!file)
        return file.error();
    std::string header("POINTCACHE2\0", 12);
    put(header, int32_t{1});
    put(header, static_cast<int32_t>(point_count));
    put(header, start_frame);
    put(header, sample_rate);
    put(header, int32_t{0}); // samples: known at the end
    file.value().write(header);
    return PointCacheWriter(std::move(file.value()), path, point_count);
}

voile::Result<void> PointCacheWriter::append(std::span<const glm::vec3> positions)
{
    const auto error = [&](const std::string& reason)
    { return voile::Error{voile::engine::path_text(path_) + ": sample " + std::to_string(samples_) + " " + reason}; };
    if (positions.size() != points_)
        return error("has " + std::to_string(positions.size()) + " points instead of " + std::to_string(points_));
    if (const auto vertex = first_not_finite(positions))
        return error("is not written: the position of vertex " + std::to_string(*vertex) + " is not finite");
    if (samples_ == k_most_int32)
        return error("is one too many for the format");
    file_.write(positions.data(), positions.size_bytes());
    if (!file_.good())
        return file_.commit(); // it failed: this says why and removes the file
    ++samples_;
    return {};
}

voile::Result<void> PointCacheWriter::finish()
{
    const auto count = static_cast<int32_t>(samples_);
    file_.seek(k_sample_count_offset);
    file_.write(&count, sizeof count);
    return file_.commit();
}

} // namespace viewer
