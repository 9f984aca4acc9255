// UsdWriter: an animation as USD text (.usda): one Mesh prim per surface, y up, in meters, one time code per frame.
#pragma once

#include "samples/viewer/surface.hpp"

#include "voile/engine/assets/atomic_file.hpp"
#include "voile/result.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace viewer
{

enum class SurfaceMotion
{
    still,
    rigid,    // samples of xformOp:transform
    deforming // samples of points, normals and extent
};

struct UsdMesh
{
    Surface surface; // at time code 0
    SurfaceMotion motion = SurfaceMotion::still;
    bool two_sided = false;
};

struct UsdSettings
{
    std::string name = "scene"; // of the prim that holds the meshes
    double rate = 60;           // time codes per second
};

// Samples of points wait in temporary files beside the file: the text holds all samples of a mesh one after the other.
class UsdWriter
{
public:
    // Errors: a surface that is not sound, a file that cannot be written. The meshes are at time code 0 already.
    static voile::Result<UsdWriter> create(const std::filesystem::path& path, const UsdSettings& settings,
                                           std::vector<UsdMesh> meshes);

    // The next time code of a mesh that deforms. Errors: those of a point cache.
    voile::Result<void> append(size_t mesh, std::span<const glm::vec3> positions);
    // The next time code of a mesh that moves rigidly.
    void append(size_t mesh, const glm::mat4& pose);

    // Writes the text and gives the file its name. Without it nothing is left behind.
    voile::Result<void> finish();

private:
    // The samples of a mesh.
    struct Samples
    {
        std::unique_ptr<voile::engine::TemporaryFile> name;
        std::unique_ptr<std::FILE, int (*)(std::FILE*)> points{nullptr, nullptr};
        std::vector<glm::mat4> poses;
        uint32_t count = 0;
    };
    UsdWriter(voile::engine::AtomicFile file, std::filesystem::path path)
        : file_(std::move(file)), path_(std::move(path))
    {
    }
    voile::Result<void> open_samples(Samples& samples);
    voile::Result<void> write_mesh(const UsdMesh& mesh, const std::string& name, Samples& samples);
    voile::Result<void> write_point_samples(const UsdMesh& mesh, Samples& samples);
    voile::Error sample_error(const std::string& reason) const;

    voile::engine::AtomicFile file_;
    std::filesystem::path path_;
    UsdSettings settings_;
    std::vector<UsdMesh> meshes_;
    std::vector<Samples> samples_; // one per mesh
};

// A name that USD takes for a prim: letters, digits and underscores, not taken yet.
std::string prim_name(const std::string& name, std::vector<std::string>& taken);

} // namespace viewer
