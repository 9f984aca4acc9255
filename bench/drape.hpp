// The drape scene, frame by frame: the scene on which peers were timed, with the conditions of a valid run.
#pragma once

#include "passes.hpp"
#include "timed_queue.hpp"

#include "voile/solver.hpp"

#include <span>
#include <string_view>

namespace bench
{

enum class DrapeSubject
{
    sheet,         // the scene's sheet of 2.4 m
    cotton,        // 1 m of cotton in its place
    pinned_cotton, // 1 m of cotton that hangs from two corners, without colliders
    pinned_mesh,   // the same as a mesh
};

const char* describe(DrapeSubject subject);

struct DrapeCase
{
    const char* name = nullptr;
    uint32_t side = 0; // vertices along each side
    voile::Integrator integrator = voile::Integrator::rk4;
    bool self_collision = false;
    DrapeSubject subject = DrapeSubject::sheet;
    uint32_t max_substeps = voile::Step{}.max_substeps;
};
std::span<const DrapeCase> drape_cases();
const DrapeCase* find_drape_case(std::string_view name); // null if there is none

// 90 frames of 1/60 s; times are those of frames 30 to 89.
struct DrapeMeasurement
{
    uint32_t vertices = 0;
    uint32_t triangles = 0;
    uint32_t substeps = 0;   // per frame
    uint32_t dispatches = 0; // per frame
    double gpu_median = 0;   // ms per frame of Solver::record
    double gpu_p95 = 0;      // ms
    // The conditions.
    double stretch_99 =
        0; // the largest over all frames of the 99 % quantile of l / L - 1 of the structural springs; < 0.12
    double last_stretch = 0;  // largest l / L - 1 of the structural springs after the last frame; < 0.15
    double deep_fraction = 0; // of the vertices deeper than 5 mm in the heart after the last frame; <= 0.001
    double height = 0;        // m, mean after frame 30; < 0.30
    bool has_budget = false;  // fewer substeps than needed: only stretch_99 < 0.08 and the depth are conditions
    [[nodiscard]] bool valid() const
    {
        if (has_budget)
            return stretch_99 < 0.08 && deep_fraction <= 0.001;
        return stretch_99 < 0.12 && last_stretch < 0.15 && deep_fraction <= 0.001 && height < 0.30;
    }
};

DrapeMeasurement measure_drape(TimedQueue& queue, const DrapeCase& item, const Settings& settings);

} // namespace bench
