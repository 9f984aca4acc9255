// Adding mesh colliders.
#include "add_mesh.hpp"

#include "heart.hpp"
#include "timed_queue.hpp"

#include "voile/cooked.hpp"
#include "voile/engine/assets/shapes.hpp"
#include "voile/solver.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <functional>
#include <memory>

namespace bench
{

namespace
{

// 2 million triangles, open: hills of 0.3 m on 10 m x 10 m.
voile::engine::Mesh make_terrain()
{
    constexpr uint32_t k_side = 1000; // squares
    voile::engine::Mesh mesh;
    for (uint32_t row = 0; row <= k_side; ++row)
        for (uint32_t column = 0; column <= k_side; ++column)
        {
            const float x = 0.01f * static_cast<float>(column);
            const float z = 0.01f * static_cast<float>(row);
            const float y = 0.3f * std::sin(3 * x) * std::cos(2 * z) + 0.02f * std::sin(41 * x + 17 * z);
            mesh.positions.emplace_back(x, y, z);
        }
    for (uint32_t row = 0; row < k_side; ++row)
        for (uint32_t column = 0; column < k_side; ++column)
        {
            const uint32_t a = row * (k_side + 1) + column;
            const uint32_t b = a + k_side + 1;
            mesh.triangles.emplace_back(a, b, a + 1);
            mesh.triangles.emplace_back(a + 1, b, b + 1);
        }
    return mesh;
}

// 2 million triangles, closed: every edge has to be looked at.
voile::engine::Mesh make_ball()
{
    return voile::engine::make_sphere({0, 0, 0}, 1, 708);
}

constexpr AddCase k_cases[] = {
    {"add-heart", "the reference scene's heart", scenes::make_reference_heart, 50},
    {"add-terrain", "an open mesh of 2 million triangles", make_terrain, 7},
    {"add-ball", "a closed mesh of 2 million triangles", make_ball, 7},
};

// Milliseconds.
double time_add(const voile::engine::Device& device, const voile::MeshCollider& collider)
{
    voile::Solver solver = voile::engine::take(voile::Solver::create(device.context().handles, {}));
    const auto begin = std::chrono::steady_clock::now();
    (void)voile::engine::take(solver.add_collider(collider));
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

// `prepare` before each, untimed.
HostCost time_host(const char* what, size_t size, uint32_t repetitions, const std::function<void()>& prepare,
                   const std::function<void()>& work)
{
    std::vector<double> clock;
    std::vector<double> processor;
    for (uint32_t i = 0; i < repetitions; ++i)
    {
        prepare();
        const std::clock_t ticks = std::clock();
        const auto begin = std::chrono::steady_clock::now();
        work();
        clock.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
        processor.push_back(1e3 * static_cast<double>(std::clock() - ticks) / CLOCKS_PER_SEC);
    }
    return {what, size, quantile(clock, 0.5), quantile(processor, 0.5)};
}

// A sheet of side x side vertices, its heights uneven.
voile::engine::Mesh make_uneven_sheet(uint32_t side)
{
    voile::engine::Mesh mesh;
    for (uint32_t row = 0; row < side; ++row)
        for (uint32_t column = 0; column < side; ++column)
            mesh.positions.emplace_back(0.01f * static_cast<float>(column),
                                        0.002f * static_cast<float>((row * 37 + column * 71) % 13) / 13,
                                        0.01f * static_cast<float>(row));
    for (uint32_t row = 0; row + 1 < side; ++row)
        for (uint32_t column = 0; column + 1 < side; ++column)
        {
            const uint32_t a = row * side + column;
            mesh.triangles.emplace_back(a, a + side, a + 1);
            mesh.triangles.emplace_back(a + 1, a + side, a + side + 1);
        }
    return mesh;
}

voile::MeshCloth isometric_cloth(const voile::engine::Mesh& mesh)
{
    voile::Fabric fabric;
    fabric.bending_model = voile::BendingModel::isometric;
    return {.positions = mesh.positions, .triangles = mesh.triangles, .material = fabric};
}

using Bytes = std::vector<std::byte>;

void measure_cloth(const voile::Handles& handles, uint32_t side, std::vector<HostCost>& costs)
{
    constexpr uint32_t k_repetitions = 7;
    const voile::engine::Mesh mesh = make_uneven_sheet(side);
    const voile::MeshCloth cloth = isometric_cloth(mesh);
    const size_t vertices = mesh.positions.size();
    std::unique_ptr<voile::Solver> solver;
    const auto renew = [&]
    { solver = std::make_unique<voile::Solver>(voile::engine::take(voile::Solver::create(handles, {}))); };
    const auto nothing = [] {};
    costs.push_back(time_host("add a cloth mesh", vertices, k_repetitions, renew,
                              [&] { (void)voile::engine::take(solver->add_cloth(cloth)); }));
    voile::CookedCloth cooked;
    costs.push_back(time_host("cook it", vertices, k_repetitions, nothing,
                              [&] { cooked = voile::engine::take(voile::cook(cloth)); }));
    const auto bytes = std::make_shared<const Bytes>(cooked.bytes());
    costs.push_back(time_host("load it, without a copy", vertices, k_repetitions, nothing,
                              [&] { cooked = voile::engine::take(voile::CookedCloth::load(*bytes, bytes)); }));
    costs.push_back(time_host("load it with a copy", vertices, k_repetitions, nothing,
                              [&] { cooked = voile::engine::take(voile::CookedCloth::load(*bytes)); }));
    voile::MeshCloth instance = isometric_cloth({});
    instance.cooked = cooked;
    costs.push_back(time_host("add it cooked", vertices, k_repetitions, renew,
                              [&] { (void)voile::engine::take(solver->add_cloth(instance)); }));
    costs.push_back(time_host(
        "add one more instance", vertices, k_repetitions,
        [&]
        {
            renew();
            (void)voile::engine::take(solver->add_cloth(instance));
        },
        [&] { (void)voile::engine::take(solver->add_cloth(instance)); }));
}

// A cloth of 1,024 vertices beside a closed mesh of 998,000 triangles, which collides with another cloth already.
void measure_beside(TimedQueue& queue, std::vector<HostCost>& costs)
{
    constexpr uint32_t k_repetitions = 5;
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0, 0}, 1, 500);
    const size_t triangles = ball.triangles.size();
    const voile::MeshCollider collider{.positions = ball.positions, .triangles = ball.triangles};
    voile::CookedCollider cooked;
    const auto forget = []
    {
        voile::set_hierarchy_cache_limit(0);
        voile::set_hierarchy_cache_limit(voile::k_default_hierarchy_cache_limit);
    };
    costs.push_back(time_host("cook a mesh collider", triangles, k_repetitions, forget,
                              [&] { cooked = voile::engine::take(voile::cook(collider)); }));
    const auto bytes = std::make_shared<const Bytes>(cooked.bytes());
    costs.push_back(time_host(
        "load it, without a copy", triangles, k_repetitions, [] {},
        [&] { cooked = voile::engine::take(voile::CookedCollider::load(*bytes, bytes)); }));

