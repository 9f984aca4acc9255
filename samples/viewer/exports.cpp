#include "samples/viewer/exports.hpp"

#include "samples/viewer/text.hpp"

#include "voile/engine/assets/atomic_file.hpp"
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
static_assert(sizeof(glm::vec3) == 12 && sizeof(glm::vec2) == 8);

constexpr uint32_t k_most_int32 = static_cast<uint32_t>(std::numeric_limits<int32_t>::max());

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

    void vector(std::string_view keyword, const glm::vec2& v)
    {
        text_.clear();
        text_.append(keyword);
        for (const float value : {v.x, v.y})
            number(value);
        flush();
    }

    // OBJ counts from 1.
    void face(const Surface& surface, size_t index)
    {
        const Faces& faces = surface.faces;
        const std::vector<uint32_t>& texture = faces.texture_indices.empty() ? faces.indices : faces.texture_indices;
        const bool textured = !surface.texture_coordinates.empty();
        const bool normals = !surface.normals.empty();
        text_.assign(1, 'f');
        for (size_t i = index * faces.corners; i < (index + 1) * faces.corners; ++i)
        {
            number(faces.indices[i] + 1);
            if (textured || normals)
                text_ += '/';
            if (textured)
                text_ += std::to_string(texture[i] + 1);
            if (normals)
                text_ += '/' + std::to_string(faces.indices[i] + 1);
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

bool has_seams(const Surface& surface)
{
    return !surface.texture_coordinates.empty() && !surface.faces.texture_indices.empty();
}

bool has_vertex_texture(const Surface& surface)
{
    return !surface.texture_coordinates.empty() && surface.faces.texture_indices.empty();
}

std::string ply_header(const Surface& surface)
{
    std::string header = "ply\nformat binary_little_endian 1.0\ncomment meters, y up\nelement vertex " +
                         std::to_string(surface.positions.size()) +
                         "\nproperty float x\nproperty float y\nproperty float z\n";
    if (!surface.normals.empty())
        header += "property float nx\nproperty float ny\nproperty float nz\n";
    if (has_vertex_texture(surface))
        header += "property float s\nproperty float t\n";
    header += "element face " + std::to_string(surface.faces.count()) + "\nproperty list uchar int vertex_indices\n";
    if (has_seams(surface))
        header += "property list uchar float texcoord\n";
    return header + "end_header\n";
}

void put_face(std::string& bytes, const Surface& surface, size_t index)
{
    const Faces& faces = surface.faces;
    const size_t first = index * faces.corners;
    put(bytes, static_cast<uint8_t>(faces.corners));
    for (size_t i = first; i < first + faces.corners; ++i)
        put(bytes, faces.indices[i]);
    if (!has_seams(surface))
        return;
    put(bytes, static_cast<uint8_t>(2 * faces.corners));
    for (size_t i = first; i < first + faces.corners; ++i)
        put(bytes, surface.texture_coordinates[faces.texture_indices[i]]);
}

std::string file_name_part(const std::string& name)
{
    std::string part = name;
    for (char& c : part)
    {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f || std::strchr("/\\:*?\"<>|% ", c) != nullptr)
            c = '_';
    }
    return part;
}

// Empty if all of `indices` are below `count`.
std::string wrong_index(const std::vector<uint32_t>& indices, uint32_t corners, size_t count, const char* of)
{
    const auto found = std::ranges::find_if(indices, [&](uint32_t index) { return index >= count; });
    if (found == indices.end())
        return "";
    return "has face " + std::to_string(static_cast<size_t>(found - indices.begin()) / corners) +
           " with an index beyond its " + std::to_string(count) + " " + of;
}

std::string wrong_faces(const Surface& surface)
{
    const Faces& faces = surface.faces;
    if (!faces.texture_indices.empty() && faces.texture_indices.size() != faces.indices.size())
        return "has texture coordinates for " + std::to_string(faces.texture_indices.size()) + " corners of " +
               std::to_string(faces.indices.size());
    if (has_vertex_texture(surface) && surface.texture_coordinates.size() != surface.positions.size())
        return "has " + std::to_string(surface.texture_coordinates.size()) + " texture coordinates for " +
               std::to_string(surface.positions.size()) + " vertices";
    const std::string positions = wrong_index(faces.indices, faces.corners, surface.positions.size(), "vertices");
    if (!positions.empty() || !has_seams(surface))
        return positions;
    return wrong_index(faces.texture_indices, faces.corners, surface.texture_coordinates.size(), "texture coordinates");
}

} // namespace

std::optional<size_t> first_not_finite(std::span<const glm::vec3> values)
{
    for (size_t i = 0; i < values.size(); ++i)
    {
        if (!std::isfinite(values[i].x) || !std::isfinite(values[i].y) || !std::isfinite(values[i].z))
            return i;
    }
    return std::nullopt;
}

voile::Result<void> check_surface(const fs::path& path, const Surface& surface)
{
    const auto error = [&](const std::string& reason)
    { return voile::Error{voile::engine::path_text(path) + ": " + in_quotes(surface.name) + " " + reason}; };
    const size_t count = surface.positions.size();
    if (count > k_most_int32 || surface.faces.indices.size() > k_most_int32)
        return error("has too many vertices or faces for the format");
    if (!surface.normals.empty() && surface.normals.size() != count)
        return error("has " + std::to_string(surface.normals.size()) + " normals for " + std::to_string(count) +
                     " vertices");
    if (const auto vertex = first_not_finite(surface.positions))
        return error("is not written: the position of vertex " + std::to_string(*vertex) + " is not finite");
    if (const auto vertex = first_not_finite(surface.normals))
        return error("is not written: the normal of vertex " + std::to_string(*vertex) + " is not finite");
    if (const std::string wrong = wrong_faces(surface); !wrong.empty())
        return error(wrong);
    return {};
}

std::vector<fs::path> export_paths(const fs::path& path, const std::vector<std::string>& names)
{
    if (names.size() == 1)
        return {path};
    std::vector<fs::path> result;
    std::set<fs::path> taken;
    std::map<std::string, int> last_numbers; // of stems that are there more than once
    for (const std::string& name : names)
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

voile::Result<void> save_surface_obj(const fs::path& path, const Surface& surface)
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
    for (const glm::vec2& coordinates : surface.texture_coordinates)
        lines.vector("vt", coordinates);
    for (const glm::vec3& normal : surface.normals)
        lines.vector("vn", normal);
    for (size_t i = 0; i < surface.faces.count(); ++i)
        lines.face(surface, i);
    return file.commit();
}

voile::Result<void> save_surface_ply(const fs::path& path, const Surface& surface)
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
        if (has_vertex_texture(surface))
            put(bytes, surface.texture_coordinates[i]);
        file.write(bytes);
    }
    for (size_t i = 0; i < surface.faces.count(); ++i)
    {
        bytes.clear();
        put_face(bytes, surface, i);
        file.write(bytes);
    }
    return file.commit();
}

voile::Result<std::vector<fs::path>> export_surfaces(const fs::path& path, const std::vector<Surface>& surfaces)
{
    const std::string extension = lower_extension(path);
    if (extension != ".obj" && extension != ".ply")
        return voile::Error{voile::engine::path_text(path) + ": does not end in .obj or .ply"};
    std::vector<std::string> names;
    names.reserve(surfaces.size());
    for (const Surface& surface : surfaces)
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

} // namespace viewer
