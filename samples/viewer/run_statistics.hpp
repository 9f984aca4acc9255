// RunStatistics: what is measured during a run, frame by frame, and its summary.
#pragma once

#include "samples/viewer/stage.hpp"
#include "samples/viewer/statistics_file.hpp"

namespace viewer
{

// A cloth's state at the end of a run.
struct FinalCloth
{
    std::string name;
    std::vector<glm::vec3> positions;  // m
    std::vector<glm::vec3> velocities; // m/s
    std::vector<glm::vec3> normals;    // before the first step computed on the host
    std::vector<glm::uvec3> triangles;
};

// Waits for the device.
std::vector<FinalCloth> download_state(const voile::engine::Device& device, const Stage& stage);

// The intersections of the state as it is. Waits for the device.
voile::IntersectionCounts count_intersections(const voile::engine::Device& device, const Stage& stage);

PairCounts pair_counts(const voile::IntersectionCounts& counts);

class RunStatistics
{
public:
    // Once a frame, when it has been recorded: the host's time.
    void recorded(double milliseconds) { record_milliseconds_.push_back(milliseconds); }
    // Once a frame, in their order, when the device has finished it.
    void completed(const Stage& stage, const voile::engine::FrameInfo& frame);

    [[nodiscard]] Statistics result(const Stage& stage, const SceneFile& scene, const voile::engine::DeviceInfo& device,
                                    const std::vector<FinalCloth>& state, float time_step) const;

private:
    struct PassSeries
    {
        std::string name;
        std::vector<double> milliseconds; // one per frame
    };
    void add_pass(const voile::gpu::PassTime& pass);

    std::vector<FrameStatistics> frames_;
    std::vector<double> record_milliseconds_;
    std::vector<PassSeries> passes_; // in the order of first use
};

} // namespace viewer
