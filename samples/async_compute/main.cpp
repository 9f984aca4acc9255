// Cloth on a compute queue beside rendering: while one queue draws frame n, the other simulates frame n + 1.
//
//   compute   | simulate 0 | simulate 1 | simulate 2 ...     `simulated` of a slot: simulate n, then draw n
//   main                   | draw 0     | draw 1     ...     `drawn` of a slot: draw n, then simulate n + 2
//
// The streams of the solver change with the next step, so each frame is drawn from a copy: an output per frame in
// flight, in vertex buffers of the host's. A buffer belongs to one queue family at a time. The compute queue releases
// it after the copy, the main queue acquires it before it draws. The way back needs no transfer, because the solver
// writes every byte of it again.
//
// This sample has no renderer. Where an engine draws, it copies the vertices into memory that the host reads, and
// checks the fall of the sheet in each frame.
#include "engine.hpp"
#include "take.hpp"

#include "samples/arguments.hpp"
#include "samples/progress.hpp"

#include <voile/cloth.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace
{

using foreign::Lane;

constexpr uint32_t k_side = 20; // vertices
constexpr uint32_t k_stride = 24;
constexpr VkDeviceSize k_bytes = VkDeviceSize{k_side} * k_side * k_stride;
constexpr int k_frames = 30; // of 1/60 s
constexpr int k_slots = foreign::Engine::k_slots;

// One per frame in flight.
struct Slot
{
    foreign::Buffer vertices; // position and normal, drawn by the main queue
    foreign::Buffer seen;     // their copy
    voile::OutputId output;
    VkSemaphore simulated = VK_NULL_HANDLE;
    VkSemaphore drawn = VK_NULL_HANDLE;
};

// Releases the vertices on the compute queue, or acquires them on the main one. The same barrier, with the half of it
// that its queue knows. Within one family it is an ordinary barrier.
void transfer(foreign::Engine& engine, VkCommandBuffer cmd, const Slot& slot, bool releases)
{
    const bool families_differ = engine.queue_family(Lane::main) != engine.queue_family(Lane::compute);
    if (releases && !families_differ)
        return; // the semaphore and the barrier of the main queue suffice
    VkBufferMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER;
    barrier.srcAccessMask = releases ? VK_ACCESS_SHADER_WRITE_BIT : 0;
    barrier.dstAccessMask = releases ? 0 : VK_ACCESS_TRANSFER_READ_BIT; // a renderer: VERTEX_ATTRIBUTE_READ
    barrier.srcQueueFamilyIndex = families_differ ? engine.queue_family(Lane::compute) : VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = families_differ ? engine.queue_family(Lane::main) : VK_QUEUE_FAMILY_IGNORED;
    barrier.buffer = slot.vertices.handle;
    barrier.size = VK_WHOLE_SIZE;
    const auto pipeline_barrier = reinterpret_cast<PFN_vkCmdPipelineBarrier>(engine.find("vkCmdPipelineBarrier"));
    pipeline_barrier(cmd, releases ? VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT : VK_PIPELINE_STAGE_TRANSFER_BIT,
                     releases ? VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT : VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 1,
                     &barrier, 0, nullptr);
}

// The sheet falls freely: after n frames by g (n / 60)^2 / 2, by every vertex.
void check_fall(const Slot& slot, int frame)
{
    const auto* vertices = static_cast<const float*>(slot.seen.mapped);
    const float time = static_cast<float>(frame + 1) / 60;
    for (uint32_t i = 0; i < k_side * k_side; ++i)
        if (std::abs(vertices[i * k_stride / 4 + 1] + 0.5f * 9.81f * time * time) > 1e-4f)
            throw std::runtime_error("frame " + std::to_string(frame) + " shows the vertices of another");
}

void simulate(foreign::Engine& engine, voile::Solver& solver, const Slot& slot, voile::Upload& upload, int frame)
{
    const VkCommandBuffer cmd = engine.begin_frame(Lane::compute);
    if (solver.needs_upload())
        upload = take(solver.record_upload(cmd));
    take(solver.record(cmd, {.duration = 1.f / 60, .air_density = 0}));
    take(solver.record_outputs(cmd, {slot.output}));
    transfer(engine, cmd, slot, true);
    // The slot's vertices are still being drawn: two frames ago.
    const VkSemaphore drawn = frame >= k_slots ? slot.drawn : VK_NULL_HANDLE;
    engine.submit_frame(Lane::compute, {drawn, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, slot.simulated});
}

void draw(foreign::Engine& engine, const Slot& slot, int frame)
{
    const VkCommandBuffer cmd = engine.begin_frame(Lane::main);
    if (frame >= k_slots)
        check_fall(slot, frame - k_slots); // that draw has completed
    transfer(engine, cmd, slot, false);
    const VkBufferCopy region{0, 0, k_bytes};
    const auto copy = reinterpret_cast<PFN_vkCmdCopyBuffer>(engine.find("vkCmdCopyBuffer"));
    copy(cmd, slot.vertices.handle, slot.seen.handle, 1, &region);
    engine.submit_frame(Lane::main, {slot.simulated, VK_PIPELINE_STAGE_TRANSFER_BIT, slot.drawn});
}

Slot create_slot(foreign::Engine& engine, voile::Solver& solver, voile::ClothId cloth)
{
    constexpr VkMemoryPropertyFlags k_host = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    Slot slot;
    slot.vertices = engine.create_buffer(k_bytes,
                                         VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                                             VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                         VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    slot.seen = engine.create_buffer(k_bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, k_host);
    slot.output = take(solver.add_output(
        cloth, {.buffer = slot.vertices.handle, .size = k_bytes, .stride = k_stride, .position = 0, .normal = 12}));
    slot.simulated = engine.create_semaphore();
    slot.drawn = engine.create_semaphore();
    return slot;
}

void run()
{
    samples::Progress progress(k_frames);
    foreign::Engine engine({.async_compute = true});
    std::printf("%s\n", engine.has_two_queues() ? "two queues" : "one queue: the device has no other");
    // The compute queue has no vertex input: nothing of the host's reads the streams there.
    voile::Solver solver = take(voile::Solver::create({.instance = engine.instance(),
                                                       .physical_device = engine.physical_device(),
                                                       .device = engine.device(),
                                                       .get_instance_proc_addr = engine.get_instance_proc_addr()},
                                                      {.host_scopes = voile::HostScopes{}}));
    const voile::ClothId sheet =
        take(solver.add_cloth(voile::GridCloth{.columns = k_side, .rows = k_side, .material = voile::cotton()}));
    std::array<Slot, k_slots> slots;
    for (Slot& slot : slots)
        slot = create_slot(engine, solver, sheet);
    voile::Upload upload;
    {
        const foreign::IdleGuard idle(engine);
        simulate(engine, solver, slots[0], upload, 0);
        for (int frame = 0; frame < k_frames; ++frame)
        {
            draw(engine, slots[static_cast<size_t>(frame) % slots.size()], frame);
            const int next = frame + 1;
            if (next < k_frames)
                simulate(engine, solver, slots[static_cast<size_t>(next) % slots.size()], upload, next);
            progress.update(static_cast<uint64_t>(next));
        }
    }
    for (int frame = k_frames - k_slots; frame < k_frames; ++frame)
        check_fall(slots[static_cast<size_t>(frame) % slots.size()], frame);
    std::printf("every frame was drawn from its own vertices\n");
    for (const Slot& slot : slots)
    {
        engine.destroy_buffer(slot.vertices);
        engine.destroy_buffer(slot.seen);
    }
}

} // namespace

int main(int argc, char** argv)
{
    try
    {
        if (samples::parse_no_arguments("async_compute", argc, argv))
            run();
        return 0;
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "async_compute: %s\n", error.what());
        return 1;
    }
}
