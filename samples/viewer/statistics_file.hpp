// The statistics of a run, as a JSON file that scripts read. Keys and units are those of the README.
#pragma once

#include "voile/result.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace viewer
{

// What was not measured. Written as null, like everything else that is not finite: JSON has no other word for it.
constexpr double k_not_measured = std::numeric_limits<double>::quiet_NaN();

struct Percentiles
{
    double median = k_not_measured;
    double p95 = k_not_measured;
};

// The middle value, or the mean of the middle two. Not measured for an empty span; values that are not finite are left
// out.
double median(std::span<const double> values);
// The smallest value that at least 95 % of the values do not exceed (nearest rank).
double p95(std::span<const double> values);
Percentiles percentiles(std::span<const double> values);

// As voile::IntersectionCounts; only --debug intersections and --verify count them.
struct PairCounts
{
    std::optional<uint64_t> cloth;
    std::optional<uint64_t> collider;
    std::optional<uint64_t> uncertain;
};

// The state of all cloths after a frame.
struct Measurements
{
    double max_stretch = k_not_measured;    // l/L - 1 over structural and shear springs, or mesh edges
    double mean_stretch = k_not_measured;   // as above
    double kinetic_energy = k_not_measured; // J
    std::optional<uint64_t> penetrating_vertices;
    double deepest_penetration = k_not_measured; // m
    PairCounts intersections;
    std::optional<uint64_t> nan_vertices;
    std::optional<uint64_t> contacts;          // vertices that touch a collider
    std::optional<uint64_t> candidates;        // triangles of colliders that vertices keep as near
    std::optional<uint64_t> contact_overflows; // vertices near more of them than they can keep: slower, not less exact
    std::optional<uint64_t> forced_pairs;      // of cloths; pins left them no room
    std::optional<uint64_t> tangled_pairs;     // of cloths that are pulled apart
    std::optional<uint64_t> pair_searches;     // of a step, for near pairs of cloths
    std::optional<uint64_t> sleeping_cloths;
};

// The larger value of each; of one that was measured only once, that one.
Measurements larger_of(const Measurements& a, const Measurements& b);

struct StatisticsSummary
{
    uint32_t substeps_per_frame = 0;
    uint64_t vertices = 0;
    uint64_t triangles = 0;
    Measurements last;                          // after the last frame
    std::optional<uint64_t> self_intersections; // pairs of triangles after the last frame; only --verify counts them
    bool verified = false;                      // the counts of `last` are those of --verify, on the CPU
    Measurements maxima;                        // over all frames
    Percentiles gpu_frame_ms;                   // the whole frame
    Percentiles gpu_cloth_ms;                   // the cloth's passes
    std::vector<std::pair<std::string, double>> gpu_pass_ms; // median a frame, by the pass's name
    Percentiles cpu_record_ms;
    uint64_t state_hash = 0; // written as 16 hexadecimal digits
};

struct FrameStatistics : Measurements
{
    uint32_t frame = 0;
    uint32_t substeps = 0;
    double gpu_frame_ms = k_not_measured;
    double gpu_cloth_ms = k_not_measured;
    double cpu_record_ms = k_not_measured;
};

struct Statistics
{
    std::string scene; // its name
    std::string device;
    std::string driver;
    uint32_t frames = 0;
    StatisticsSummary summary;
    std::vector<FrameStatistics> per_frame;
};

// FNV-1a, 64 bits (Fowler, Noll, Vo 1991), over the bytes in memory: equal hashes mean equal bits, signs of zeros and
// the bits of NaNs included. The order of the calls counts: all positions of all cloths, then all velocities.
class StateHash
{
public:
    void add(std::span<const std::byte> bytes);
    void add(std::span<const glm::vec3> values) { add(std::as_bytes(values)); }
    [[nodiscard]] uint64_t value() const { return value_; }

private:
    uint64_t value_ = 0xcbf29ce484222325u;
};

std::string hash_text(uint64_t hash); // 16 lower-case hexadecimal digits

std::string statistics_text(const Statistics& statistics);

// Errors name the file and the system's reason. The file appears under its name only when it is complete.
voile::Result<void> save_statistics(const std::filesystem::path& path, const Statistics& statistics);

} // namespace viewer
