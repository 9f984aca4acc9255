// Cloth that falls over meshes from files, which nothing was tuned for.
#pragma once

#include "passes.hpp"
#include "timed_queue.hpp"

#include "voile/engine/assets/mesh.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace bench
{

struct RealCase
{
    std::string name; // real-NAME or real-NAME-turning
    std::filesystem::path file;
    bool turns = false;
    bool self_collision = false;
};

// Two cases per OBJ file of the folder, in the order of the names. StartupError if the folder has none.
std::vector<RealCase> real_cases(const std::filesystem::path& folder);

// Cotton of 1.6 m, Verlet, over the mesh, fitted to 1 m, and a ground plane: 240 frames of 1/60 s. 128 x 128 vertices;
// 64 x 64 on CPU devices.
struct RealMeasurement
{
    uint32_t vertices = 0;
    uint32_t triangles = 0;  // of the mesh
    uint32_t substeps = 0;   // per frame
    uint32_t dispatches = 0; // per frame
    double gpu_median = 0;   // ms per frame of Solver::record
    double gpu_p95 = 0;      // ms
    // Pairs of an edge and a triangle of cloth and collider that intersect.
    uint32_t most_crossings = 0; // of the frames that are a multiple of ten
    uint32_t last_crossings = 0;
};

RealMeasurement measure_real(TimedQueue& queue, const RealCase& item, const Settings& settings);

} // namespace bench
