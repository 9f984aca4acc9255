// Animations as PC2 point caches, each with a JSON file beside it for what the format does not hold.
#pragma once

#include "voile/engine/assets/atomic_file.hpp"
#include "voile/result.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <span>

namespace viewer
{

struct PointCacheSettings
{
    uint32_t points = 0;
    double rate = 60;        // samples per second
    float start_frame = 0;   // of the first sample
    float sample_rate = 1.f; // frames between samples
};

// The file beside a cache: FILE.pc2.json.
std::filesystem::path sidecar_path(const std::filesystem::path& cache);

// PC2 point cache (as Blender's Mesh Cache modifier reads it), one sample per call. Little endian: "POINTCACHE2\0",
// int32 version 1, int32 points, float start frame, float sample rate, int32 samples; then the samples, three floats
// per point. The JSON file holds frames_per_second, start_frame, samples and vertices.
class PointCacheWriter
{
public:
    static voile::Result<PointCacheWriter> create(const std::filesystem::path& path,
                                                  const PointCacheSettings& settings);

    // Errors: another number of points, a value that is not finite, a full disk.
    voile::Result<void> append(std::span<const glm::vec3> positions);

    // Writes the number of samples, gives the file its name, and writes the file beside it. Without it nothing is left
    // behind.
    voile::Result<void> finish();

    [[nodiscard]] uint32_t samples() const { return samples_; }

private:
    PointCacheWriter(voile::engine::AtomicFile file, std::filesystem::path path, const PointCacheSettings& settings)
        : file_(std::move(file)), path_(std::move(path)), settings_(settings)
    {
    }

    voile::engine::AtomicFile file_;
    std::filesystem::path path_;
    PointCacheSettings settings_;
    uint32_t samples_ = 0;
};

} // namespace viewer
