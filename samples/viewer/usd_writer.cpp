// UsdWriter: the text, attribute by attribute.
#include "samples/viewer/usd_writer.hpp"

#include "samples/viewer/exports.hpp"
#include "samples/viewer/text.hpp"

#include "voile/engine/assets/words.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <utility>

namespace viewer
{
namespace
{

namespace fs = std::filesystem;

struct Extent
{
    glm::vec3 min{0.f};
    glm::vec3 max{0.f};
};

Extent extent_of(std::span<const glm::vec3> positions)
{
    if (positions.empty())
        return {};
    Extent extent{positions.front(), positions.front()};
    for (const glm::vec3& p : positions)
    {
        extent.min = glm::min(extent.min, p);
        extent.max = glm::max(extent.max, p);
    }
    return extent;
}

// Text that reaches the file in large pieces.
class UsdText
{
public:
    explicit UsdText(voile::engine::AtomicFile& file) : file_(file) {}
    ~UsdText() { flush(); }
    UsdText(const UsdText&) = delete;
    UsdText& operator=(const UsdText&) = delete;

    UsdText& operator<<(std::string_view text)
    {
        text_ += text;
        constexpr size_t k_piece = size_t{1} << 20;
        if (text_.size() >= k_piece)
            flush();
        return *this;
    }
    template <typename Number>
    requires std::is_arithmetic_v<Number> UsdText& operator<<(Number value)
    {
        std::array<char, 32> digits{}; // the shortest text that reads back as the same number
        const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
        return *this << std::string_view(digits.data(), end);
    }
    UsdText& operator<<(const glm::vec2& v) { return *this << "(" << v.x << ", " << v.y << ")"; }
    UsdText& operator<<(const glm::vec3& v) { return *this << "(" << v.x << ", " << v.y << ", " << v.z << ")"; }
    UsdText& operator<<(const Extent& extent) { return *this << "[" << extent.min << ", " << extent.max << "]"; }
    template <typename T>
    UsdText& operator<<(std::span<const T> values)
    {
        *this << "[";
        for (size_t i = 0; i < values.size(); ++i)
            *this << (i == 0 ? "" : ", ") << values[i];
        return *this << "]";
    }
    template <typename T>
    UsdText& operator<<(const std::vector<T>& values)
    {
        return *this << std::span<const T>(values);
    }
    // Vectors are rows in USD.
    UsdText& operator<<(const glm::mat4& m)
    {
        *this << "( ";
        for (int column = 0; column < 4; ++column)
            *this << (column == 0 ? "(" : ", (") << m[column].x << ", " << m[column].y << ", " << m[column].z << ", "
                  << m[column].w << ")";
        return *this << " )";
    }

private:
    void flush()
    {
        file_.write(text_);
        text_.clear();
    }

