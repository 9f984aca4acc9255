// Cloths as files: a state as OBJ or PLY, an animation as PC2. Vertices keep their order, coordinates are the scene's
// (meters, y up). Every file appears under its name only when it is complete.
#pragma once

#include "voile/engine/assets/atomic_file.hpp"
#include "voile/result.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace viewer
{

struct ClothSurface
{
    std::string name;
    std::vector<glm::vec3> positions;  // m
    std::vector<glm::vec3> normals;    // one a position, or none at all
    std::vector<glm::uvec3> triangles; // indices into positions, counter-clockwise seen from the normals' side
};

// The file of each cloth: `path` itself for a single one, else FILE_NAME.EXT with characters that do not suit a file
// name replaced, and a number added where two would then be the same.
std::vector<std::filesystem::path> export_paths(const std::filesystem::path& path,
                                                const std::vector<std::string>& cloth_names);

// Text; numbers with as many digits as bring the same float back. Errors: a value that is not finite, an index out of
// range, a wrong number of normals, and whatever the file system says.
voile::Result<void> save_surface_obj(const std::filesystem::path& path, const ClothSurface& surface);

// Binary little endian: float x y z, with normals also float nx ny nz; faces as uchar count and int vertex_indices.
voile::Result<void> save_surface_ply(const std::filesystem::path& path, const ClothSurface& surface);

// All cloths, as OBJ or PLY by the extension of `path`. Returns the files written; none is where a cloth is unsound.
voile::Result<std::vector<std::filesystem::path>> export_surfaces(const std::filesystem::path& path,
                                                                  const std::vector<ClothSurface>& surfaces);

// PC2 point cache (as Blender's Mesh Cache modifier reads it), one sample a call. Little endian: "POINTCACHE2\0", int32
// version 1, int32 points, float start frame, float sample rate (frames between samples), int32 samples; then the
// samples, three floats a point.
class PointCacheWriter
{
public:
    static voile::Result<PointCacheWriter> create(const std::filesystem::path& path, uint32_t point_count,
                                                  float start_frame = 0.f, float sample_rate = 1.f);

    // Errors: another number of points, a value that is not finite, a full disk.
    voile::Result<void> append(std::span<const glm::vec3> positions);

    // Writes the number of samples and gives the file its name. Without it nothing is left behind.
    voile::Result<void> finish();

    [[nodiscard]] uint32_t samples() const { return samples_; }

private:
    PointCacheWriter(voile::engine::AtomicFile file, std::filesystem::path path, uint32_t points)
        : file_(std::move(file)), path_(std::move(path)), points_(points)
    {
    }

    voile::engine::AtomicFile file_;
    std::filesystem::path path_;
    uint32_t points_ = 0;
    uint32_t samples_ = 0;
};

} // namespace viewer
