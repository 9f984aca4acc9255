// A soft sheet beside a stiff one.
#include "levels.hpp"

#include "sheets.hpp"

namespace bench
{

namespace
{

struct Pair
{
    voile::Solver solver;
    voile::ClothId stiff;
    voile::ClothId soft;
};

// Both fall freely, far above a plane.
Pair make_pair(TimedQueue& queue, uint32_t side, float stiffness, uint32_t dispatch_vertices)
{
    voile::SolverOptions options;
    options.tuning.dispatch_vertices = dispatch_vertices;
    Pair pair{voile::engine::take(voile::Solver::create(queue.context().handles, options)), {}, {}};
    voile::GridCloth soft = drape_grid(side);
    soft.width = soft.depth = 0.02f * static_cast<float>(side - 1);
    soft.integrator = voile::Integrator::verlet;
    pair.soft = voile::engine::take(pair.solver.add_cloth(soft));
    voile::GridCloth stiff = soft;
    stiff.columns = stiff.rows = 32;
    stiff.width = stiff.depth = 0.02f * 31;
    stiff.transform[3].x = 100;
    auto& fabric = std::get<voile::Fabric>(stiff.material);
    for (float& value : fabric.stretch_stiffness)
        value *= stiffness;
    pair.stiff = voile::engine::take(pair.solver.add_cloth(stiff));
    (void)voile::engine::take(pair.solver.add_collider(voile::PlaneCollider{.offset = -1e5f}));
    voile::Upload kept;
    queue.run([&](VkCommandBuffer cmd) { kept = voile::engine::take(pair.solver.record_upload(cmd)); });
    return pair;
}

// Milliseconds.
double time_frame(TimedQueue& queue, voile::Solver& solver, const voile::Step& step, uint32_t repetitions)
{
    const auto record = [&](VkCommandBuffer cmd) { voile::engine::take(solver.record(cmd, step)); };
    std::vector<double> times;
    (void)queue.time(record); // warms up
    for (uint32_t i = 0; i < repetitions; ++i)
        times.push_back(queue.time(record, record) / 1000);
    return quantile(times, 0.5);
}

LevelsMeasurement measure_pair(TimedQueue& queue, uint32_t side, float stiffness, uint32_t repetitions)
{
    constexpr uint32_t k_always = 1;
    const voile::Step step{.duration = k_frame};
    LevelsMeasurement result{.side = side};
    Pair own = make_pair(queue, side, stiffness, k_always);
    result.stiff_substeps = own.solver.stability(own.stiff, step).needed;
    result.soft_substeps = own.solver.stability(own.soft, step).needed;
    result.two_levels = time_frame(queue, own.solver, step, repetitions);
    Pair chosen = make_pair(queue, side, stiffness, voile::Tuning{}.dispatch_vertices);
    result.by_default = time_frame(queue, chosen.solver, step, repetitions);
    voile::Step uniform = step;
    uniform.substeps = chosen.solver.stable_substeps(k_frame);
    result.one_level = time_frame(queue, chosen.solver, uniform, repetitions);
    return result;
}

} // namespace

std::vector<LevelsMeasurement> measure_levels(TimedQueue& queue, uint32_t repetitions)
{
    const uint32_t largest = queue.device().is_cpu() ? 128 : 512;
    std::vector<LevelsMeasurement> results;
    for (const float stiffness : {4.f, 36.f, 300.f})
        for (uint32_t side = 32; side <= largest; side *= 2)
            results.push_back(measure_pair(queue, side, stiffness, repetitions));
    return results;
}

} // namespace bench