    voile::engine::AtomicFile& file_;
    std::string text_;
};

std::string quoted(const std::string& text)
{
    std::string result = "\"";
    for (const char c : voile::gpu::printable(text))
        result += (c == '"' || c == '\\' ? "\\" : "") + std::string(1, c);
    return result + '"';
}

void write_head(UsdText& text, const UsdSettings& settings, uint32_t last)
{
    text << "#usda 1.0\n(\n    defaultPrim = \"" << settings.name
         << "\"\n    startTimeCode = 0\n    endTimeCode = " << last << "\n    timeCodesPerSecond = " << settings.rate
         << "\n    framesPerSecond = " << settings.rate
         << "\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\ndef Xform \"" << settings.name << "\"\n{\n";
}

void write_topology(UsdText& text, const UsdMesh& mesh)
{
    const Surface& surface = mesh.surface;
    const Faces& faces = surface.faces;
    text << "        uniform token subdivisionScheme = \"none\"\n        uniform token orientation = \"rightHanded\"\n"
         << "        uniform bool doubleSided = " << (mesh.two_sided ? "1" : "0")
         << "\n        int[] faceVertexCounts = " << std::vector<uint32_t>(faces.count(), faces.corners)
         << "\n        int[] faceVertexIndices = " << faces.indices << "\n";
    if (surface.texture_coordinates.empty())
        return;
    const bool seams = !faces.texture_indices.empty();
    text << "        texCoord2f[] primvars:st = " << surface.texture_coordinates << " (\n            interpolation = \""
         << (seams ? "faceVarying" : "vertex") << "\"\n        )\n";
    if (seams)
        text << "        int[] primvars:st:indices = " << faces.texture_indices << "\n";
}

void write_still(UsdText& text, const Surface& surface)
{
    text << "        point3f[] points = " << surface.positions
         << "\n        float3[] extent = " << extent_of(surface.positions) << "\n";
    if (!surface.normals.empty())
        text << "        normal3f[] normals = " << surface.normals
             << " (\n            interpolation = \"vertex\"\n        )\n";
}

void write_poses(UsdText& text, const std::vector<glm::mat4>& poses)
{
    text << "        matrix4d xformOp:transform.timeSamples = {\n";
    for (size_t i = 0; i < poses.size(); ++i)
        text << "            " << i << ": " << poses[i] << ",\n";
    text << "        }\n        uniform token[] xformOpOrder = [\"xformOp:transform\"]\n";
}

} // namespace

std::string prim_name(const std::string& name, std::vector<std::string>& taken)
{
    std::string base = name;
    for (char& c : base)
        if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9')))
            c = '_';
    if (base.empty() || (base[0] >= '0' && base[0] <= '9'))
        base.insert(0, 1, '_');
    std::string result = base;
    for (int number = 2; std::ranges::find(taken, result) != taken.end(); ++number)
        result = base + "_" + std::to_string(number);
    taken.push_back(result);
    return result;
}

voile::Error UsdWriter::sample_error(const std::string& reason) const
{
    return voile::Error{voile::engine::path_text(path_) + ": cannot be written: " + reason};
}

voile::Result<UsdWriter> UsdWriter::create(const fs::path& path, const UsdSettings& settings,
                                           std::vector<UsdMesh> meshes)
{
    for (const UsdMesh& mesh : meshes)
        if (const auto sound = check_surface(path, mesh.surface); !sound)
            return sound.error();
    voile::Result<voile::engine::AtomicFile> file = voile::engine::AtomicFile::create(path);
    if (!file)
        return file.error();
    UsdWriter writer(std::move(file.value()), path);
    writer.settings_ = settings;
    std::vector<std::string> taken;
    writer.settings_.name = prim_name(settings.name, taken);
    writer.meshes_ = std::move(meshes);
    writer.samples_.resize(writer.meshes_.size());
    for (size_t i = 0; i < writer.meshes_.size(); ++i)
    {
        const UsdMesh& mesh = writer.meshes_[i];
        if (mesh.motion == SurfaceMotion::rigid)
            writer.append(i, glm::mat4(1));
        if (mesh.motion != SurfaceMotion::deforming)
            continue;
        if (auto opened = writer.open_samples(writer.samples_[i]); !opened)
            return opened.error();
        if (auto appended = writer.append(i, mesh.surface.positions); !appended)
            return appended.error();
    }
    return writer;
}

voile::Result<void> UsdWriter::open_samples(Samples& samples)
{
    const auto target = voile::engine::resolve_target(path_);
    if (!target)
        return target.error();
    samples.name = std::make_unique<voile::engine::TemporaryFile>(target.value());
    samples.points = {std::fopen(samples.name->path().c_str(), "w+bxe"), &std::fclose};
    return samples.points ? voile::Result<void>() : sample_error(std::strerror(errno));
}

voile::Result<void> UsdWriter::append(size_t mesh, std::span<const glm::vec3> positions)
{
    Samples& samples = samples_[mesh];
    const auto error = [&](const std::string& reason)
    {
        return voile::Error{voile::engine::path_text(path_) + ": sample " + std::to_string(samples.count) + " of " +
                            in_quotes(meshes_[mesh].surface.name) + " " + reason};
    };
    const size_t points = meshes_[mesh].surface.positions.size();
    if (positions.size() != points)
        return error("has " + std::to_string(positions.size()) + " points instead of " + std::to_string(points));
    if (const auto vertex = first_not_finite(positions))
        return error("is not written: the position of vertex " + std::to_string(*vertex) + " is not finite");
    errno = 0;
    if (std::fwrite(positions.data(), sizeof(glm::vec3), points, samples.points.get()) != points)
        return sample_error(std::strerror(errno != 0 ? errno : EIO));
    ++samples.count;
    return {};
}

void UsdWriter::append(size_t mesh, const glm::mat4& pose)
{
    samples_[mesh].poses.push_back(pose);
    ++samples_[mesh].count;
}

// Two passes over the samples: points with their extents, then normals.
voile::Result<void> UsdWriter::write_point_samples(const UsdMesh& mesh, Samples& samples)
{
    UsdText text(file_);
    std::vector<glm::vec3> positions(mesh.surface.positions.size());
    std::vector<Extent> extents;
    const auto for_each_sample = [&](const char* attribute, const auto& write) -> voile::Result<void>
    {
        text << "        " << attribute << ".timeSamples = {\n";
        if (std::fflush(samples.points.get()) != 0 || std::fseek(samples.points.get(), 0, SEEK_SET) != 0)
            return sample_error(std::strerror(errno));
        for (uint32_t i = 0; i < samples.count; ++i)
        {
            if (std::fread(positions.data(), sizeof(glm::vec3), positions.size(), samples.points.get()) !=
                positions.size())
                return sample_error("a temporary file is too short");
            text << "            " << i << ": ";
            write();
            text << ",\n";
        }
        text << "        }\n";
        return {};
    };
    const auto points = for_each_sample("point3f[] points",
                                        [&]
                                        {
                                            extents.push_back(extent_of(positions));
                                            text << positions;
                                        });
    if (!points)
        return points;
    text << "        float3[] extent.timeSamples = {\n";
    for (size_t i = 0; i < extents.size(); ++i)
        text << "            " << i << ": " << extents[i] << ",\n";
    text << "        }\n        normal3f[] normals (\n            interpolation = \"vertex\"\n        )\n";
    return for_each_sample("normal3f[] normals", [&] { text << surface_normals(positions, mesh.surface.faces); });
}

voile::Result<void> UsdWriter::write_mesh(const UsdMesh& mesh, const std::string& name, Samples& samples)
{
    {
        UsdText text(file_);
        text << "    def Mesh \"" << name << "\"";
        if (name != mesh.surface.name)
            text << " (\n        customData = {\n            string name = " << quoted(mesh.surface.name)
                 << "\n        }\n    )";
        text << "\n    {\n";
        write_topology(text, mesh);
        if (mesh.motion != SurfaceMotion::deforming)
            write_still(text, mesh.surface);
        if (mesh.motion == SurfaceMotion::rigid)
            write_poses(text, samples.poses);
    }
    if (mesh.motion == SurfaceMotion::deforming)
        if (auto written = write_point_samples(mesh, samples); !written)
            return written;
    file_.write("    }\n");
    return {};
}

voile::Result<void> UsdWriter::finish()
{
    uint32_t count = 1;
    for (const Samples& samples : samples_)
        count = std::max(count, samples.count);
    {
        UsdText text(file_);
        write_head(text, settings_, count - 1);
    }
    std::vector<std::string> taken;
    for (size_t i = 0; i < meshes_.size(); ++i)
        if (auto written = write_mesh(meshes_[i], prim_name(meshes_[i].surface.name, taken), samples_[i]); !written)
            return written;
    file_.write("}\n");
    return file_.commit();
}

} // namespace viewer
