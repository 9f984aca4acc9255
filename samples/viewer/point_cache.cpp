// PointCacheWriter: the samples, the header's count, and the file beside it.
#include "samples/viewer/point_cache.hpp"

#include "samples/viewer/exports.hpp"
#include "samples/viewer/text.hpp"

#include "voile/engine/assets/file.hpp"
#include "voile/engine/assets/words.hpp"

#include <bit>
#include <limits>
#include <string>

namespace viewer
{
namespace
{

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "the samples are written as memory holds them");
static_assert(sizeof(glm::vec3) == 12);

constexpr long k_sample_count_offset = 28; // of the header of 32 bytes
constexpr uint32_t k_most_int32 = static_cast<uint32_t>(std::numeric_limits<int32_t>::max());

template <typename T>
void put(std::string& bytes, const T& value)
{
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

std::string sidecar_text(const PointCacheSettings& settings, uint32_t samples)
{
    return "{\"frames_per_second\": " + number_text(settings.rate) +
           ", \"start_frame\": " + number_text(settings.start_frame) + ", \"samples\": " + std::to_string(samples) +
           ", \"vertices\": " + std::to_string(settings.points) + "}\n";
}

} // namespace

fs::path sidecar_path(const fs::path& cache)
{
    fs::path path = cache;
    return path += ".json";
}

voile::Result<PointCacheWriter> PointCacheWriter::create(const fs::path& path, const PointCacheSettings& settings)
{
    if (settings.points > k_most_int32)
        return voile::Error{voile::engine::path_text(path) + ": too many points for the format"};
    voile::Result<voile::engine::AtomicFile> file = voile::engine::AtomicFile::create(path);
    if (!file)
        return file.error();
    std::string header("POINTCACHE2\0", 12);
    put(header, int32_t{1});
    put(header, static_cast<int32_t>(settings.points));
    put(header, settings.start_frame);
    put(header, settings.sample_rate);
    put(header, int32_t{0}); // samples: known at the end
    file.value().write(header);
    return PointCacheWriter(std::move(file.value()), path, settings);
}

voile::Result<void> PointCacheWriter::append(std::span<const glm::vec3> positions)
{
    const auto error = [&](const std::string& reason)
    { return voile::Error{voile::engine::path_text(path_) + ": sample " + std::to_string(samples_) + " " + reason}; };
    if (positions.size() != settings_.points)
        return error("has " + std::to_string(positions.size()) + " points instead of " +
                     std::to_string(settings_.points));
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
    if (auto committed = file_.commit(); !committed)
        return committed;
    return voile::engine::write_file(sidecar_path(path_), sidecar_text(settings_, samples_));
}

} // namespace viewer
