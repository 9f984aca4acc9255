// Refit cases. Repetitions need no restored state: a refit of the same vertices does the same work.
#include "refit_case.hpp"

#include "colliders/refit.hpp"
#include "geometry/padded_tree.hpp"

#include "shared/bindings.h"

#include "voile/engine/gpu/download.hpp"
#include "voile/engine/gpu/upload.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>
#include <string>

namespace bench
{

namespace
{

constexpr RefitCase k_refits[] = {
    {"refit-1m", "refit of 1,048,576 triangles", 1024, 512},
    {"refit-1m-128", "in workgroups of 128 threads instead of 256", 1024, 512, 128},
    {"refit-1m-512", "of 512", 1024, 512, 512},
    {"refit-1m-shuffled", "its vertices in random order", 1024, 512, 256, true},
    {"refit-131k", "131,072 triangles", 256, 256},
    {"refit-16k", "16,384 triangles", 128, 64},
};

struct Sheet
{
    std::vector<glm::vec4> positions; // at the step's start, then at its end
    std::vector<glm::uvec3> triangles;
};

glm::vec4 position_at(uint32_t column, uint32_t row, float time)
{
    const auto x = 0.01f * static_cast<float>(column);
    const auto z = 0.01f * static_cast<float>(row);
    return {x, 0.2f * std::sin(3 * x + time) * std::sin(2 * z), z, 1};
}

Sheet make_sheet(const RefitCase& item)
{
    const uint32_t across = item.columns + 1;
    const uint32_t vertices = across * (item.rows + 1);
    std::vector<uint32_t> order(vertices);
    std::iota(order.begin(), order.end(), 0u);
    if (item.shuffled)
        std::shuffle(order.begin(), order.end(), std::mt19937(1));
    Sheet sheet;
    sheet.positions.resize(size_t{2} * vertices);
    for (uint32_t row = 0; row <= item.rows; ++row)
        for (uint32_t column = 0; column <= item.columns; ++column)
        {
            const uint32_t corner = row * across + column;
            sheet.positions[order[corner]] = position_at(column, row, 0);
            sheet.positions[vertices + order[corner]] = position_at(column, row, 0.05f);
            if (row == item.rows || column == item.columns)
                continue;
            const uint32_t next = order[corner + 1];
            const uint32_t below = order[corner + across];
            sheet.triangles.emplace_back(order[corner], below, next);
            sheet.triangles.emplace_back(next, below, order[corner + across + 1]);
        }
    return sheet;
}

// Bytes that must be moved, each once: the slots and both positions of every vertex read, every box written, and the
// boxes that the next dispatch reads again. A vertex's six gathers are assumed to come from the caches.
double bytes_moved(const voile::PaddedTree& tree, const Sheet& sheet, uint32_t levels_per_dispatch)
{
    double boxes = static_cast<double>(tree.boxes());
    for (uint32_t level = tree.levels; level > levels_per_dispatch;)
        boxes += std::exp2(level -= levels_per_dispatch);
    return static_cast<double>(tree.leaves.size() * sizeof(voile::shared::PaddedLeaf)) +
           static_cast<double>(sheet.positions.size() * sizeof(glm::vec4)) + boxes * sizeof(voile::shared::PaddedBox);
}

void check_root(const RefitCase& item, const voile::shared::PaddedBox& root, const Sheet& sheet)
{
    glm::vec3 min(sheet.positions.front());
    glm::vec3 max = min;
    for (const glm::vec4& p : sheet.positions)
    {
        min = glm::min(min, glm::vec3(p));
        max = glm::max(max, glm::vec3(p));
    }
    if (root.min != min || root.max != max)
        throw voile::engine::StartupError("case " + std::string(item.name) +
                                          ": the root's box is not that of all vertices");
}

} // namespace

std::span<const RefitCase> refit_cases()
{
    return k_refits;
}

const RefitCase* find_refit_case(std::string_view name)
{
    const auto* const found = std::find_if(std::begin(k_refits), std::end(k_refits),
                                           [&](const RefitCase& item) { return name == item.name; });
    return found == std::end(k_refits) ? nullptr : found;
}

double refit_floor(const RefitMeasurement& measurement, const DeviceProbe& probe)
{
    return measurement.bytes / probe.copy_bandwidth * 1e6 + measurement.dispatches * probe.empty_dispatch;
}

RefitMeasurement measure_refit(TimedQueue& queue, const RefitCase& item, uint32_t repetitions)
{
    using Clock = std::chrono::steady_clock;
    const voile::gpu::Context& context = queue.context();
    const Sheet sheet = make_sheet(item);
    const auto vertices = static_cast<uint32_t>(sheet.positions.size() / 2);
    const std::vector<glm::vec3> start(sheet.positions.begin(), sheet.positions.begin() + vertices);
    const Clock::time_point begin = Clock::now();
    const voile::PaddedTree tree = voile::build_padded_tree(start, sheet.triangles);
    const Clock::time_point end = Clock::now();
    const voile::RefitKernels kernels = voile::engine::take(voile::create_refit_kernels(context, item.workgroup_size));
    voile::shared::TreeRecord where{};
    where.first_box = voile::aligned_first_box(0);
    where.first_to = vertices;
    where.triangles = tree.triangles;

    voile::engine::UploadBatch batch(context);
    const voile::gpu::Buffer trees = batch.buffer("trees", std::vector{where}, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const voile::gpu::Buffer leaves = batch.buffer("leaves", tree.leaves, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const voile::gpu::Buffer positions = batch.buffer("positions", sheet.positions, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    const voile::gpu::Buffer boxes = voile::engine::take(voile::gpu::create_buffer(
        context, "boxes", (where.first_box + tree.boxes()) * sizeof(voile::shared::PaddedBox),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT, voile::Memory::device));
    queue.run([&](VkCommandBuffer cmd) { batch.record(cmd); });
    voile::gpu::BindingPool pool = voile::engine::take(voile::gpu::BindingPool::create(context, 1, 4));
    const VkDescriptorSet set =
        voile::engine::take(pool.bind(kernels.leaves, {{voile::binding::cloth_trees, trees.handle()},
                                                       {voile::binding::refit_leaves, leaves.handle()},
                                                       {voile::binding::refit_positions, positions.handle()},
                                                       {voile::binding::refit_boxes, boxes.handle()}}));

    const auto record = [&](VkCommandBuffer cmd)
    {
        voile::gpu::Recorder recorder(context, cmd);
        voile::record_refit(recorder, kernels, set, where);
    };
    voile::gpu::Recorder dry(context);
    voile::record_refit(dry, kernels, set, where);
    queue.run(record); // warms up
    std::vector<double> times;
    for (uint32_t i = 0; i < repetitions; ++i)
        times.push_back(queue.time(record));
    check_root(item,
               voile::engine::download_values<voile::shared::PaddedBox>(
                   queue.device(), boxes.handle(), where.first_box * sizeof(voile::shared::PaddedBox), 1)
                   .front(),
               sheet);
    return {.vertices = vertices,
            .triangles = tree.triangles,
            .dispatches = dry.dispatches(),
            .build = std::chrono::duration<double, std::milli>(end - begin).count(),
            .gpu_median = quantile(times, 0.5),
            .gpu_p95 = quantile(times, 0.95),
            .bytes = bytes_moved(tree, sheet, kernels.levels_per_dispatch)};
}

} // namespace bench