    voile::Solver solver = voile::engine::take(voile::Solver::create(queue.context().handles, {}));
    voile::Upload upload;
    const auto record = [&](VkCommandBuffer cmd) { upload = voile::engine::take(solver.record_upload(cmd)); };
    const voile::GridCloth sheet{.columns = 32, .rows = 32};
    (void)voile::engine::take(solver.add_cloth(sheet));
    costs.push_back(time_host(
        "add it cooked", triangles, 1, [] {},
        [&] { (void)voile::engine::take(solver.add_collider({voile::MeshCollider{.cooked = cooked}})); }));
    HostCost first{};
    HostCost later{};
    std::vector<double> clock;
    queue.run(
        [&](VkCommandBuffer cmd)
        {
            first = time_host(
                "record its first upload", triangles, 1, [] {}, [&] { record(cmd); });
        });
    costs.push_back(first);
    std::vector<double> processor;
    for (uint32_t i = 0; i < k_repetitions; ++i)
        queue.run(
            [&](VkCommandBuffer cmd)
            {
                later = time_host(
                    "add 1,024 vertices beside it, record", triangles, 1, [] {},
                    [&]
                    {
                        (void)voile::engine::take(solver.add_cloth(sheet));
                        const voile::Upload before = std::move(upload);
                        record(cmd);
                    });
                clock.push_back(later.clock);
                processor.push_back(later.processor);
            });
    later.clock = quantile(clock, 0.5);
    later.processor = quantile(processor, 0.5);
    costs.push_back(later);
}

} // namespace

std::vector<HostCost> measure_costs(TimedQueue& queue)
{
    std::vector<HostCost> costs;
    for (const uint32_t side : {64u, 128u, 256u})
        measure_cloth(queue.context().handles, side, costs);
    measure_beside(queue, costs);
    return costs;
}

std::span<const AddCase> add_cases()
{
    return k_cases;
}

const AddCase* find_add_case(std::string_view name)
{
    const auto* found =
        std::find_if(std::begin(k_cases), std::end(k_cases), [&](const AddCase& item) { return name == item.name; });
    return found != std::end(k_cases) ? found : nullptr;
}

AddMeasurement measure_add(const voile::engine::Device& device, const AddCase& item)
{
    const voile::engine::Mesh mesh = item.make();
    const voile::MeshCollider collider{.positions = mesh.positions, .triangles = mesh.triangles};
    std::vector<double> built;
    std::vector<double> again;
    for (uint32_t i = 0; i < item.repetitions; ++i)
    {
        voile::set_hierarchy_cache_limit(0);
        voile::set_hierarchy_cache_limit(voile::k_default_hierarchy_cache_limit);
        built.push_back(time_add(device, collider));
        again.push_back(time_add(device, collider));
    }
    voile::set_hierarchy_cache_limit(0); // later measurements are to have the memory
    voile::set_hierarchy_cache_limit(voile::k_default_hierarchy_cache_limit);
    return {mesh.triangles.size(), quantile(built, 0.5), quantile(built, 0), quantile(again, 0.5)};
}

} // namespace bench
