#include "physics/rig.hpp"

#include "support/kept_pipelines.hpp"

#include "voile/engine/gpu/download.hpp"
#include "voile/gpu/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace physics
{

namespace
{

// Without validation: the same commands are validated by the other tests.
voile::engine::Device& device()
{
    static auto& instance = tests::UntilEnd::get().keep<voile::engine::Device>(
        voile::engine::DeviceOptions{.device = {}, .validation = false, .instance_extensions = {}, .swapchain = false});
    return instance;
}

} // namespace

Rig::Rig()
    : solver(voile::engine::take(voile::Solver::create(tests::KeptPipelines::handles(device().context()), {}))),
      frames_(device(), 1)
{
}

void Rig::run(const std::function<void(VkCommandBuffer)>& record)
{
    const voile::engine::FrameRing::Frame frame = frames_.begin();
    record(frame.cmd);
    frames_.submit(frame);
    frames_.wait(frame.slot);
}

void Rig::upload()
{
    voile::Upload kept;
    run([&](VkCommandBuffer cmd) { kept = voile::engine::take(solver.record_upload(cmd)); });
}

void Rig::step(const voile::Step& step, uint32_t times)
{
    for (uint32_t i = 0; i < times; ++i)
        run([&](VkCommandBuffer cmd) { voile::engine::take(solver.record(cmd, step)); });
}

std::vector<glm::dvec3> Rig::read(VkBuffer buffer, const voile::VertexStreams& streams)
{
    std::vector<glm::dvec3> result;
    for (const glm::vec4& v :
         voile::engine::download_values<glm::vec4>(device(), buffer, streams.offset, size_t{streams.vertices}))
    {
        if (!std::isfinite(v.x + v.y + v.z))
            throw std::runtime_error("a vertex is not finite");
        result.emplace_back(v);
    }
    return result;
}

std::vector<glm::dvec3> Rig::positions(voile::ClothId cloth)
{
    const voile::VertexStreams streams = solver.vertices(cloth);
    return read(streams.positions, streams);
}

std::vector<glm::dvec3> Rig::velocities(voile::ClothId cloth)
{
    const voile::VertexStreams streams = solver.vertices(cloth);
    return read(streams.velocities, streams);
}

double Rig::kinetic_energy()
{
    run([&](VkCommandBuffer cmd) { voile::engine::take(solver.record_statistics(cmd, 0)); });
    return static_cast<double>(solver.statistics(0).kinetic_energy);
}

void Rig::set_positions(voile::ClothId cloth, const std::vector<glm::dvec3>& positions)
{
    const voile::VertexStreams streams = solver.vertices(cloth);
    auto values = voile::engine::download_values<glm::vec4>(device(), streams.positions, streams.offset,
                                                            size_t{streams.vertices});
    for (size_t i = 0; i < values.size(); ++i)
        values[i] = glm::vec4(glm::vec3(positions[i]), values[i].w);
    constexpr size_t k_most = 65536 / sizeof(glm::vec4); // limit of vkCmdUpdateBuffer
    for (size_t first = 0; first < values.size(); first += k_most)
        run(
            [&](VkCommandBuffer cmd)
            {
                solver.context().fn.vkCmdUpdateBuffer(
                    cmd, streams.positions, streams.offset + first * sizeof(glm::vec4),
                    std::min(k_most, values.size() - first) * sizeof(glm::vec4), &values[first]);
            });
    stop(cloth);
}

void Rig::stop(voile::ClothId cloth)
{
    const voile::VertexStreams streams = solver.vertices(cloth);
    run(
        [&](VkCommandBuffer cmd)
        {
            solver.context().fn.vkCmdFillBuffer(cmd, streams.velocities, streams.offset,
                                                streams.vertices * sizeof(glm::vec4), 0);
            voile::gpu::Recorder(solver.context(), cmd)
                .barrier(VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR,
                         VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT_KHR, VK_ACCESS_2_MEMORY_READ_BIT_KHR);
        });
}

void Rig::settle(voile::ClothId cloth, const voile::Step& step, uint32_t most, double rest)
{
    double highest = 0;
    double before = 0;
    for (uint32_t steps = 1; steps <= most; ++steps)
    {
        // Steps of different durations: equal ones may sample a mode only at its turning points, where a stop removes
        // nothing.
        voile::Step part = step;
        part.duration *= 0.5f + 0.5f * static_cast<float>(std::fmod(0.618034 * steps, 1.0));
        this->step(part);
        const double energy = kinetic_energy();
        highest = std::max(highest, energy);
        if (energy < before)
        {
            if (before < rest * highest)
                return;
            stop(cloth);
            before = 0;
        }
        else
            before = energy;
    }
    throw std::runtime_error("a cloth did not come to rest");
}

} // namespace physics
