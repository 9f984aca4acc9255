// RunStatistics: collection and summary.
#include "samples/viewer/run_statistics.hpp"

#include "voile/engine/gpu/download.hpp"
#include "voile/engine/gpu/frames.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace viewer
{
namespace
{

// The vectors of one cloth after another, from padded ones.
class DownloadedVectors
{
public:
    explicit DownloadedVectors(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}

    std::vector<glm::vec3> next(uint32_t count)
    {
        std::vector<glm::vec4> padded(count);
        if (count > 0)
            std::memcpy(padded.data(), bytes_.data() + begin_, count * sizeof(glm::vec4));
        begin_ += count * sizeof(glm::vec4);
        return {padded.begin(), padded.end()};
    }

private:
    std::vector<std::byte> bytes_;
    size_t begin_ = 0;
};

// Positions, velocities and, on request, normals of each cloth.
DownloadedVectors download_vectors(const voile::engine::Device& device, const Stage& stage, bool normals)
{
    std::vector<voile::engine::BufferRange> ranges;
    for (const StageCloth& cloth : stage.cloths)
    {
        const voile::VertexStreams streams = stage.world->solver().vertices(cloth.id);
        const VkDeviceSize bytes = streams.vertices * sizeof(glm::vec4);
        ranges.push_back({streams.positions, streams.offset, bytes});
        ranges.push_back({streams.velocities, streams.offset, bytes});
        if (normals)
            ranges.push_back({streams.normals, streams.offset, bytes});
    }
    return DownloadedVectors(voile::engine::download(device, ranges));
}

// Records and waits.
template <typename Record>
void run(const voile::engine::Device& device, const Record& record)
{
    voile::engine::FrameRing ring(device, 1);
    const voile::engine::FrameRing::Frame frame = ring.begin();
    record(frame.cmd);
    ring.submit(frame);
    ring.wait_all();
}

// A run without frames has uploaded nothing yet: its state is the start.
void upload_start(const voile::engine::Device& device, voile::Solver& solver)
{
    voile::Upload upload;
    run(device, [&](VkCommandBuffer cmd) { upload = voile::engine::take(solver.record_upload(cmd)); });
}

uint64_t state_hash(const std::vector<FinalCloth>& state)
{
    StateHash hash;
    for (const FinalCloth& cloth : state)
        hash.add(cloth.positions);
    for (const FinalCloth& cloth : state)
        hash.add(cloth.velocities);
    return hash.value();
}

} // namespace

std::vector<FinalCloth> download_state(const voile::engine::Device& device, const Stage& stage)
{
    voile::Solver& solver = stage.world->solver();
    const bool at_start = solver.needs_upload();
    if (at_start)
        upload_start(device, solver);
    DownloadedVectors vectors = download_vectors(device, stage, !at_start);
    std::vector<FinalCloth> result;
    for (const StageCloth& cloth : stage.cloths)
    {
        const uint32_t vertices = solver.vertices(cloth.id).vertices;
        std::vector<glm::vec3> positions = vectors.next(vertices);
        std::vector<glm::vec3> velocities = vectors.next(vertices);
        std::vector<glm::vec3> normals = at_start ? surface_normals(positions, cloth.faces) : vectors.next(vertices);
        result.push_back(
            {cloth.name, std::move(positions), std::move(velocities), std::move(normals), solver.triangles(cloth.id)});
    }
    return result;
}

voile::IntersectionCounts count_intersections(const voile::engine::Device& device, const Stage& stage)
{
    voile::Solver& solver = stage.world->solver();
    run(device, [&](VkCommandBuffer cmd)
        { voile::engine::take(solver.record_statistics(cmd, 0, voile::Intersections::counted)); });
    return solver.statistics(0).intersections.value_or(voile::IntersectionCounts{});
}

PairCounts pair_counts(const voile::IntersectionCounts& counts)
{
    return {counts.cloth_pairs, counts.collider_pairs, counts.uncertain_pairs};
}

void RunStatistics::add_pass(const voile::gpu::PassTime& pass)
{
    auto series =
        std::find_if(passes_.begin(), passes_.end(), [&](const PassSeries& s) { return s.name == pass.name; });
    if (series == passes_.end())
        series = passes_.insert(passes_.end(), {std::string(pass.name), {}});
    series->milliseconds.push_back(pass.milliseconds);
}

void RunStatistics::completed(const Stage& stage, const voile::engine::FrameInfo& frame)
{
    const voile::Statistics measured = stage.world->solver().statistics(frame.slot);
    FrameStatistics entry;
    entry.frame = static_cast<uint32_t>(frame.index);
    entry.substeps = stage.world->step.substeps > 0 ? stage.world->step.substeps
                                                    : stage.world->solver().stable_substeps(frame.time_step);
    entry.max_stretch = static_cast<double>(measured.max_stretch);
    entry.mean_stretch = static_cast<double>(measured.mean_stretch);
    entry.kinetic_energy = static_cast<double>(measured.kinetic_energy);
    entry.penetrating_vertices = measured.penetrating_vertices;
    entry.deepest_penetration = static_cast<double>(measured.deepest_penetration);
    if (measured.intersections)
        entry.intersections = pair_counts(*measured.intersections);
    entry.nan_vertices = measured.nan_vertices;
    entry.contacts = measured.contacts;
    entry.candidates = measured.candidates;
    entry.contact_overflows = measured.overflowing_vertices;
    entry.forced_pairs = measured.forced_pairs;
    entry.tangled_pairs = measured.tangled_pairs;
    entry.pair_searches = measured.pair_searches;
    entry.sleeping_cloths = measured.sleeping_cloths;
    if (frame.timestamps != nullptr)
        for (const voile::gpu::PassTime& pass : frame.timestamps->read(frame.slot))
        {
            if (pass.name == "frame")
                entry.gpu_frame_ms = pass.milliseconds;
            else if (pass.name == "cloth")
                entry.gpu_cloth_ms = pass.milliseconds;
            else
                add_pass(pass);
        }
    if (frame.index < record_milliseconds_.size())
        entry.cpu_record_ms = record_milliseconds_[frame.index];
    frames_.push_back(entry);
}

Statistics RunStatistics::result(const Stage& stage, const SceneFile& scene, const voile::engine::DeviceInfo& device,
                                 const std::vector<FinalCloth>& state, float time_step) const
{
    const voile::Solver& solver = stage.world->solver();
    Statistics result;
    result.scene = scene.name;
    result.device = device.name;
    result.driver = device.driver;
    result.frames = static_cast<uint32_t>(frames_.size());
    result.per_frame = frames_;
    StatisticsSummary& summary = result.summary;
    summary.substeps_per_frame =
        stage.world->step.substeps > 0 ? stage.world->step.substeps : solver.stable_substeps(time_step);
    summary.vertices = solver.vertex_count();
    summary.triangles = solver.triangle_count();
    summary.state_hash = state_hash(state);
    summary.cpu_record_ms = percentiles(record_milliseconds_);
    std::vector<double> frame_ms;
    std::vector<double> cloth_ms;
    for (const FrameStatistics& frame : frames_)
    {
        frame_ms.push_back(frame.gpu_frame_ms);
        cloth_ms.push_back(frame.gpu_cloth_ms);
    }
    summary.gpu_frame_ms = percentiles(frame_ms);
    summary.gpu_cloth_ms = percentiles(cloth_ms);
    for (const PassSeries& series : passes_)
        summary.gpu_pass_ms.emplace_back(series.name, median(series.milliseconds));
    if (frames_.empty())
        return result;
    summary.last = frames_.back();
    for (const FrameStatistics& frame : frames_)
        summary.maxima = larger_of(summary.maxima, frame);
    return result;
}

} // namespace viewer
