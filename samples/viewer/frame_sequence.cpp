// Reading and blending the meshes of a sequence.
#include "samples/viewer/frame_sequence.hpp"

#include "voile/engine/assets/load_mesh.hpp"
#include "voile/engine/assets/words.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viewer
{
namespace
{

// What a file has other than the first; empty if nothing. Faces are compared as the files have them: how a polygon is
// cut well depends on its form, which changes.
std::string difference(const voile::engine::Mesh& faces, const voile::engine::Mesh& first)
{
    const auto counts = [](size_t here, size_t there, const char* what)
    { return "has " + std::to_string(here) + " " + what + ", but the first has " + std::to_string(there); };
    if (faces.positions.size() != first.positions.size())
        return counts(faces.positions.size(), first.positions.size(), "vertices");
    if (faces.triangles.size() != first.triangles.size())
        return counts(faces.triangles.size(), first.triangles.size(), "triangles");
    const auto [here, there] = std::mismatch(faces.triangles.begin(), faces.triangles.end(), first.triangles.begin());
    if (here == faces.triangles.end())
        return "";
    const auto corners = [](const glm::uvec3& t)
    { return std::to_string(t.x) + " " + std::to_string(t.y) + " " + std::to_string(t.z); };
    return "joins vertices " + corners(*here) + " (counted from 0) where the first joins " + corners(*there);
}

} // namespace

std::string sequence_name(const FrameSequence& entry)
{
    std::string name = entry.pattern.stem().string();
    const size_t number = name.find('%');
    if (number != std::string::npos)
        name.erase(number, name.find('d', number) - number + 1);
    name.resize(name.find_last_not_of("_-. ") + 1); // npos + 1 is 0
    return name.empty() ? "frames" : name;
}

voile::Result<MeshSequence> MeshSequence::load(const FrameSequence& entry, const std::filesystem::path& mesh)
{
    const auto files = frame_files(entry);
    if (!files)
        return files.error();
    MeshSequence sequence;
    sequence.rate_ = static_cast<double>(entry.rate);
    sequence.loop_ = entry.loop;
    sequence.ramp_ = entry.ramp;
    auto first = voile::engine::load_mesh(files.value().front(), nullptr, voile::engine::MeshVertices::positions);
    if (!first)
        return first.error();
    sequence.first_ = std::move(first.value());
    sequence.bounds_ = voile::engine::bounds(sequence.first_);
    voile::engine::Mesh first_faces;
    const auto faces_of = [&](const std::filesystem::path& file) -> voile::Result<voile::engine::Mesh>
    {
        auto faces = voile::engine::load_mesh(file, nullptr, voile::engine::MeshVertices::faces);
        if (!faces)
            return faces;
        if (first_faces.positions.empty())
            first_faces = faces.value();
        const std::string other = difference(faces.value(), first_faces);
        if (!other.empty())
            return voile::Error{voile::engine::path_text(file) + ": " + other + " (" +
                                voile::engine::path_text(files.value().front().filename()) + ")"};
        return faces;
    };
    for (const std::filesystem::path& file : files.value())
    {
        auto faces = faces_of(file);
        if (!faces)
            return faces.error();
        const voile::engine::Bounds box = voile::engine::bounds(faces.value());
        sequence.bounds_.min = glm::min(sequence.bounds_.min, box.min);
        sequence.bounds_.max = glm::max(sequence.bounds_.max, box.max);
        sequence.frames_.push_back(std::move(faces.value().positions));
    }
    if (!mesh.empty())
        if (auto same = faces_of(mesh); !same)
            return same.error();
    return sequence;
}

double MeshSequence::duration() const
{
    if (loop_)
        return std::numeric_limits<double>::infinity();
    const double time = static_cast<double>(frames_.size() - 1) / rate_;
    const auto ramp = static_cast<double>(ramp_); // the inverse of ramped()
    return time < 0.5 * ramp ? std::sqrt(2 * time * ramp) : time + 0.5 * ramp;
}

void MeshSequence::positions_at(double seconds, std::vector<glm::vec3>& positions) const
{
    const size_t count = frames_.size();
    const double elapsed = std::max(ramped(seconds, ramp_), 0.0) * rate_;
    const double frame =
        loop_ ? std::fmod(elapsed, static_cast<double>(count)) : std::min(elapsed, static_cast<double>(count - 1));
    const auto from = static_cast<size_t>(frame);
    const std::vector<glm::vec3>& a = frames_[from];
    const std::vector<glm::vec3>& b = frames_[loop_ ? (from + 1) % count : std::min(from + 1, count - 1)];
    const auto fraction = static_cast<float>(frame - std::floor(frame));
    positions.resize(a.size());
    for (size_t i = 0; i < a.size(); ++i)
        positions[i] = glm::mix(a[i], b[i], fraction);
}

} // namespace viewer
