// Adding cloths, adding cooked data, and small changes beside much else.
#include "host_costs.hpp"

#include "height_field.hpp"

#include "voile/cooked.hpp"
#include "voile/engine/assets/shapes.hpp"
#include "voile/solver.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <functional>
#include <memory>
#include <optional>

namespace bench
{

namespace
{

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
    return make_height_field(side, [](uint32_t row, uint32_t column)
                             { return 0.002f * static_cast<float>((row * 37 + column * 71) % 13) / 13; });
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

// A closed mesh of 998,000 triangles, cooked.
voile::CookedCollider cook_ball(std::vector<HostCost>& costs)
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
    return cooked;
}

constexpr size_t k_sheet_vertices = 1024;

// Above the collider: the steps are not what is measured.
voile::GridCloth make_sheet()
{
    voile::GridCloth sheet{.columns = 32, .rows = 32};
    sheet.transform[3].y = 50;
    return sheet;
}

// A solver with that collider and a hundred cloths, to which small changes are made and recorded.
class Crowd
{
public:
    Crowd(TimedQueue& queue, const voile::CookedCollider& ball)
        : queue_(queue), solver_(voile::engine::take(voile::Solver::create(queue.context().handles, {})))
    {
        constexpr uint32_t k_cloths = 100;
        for (uint32_t i = 0; i < k_cloths; ++i)
            (void)voile::engine::take(solver_.add_cloth(make_sheet()));
        (void)voile::engine::take(solver_.add_collider({voile::MeshCollider{.cooked = ball}}));
    }

    voile::Solver& solver() { return solver_; }

    // The work, its upload if it needs one, and a step, recorded; the step runs outside of the times.
    HostCost time(const char* what, const std::function<void()>& work)
    {
        HostCost cost;
        std::optional<voile::Upload> upload;
        queue_.run(
            [&](VkCommandBuffer cmd)
            {
                cost = time_host(
                    what, k_sheet_vertices, 1, [] {},
                    [&]
                    {
                        work();
                        if (solver_.needs_upload())
                            upload.emplace(voile::engine::take(solver_.record_upload(cmd)));
                        voile::engine::take(solver_.record(cmd, {.duration = 1e-4f, .substeps = 1}));
                    });
            });
        return cost;
    }

private:
    TimedQueue& queue_;
    voile::Solver solver_;
};

// The median and the largest.
void add_costs(const char* what, std::span<const HostCost> all, std::vector<HostCost>& costs)
{
    const auto values = [&](double HostCost::*time)
    {
        std::vector<double> result;
        for (const HostCost& cost : all)
            result.push_back(cost.*time);
        return result;
    };
    const std::vector<double> clock = values(&HostCost::clock);
    const std::vector<double> processor = values(&HostCost::processor);
    costs.push_back({what, k_sheet_vertices, quantile(clock, 0.5), quantile(processor, 0.5)});
    costs.push_back({"  the largest of 60", k_sheet_vertices, quantile(clock, 1), quantile(processor, 1)});
}

void measure_crowd(TimedQueue& queue, std::vector<HostCost>& costs)
{
    constexpr uint32_t k_repetitions = 60; // buffers grow once or twice meanwhile
    Crowd crowd(queue, cook_ball(costs));
    costs.push_back(crowd.time("first upload of it beside 100 cloths", [] {}));
    std::vector<HostCost> added;
    std::vector<HostCost> removed;
    std::vector<HostCost> added_colliders;
    std::vector<HostCost> removed_colliders;
    std::vector<voile::ClothId> cloths;
    std::vector<voile::ColliderId> colliders;
    const voile::engine::Mesh rock = voile::engine::make_sphere({5, 0, 0}, 1, 16); // 960 triangles
    const voile::MeshCollider collider{.positions = rock.positions, .triangles = rock.triangles};
    for (uint32_t i = 0; i < k_repetitions; ++i)
        added.push_back(
            crowd.time("", [&] { cloths.push_back(voile::engine::take(crowd.solver().add_cloth(make_sheet()))); }));
    for (const voile::ClothId cloth : cloths)
        removed.push_back(crowd.time("", [&] { voile::engine::take(crowd.solver().remove(cloth)); }));
    for (uint32_t i = 0; i < k_repetitions; ++i)
        added_colliders.push_back(
            crowd.time("", [&] { colliders.push_back(voile::engine::take(crowd.solver().add_collider(collider))); }));
    for (const voile::ColliderId id : colliders)
        removed_colliders.push_back(crowd.time("", [&] { voile::engine::take(crowd.solver().remove(id)); }));
    add_costs("add 1,024 vertices beside both", added, costs);
    add_costs("remove them", removed, costs);
    add_costs("add a collider of 960 triangles", added_colliders, costs);
    add_costs("remove it", removed_colliders, costs);
}

} // namespace

std::vector<HostCost> measure_costs(TimedQueue& queue)
{
    std::vector<HostCost> costs;
    for (const uint32_t side : {64u, 128u, 256u})
        measure_cloth(queue.context().handles, side, costs);
    measure_crowd(queue, costs);
    return costs;
}

} // namespace bench
