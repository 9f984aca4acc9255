// Measures a case. Every repetition starts from the same state, so that all do the same work.
#include "measure.hpp"

#include "allocations.hpp"
#include "icosphere.hpp"

#include "voile/engine/gpu/download.hpp"

#include "voile/gpu/recorder.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <string>

namespace bench
{

namespace
{

// The model of the bytes that the passes move. Every value that a vertex owns counts once per pass. The neighbors'
// values that a gather reads again, the few bytes of cloths and patches, and the colliders' hierarchy are assumed to
// come from the caches. A value is a vec4 of 16 bytes; "state" and "stage" are two of them, x and v. A residual is half
// of one and belongs to its positions.
//   stage 1   reads state                          writes stage A        2.5 + 2.5 = 5
//   stage 2   reads stage A, state                 writes stage B        5 + 2.5   = 7.5
//   stage 3   reads stage B, state                 writes stage C        5 + 2.5   = 7.5
//   stage 4   reads stage C, state, v of A and B   writes the proposal   7 + 2.5   = 9.5
//   Verlet    reads x, v, predicted v              writes the same       3.5 + 3.5 = 7, instead of the stages
//   contact   reads proposed x and v, earlier x    nothing, in free fall             3
//   normals   reads positions                      writes normals        1.5 + 1   = 2.5, once per frame
// A mesh vertex also reads its record and its list of springs, 16 bytes each, in every evaluation of the forces. Edits,
// attachments, tethers and the strain limit are not counted. Data that fits a cache need not reach memory, so the
// fraction of the copy bandwidth can exceed 100 %.
constexpr double k_value = 16;
constexpr double k_rk4 = (5 + 7.5 + 7.5 + 9.5) * k_value;
constexpr double k_verlet = 7 * k_value;
constexpr double k_contact = 3 * k_value;
constexpr double k_normals = 2.5 * k_value;

double bytes_per_substep(const voile::Solver& solver, const Case& item, uint32_t substeps)
{
    const double list = item.lists > 0 ? (1 + item.lists) * k_value : 0;
    const double forces = item.verlet ? k_verlet + list : k_rk4 + 4 * list;
    const double a_vertex = forces + (item.in_contact ? k_contact : 0) + k_normals / substeps;
    return a_vertex * solver.vertex_count();
}

// The number of timed substeps: the whole frame on a GPU. A CPU device would take minutes over the finest grids.
uint32_t measured_substeps(const voile::engine::Device& device, const voile::Solver& solver, uint32_t substeps)
{
    constexpr uint32_t k_vertices_on_cpu = 1u << 19;
    constexpr uint32_t k_fewest = 4; // the one normals pass must not dominate
    if (!device.is_cpu())
        return substeps;
    return std::min(substeps, std::max(k_fewest, k_vertices_on_cpu / solver.vertex_count()));
}

// The positions and velocities of all cloths, saved on the device.
class Snapshot
{
public:
    Snapshot(TimedQueue& queue, const voile::Solver& solver, std::span<const voile::ClothId> cloths)
        : context_(queue.context())
    {
        VkDeviceSize bytes = 0;
        for (const voile::ClothId cloth : cloths)
        {
            const voile::VertexStreams streams = solver.vertices(cloth);
            const VkDeviceSize size = streams.vertices * sizeof(glm::vec4);
            regions_.push_back({streams.offset, streams.offset, size});
            bytes = std::max(bytes, streams.offset + size);
            live_positions_ = streams.positions;
            live_velocities_ = streams.velocities;
        }
        constexpr VkBufferUsageFlags k_usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
        positions_ = voile::engine::take(
            voile::gpu::create_buffer(context_, "snapshot positions", bytes, k_usage, voile::Memory::device));
        velocities_ = voile::engine::take(
            voile::gpu::create_buffer(context_, "snapshot velocities", bytes, k_usage, voile::Memory::device));
        queue.run(
            [&](VkCommandBuffer cmd)
            {
                record_wait(cmd);
                copy(cmd, live_positions_, positions_.handle());
                copy(cmd, live_velocities_, velocities_.handle());
            });
    }

