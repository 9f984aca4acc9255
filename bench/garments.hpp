// What characters cost: figures of capsules that move, each in a garment.
#pragma once

#include "passes.hpp"
#include "timed_queue.hpp"

#include <cstdint>
#include <vector>

namespace bench
{

// Figures of 20 capsules, each in a cape of cotton, Verlet, that hangs from its neck. Frames of 1/60 s, medians.
struct GarmentsMeasurement
{
    uint32_t figures = 0;
    uint32_t side = 0;       // vertices along each side of a cape
    bool moving = false;     // figures walk: all capsules and anchors move in every frame
    uint32_t substeps = 0;   // per frame
    uint32_t dispatches = 0; // per frame
    double gpu = 0;          // ms per frame of Solver::record
    double gpu_p95 = 0;      // ms
    double move = 0;         // host us per frame, in move_collider and move_anchor
    double record = 0;       // host us per frame, in Solver::record
    uint32_t contacts = 0;   // vertices that touch at the end
    uint32_t inside = 0;     // vertices inside a capsule then
};

constexpr const char* k_garments_case = "garments"; // its name
// 100 figures in capes of 32 x 32 that stand and that walk, then one in a cape of 320 x 320 with the same spacing and
// capsules ten times as large. CPU devices: 4 figures, 64 x 64.
std::vector<GarmentsMeasurement> measure_garments(TimedQueue& queue, const Settings& settings);

} // namespace bench