    // Solver::record waits for the copies itself.
    void record_restore(VkCommandBuffer cmd) const
    {
        record_wait(cmd);
        copy(cmd, positions_.handle(), live_positions_);
        copy(cmd, velocities_.handle(), live_velocities_);
    }

private:
    // Waits for all earlier writes of the buffers, in this submission or an earlier one.
    void record_wait(VkCommandBuffer cmd) const
    {
        voile::gpu::Recorder(context_, cmd)
            .barrier(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT_KHR, VK_ACCESS_2_MEMORY_WRITE_BIT_KHR,
                     VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR,
                     VK_ACCESS_2_TRANSFER_READ_BIT_KHR | VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR);
    }

    void copy(VkCommandBuffer cmd, VkBuffer source, VkBuffer destination) const
    {
        context_.fn.vkCmdCopyBuffer(cmd, source, destination, static_cast<uint32_t>(regions_.size()), regions_.data());
    }

    const voile::gpu::Context& context_;
    std::vector<VkBufferCopy> regions_;
    VkBuffer live_positions_ = VK_NULL_HANDLE;
    VkBuffer live_velocities_ = VK_NULL_HANDLE;
    voile::gpu::Buffer positions_;
    voile::gpu::Buffer velocities_;
};

// Keeps the inverse masses.
void place(TimedQueue& queue, const voile::Solver& solver, voile::ClothId cloth, std::vector<glm::vec4> positions)
{
    const voile::VertexStreams streams = solver.vertices(cloth);
    const auto before =
        voile::engine::download_values<glm::vec4>(queue.device(), streams.positions, streams.offset, streams.vertices);
    for (size_t i = 0; i < positions.size(); ++i)
        positions[i].w = before[i].w;
    const VkDeviceSize bytes = positions.size() * sizeof(glm::vec4);
    const voile::gpu::Buffer staging = voile::engine::take(voile::gpu::create_buffer(
        queue.context(), "positions", bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, voile::Memory::upload));
    std::memcpy(staging.mapped().data(), positions.data(), bytes);
    staging.flush();
    const VkBufferCopy region{0, streams.offset, bytes};
    queue.run([&](VkCommandBuffer cmd)
              { queue.context().fn.vkCmdCopyBuffer(cmd, staging.handle(), streams.positions, 1, &region); });
}

voile::Statistics statistics(TimedQueue& queue, const voile::Solver& solver,
                             voile::Intersections intersections = voile::Intersections::not_counted)
{
    queue.run([&](VkCommandBuffer cmd) { voile::engine::take(solver.record_statistics(cmd, 0, intersections)); });
    return solver.statistics(0);
}

void check_intersections(TimedQueue& queue, const voile::Solver& solver, const Case& item)
{
    const voile::Statistics state = statistics(queue, solver, voile::Intersections::counted);
    if (const uint64_t pairs = state.intersections->cloth_pairs + state.intersections->uncertain_pairs; pairs > 0)
        throw voile::engine::StartupError("case " + std::string(item.name) + ": " + std::to_string(pairs) +
                                          " pairs of an edge and a triangle intersect");
}

void check_finite(const Case& item, const voile::Statistics& state, const char* when)
{
    if (state.nan_vertices > 0)
        throw voile::engine::StartupError("case " + std::string(item.name) + ": " + std::to_string(state.nan_vertices) +
                                          " vertices are not finite " + when);
}

// Runs the case up to the measurement. Returns the number of vertices that touch a collider.
uint32_t advance(TimedQueue& queue, voile::Solver& solver, const Case& item)
{
    for (uint32_t i = 0; i < item.frames_before; ++i)
        queue.run([&](VkCommandBuffer cmd) { voile::engine::take(solver.record(cmd, {.duration = k_frame})); });
    const voile::Statistics state = statistics(queue, solver);
    check_finite(item, state, "before the measurement");
    if (item.in_contact && state.contacts == 0)
        throw voile::engine::StartupError("case " + std::string(item.name) + ": no vertex touches a collider");
    if (item.asleep && state.sleeping_cloths == 0)
        throw voile::engine::StartupError("case " + std::string(item.name) + ": no cloth sleeps");
    return state.contacts;
}

void time_gpu(TimedQueue& queue, voile::Solver& solver, const Case& item, const Snapshot& start, uint32_t repetitions,
              Measurement& result)
{
    const voile::Step step{.duration =
                               k_frame * static_cast<float>(result.measured) / static_cast<float>(result.substeps),
                           .substeps = result.measured,
                           .wind = {item.wind, 0, 0},
                           .gust = item.gust};
    const auto record = [&](VkCommandBuffer cmd) { voile::engine::take(solver.record(cmd, step)); };
    const auto restore = [&](VkCommandBuffer cmd) { start.record_restore(cmd); };
    std::vector<double> times;
    (void)queue.time(record, restore); // warms up
    for (uint32_t i = 0; i < repetitions; ++i)
        times.push_back(queue.time(record, restore) / result.measured);
    result.gpu_median = quantile(times, 0.5);
    result.gpu_p95 = quantile(times, 0.95);
}

void time_recording(TimedQueue& queue, voile::Solver& solver, uint32_t repetitions, Measurement& result)
{
    using Clock = std::chrono::steady_clock;
    const voile::Step step{.duration = k_frame, .substeps = result.substeps};
    std::vector<double> times;
    times.reserve(repetitions);
    constexpr uint32_t k_unmeasured = 5; // the first steps of a solver with command_reuse record its command buffers
    for (uint32_t i = 0; i < k_unmeasured; ++i)
        queue.record_only([&](VkCommandBuffer cmd) { voile::engine::take(solver.record(cmd, step)); });
    for (uint32_t i = 0; i < repetitions; ++i)
        queue.record_only(
            [&](VkCommandBuffer cmd)
            {
                const uint64_t allocated = allocations();
                const Clock::time_point begin = Clock::now();
                voile::engine::take(solver.record(cmd, step));
                const Clock::time_point end = Clock::now();
                result.record_allocations += allocations() - allocated;
                times.push_back(std::chrono::duration<double, std::micro>(end - begin).count());
            });
    result.record_median = quantile(times, 0.5);
}

// Measures the query with the thickness to every side, which traversals without a candidate list make.
double measure_visits(TimedQueue& queue, const voile::Solver& solver, voile::ClothId cloth, uint32_t subdivisions)
{
    const voile::VertexStreams streams = solver.vertices(cloth);
    const auto positions =
        voile::engine::download_values<glm::vec4>(queue.device(), streams.positions, streams.offset, streams.vertices);
    const float thickness = std::get<voile::Fabric>(solver.material(cloth)).thickness;
    return node_visits(case_icosphere(subdivisions), positions, thickness);
}

} // namespace

Measurement measure(TimedQueue& queue, const Case& item, uint32_t repetitions, const Settings& settings)
{
    voile::SolverOptions options;
    options.tuning.contact_method = item.method;
    options.tuning.workgroup_size = settings.workgroup_size;
    if (settings.reuse)
        options.command_reuse = {.queue_family = queue.device().queue_family(), .steps_in_flight = 1};
    options.tuning.mesh_layout = item.layout;
    options.intersections = item.arrange != nullptr;
    voile::Solver solver = voile::engine::take(voile::Solver::create(queue.context().handles, options));
    const std::vector<voile::ClothId> cloths = item.build(solver);
    {
        voile::Upload kept;
        queue.run([&](VkCommandBuffer cmd) { kept = voile::engine::take(solver.record_upload(cmd)); });
    }

    if (item.arrange != nullptr)
        place(queue, solver, cloths.front(), item.arrange());

    Measurement result;
    result.vertices = solver.vertex_count();
    result.triangles = solver.triangle_count();
    result.substeps = solver.stable_substeps(k_frame);
    result.dispatches = solver.dispatches({.duration = k_frame, .substeps = result.substeps});
    result.measured = measured_substeps(queue.device(), solver, result.substeps);
    result.bytes = bytes_per_substep(solver, item, result.measured);
    result.contacts = advance(queue, solver, item);

    if (item.icosphere)
        result.visits = measure_visits(queue, solver, cloths.front(), *item.icosphere);
    if (item.arrange != nullptr)
        check_intersections(queue, solver, item);
    const Snapshot start(queue, solver, cloths);
    if (settings.passes)
        print_passes(queue, solver, {.duration = k_frame, .substeps = result.substeps},
                     [&](VkCommandBuffer cmd) { start.record_restore(cmd); });
    time_gpu(queue, solver, item, start, repetitions, result);
    check_finite(item, statistics(queue, solver), "after the measurement");
    time_recording(queue, solver, repetitions, result);
    return result;
}

} // namespace bench
