// The drape scene: timed frame by frame, its conditions checked on the host.
#include "drape.hpp"

#include "heart.hpp"
#include "sheets.hpp"

#include "voile/engine/gpu/download.hpp"
#include "voile/fabrics.hpp"
#include "voile/mesh_checks.hpp"

#include <algorithm>
#include <cmath>

namespace bench
{

namespace
{

constexpr uint32_t k_frames = 90;
constexpr uint32_t k_first_timed = 30;

constexpr auto k_rk4 = voile::Integrator::rk4;
constexpr auto k_verlet = voile::Integrator::verlet;
constexpr auto k_cotton = DrapeSubject::cotton;
constexpr auto k_pinned = DrapeSubject::pinned_cotton;
constexpr auto k_pinned_mesh = DrapeSubject::pinned_mesh;
constexpr DrapeCase k_drapes[] = {
    {"drape-128-rk4", 128, k_rk4},
    {"drape-128-verlet", 128, k_verlet},
    {"drape-256-rk4", 256, k_rk4},
    {"drape-256-verlet", 256, k_verlet},
    {"drape-512-rk4", 512, k_rk4},
    {"drape-512-verlet", 512, k_verlet},
    {"drape-128-self", 128, k_verlet, true},
    {"drape-256-self", 256, k_verlet, true},
    {"drape-512-self", 512, k_verlet, true},
    {"budget-64", 64, k_verlet, false, k_pinned, 16},
    {"budget-128", 128, k_verlet, false, k_pinned, 16},
    {"budget-64-mesh", 64, k_verlet, false, k_pinned_mesh, 16},
    {"budget-128-mesh", 128, k_verlet, false, k_pinned_mesh, 16},
    {"budget-64-drape", 64, k_verlet, false, k_cotton, 16},
    {"budget-128-drape", 128, k_verlet, false, k_cotton, 16},
    {"budget-128-sheet", 128, k_verlet, false, DrapeSubject::sheet, 16},
};

using Positions = std::vector<glm::vec4>;

std::vector<double> structural_stretches(const Positions& x, uint32_t side, float size)
{
    const double rest = static_cast<double>(size) / (side - 1);
    std::vector<double> result;
    result.reserve(2 * x.size());
    const auto add = [&](size_t a, size_t b)
    { result.push_back(glm::distance(glm::dvec3(x[a]), glm::dvec3(x[b])) / rest - 1); };
    for (uint32_t row = 0; row < side; ++row)
        for (uint32_t column = 0; column < side; ++column)
        {
            const size_t i = size_t{row} * side + column;
            if (column + 1 < side)
                add(i, i + 1);
            if (row + 1 < side)
                add(i, i + side);
        }
    return result;
}

double mean_height(const Positions& x)
{
    double sum = 0;
    for (const glm::vec4& p : x)
        sum += static_cast<double>(p.y);
    return sum / static_cast<double>(x.size());
}

double fraction_deeper(const Positions& x, const voile::MeshCollider& heart, double depth)
{
    const voile::MeshDistance distance = voile::engine::take(voile::MeshDistance::create(heart));
    size_t deep = 0;
    for (const glm::vec4& p : x)
        deep += distance.nearest(glm::dvec3(p)).signed_distance < -depth ? 1 : 0;
    return static_cast<double>(deep) / static_cast<double>(x.size());
}

void upload(TimedQueue& queue, voile::Solver& solver)
{
    voile::Upload kept;
    queue.run([&](VkCommandBuffer cmd) { kept = voile::engine::take(solver.record_upload(cmd)); });
}

bool hangs(DrapeSubject subject)
{
    return subject == DrapeSubject::pinned_cotton || subject == DrapeSubject::pinned_mesh;
}

voile::GridCloth cloth_of(const DrapeCase& item)
{
    voile::GridCloth grid = drape_grid(item.side);
    grid.integrator = item.integrator;
    grid.self_collision = item.self_collision;
    if (item.subject == DrapeSubject::sheet)
        return grid;
    grid.width = grid.depth = 1;
    grid.material = voile::cotton();
    if (hangs(item.subject))
        grid.pins = {0, item.side - 1};
    return grid;
}

struct DrapeScene
{
    voile::Solver solver;
    voile::ClothId cloth;
};

DrapeScene make_scene(TimedQueue& queue, const DrapeCase& item, const voile::MeshCollider& heart,
                      uint32_t workgroup_size)
{
    voile::SolverOptions options;
    options.tuning.workgroup_size = workgroup_size;
    DrapeScene scene{voile::engine::take(voile::Solver::create(queue.context().handles, options)), {}};
    const voile::GridCloth grid = cloth_of(item);
    scene.cloth = item.subject == DrapeSubject::pinned_mesh
                      ? add_as_mesh(scene.solver, grid, false, voile::BendingModel::springs)
                      : voile::engine::take(scene.solver.add_cloth(grid));
    if (!hangs(item.subject))
    {
        (void)voile::engine::take(scene.solver.add_collider(heart));
        (void)voile::engine::take(scene.solver.add_collider(voile::PlaneCollider{.offset = -0.4f}));
    }
    upload(queue, scene.solver);
    return scene;
}

} // namespace

const char* describe(DrapeSubject subject)
{
    switch (subject)
    {
    case DrapeSubject::cotton:
        return "1 m of cotton in the drape scene";
    case DrapeSubject::pinned_cotton:
        return "1 m of cotton hanging from two corners";
    case DrapeSubject::pinned_mesh:
        return "1 m of cotton as a mesh, hanging from two corners";
    default:
        return "the drape scene";
    }
}

std::span<const DrapeCase> drape_cases()
{
    return k_drapes;
}

const DrapeCase* find_drape_case(std::string_view name)
{
    const auto found = std::find_if(std::begin(k_drapes), std::end(k_drapes),
                                    [&](const DrapeCase& item) { return name == item.name; });
    return found == std::end(k_drapes) ? nullptr : &*found;
}

DrapeMeasurement measure_drape(TimedQueue& queue, const DrapeCase& item, const Settings& settings)
{
    const voile::engine::Mesh mesh = scenes::make_drape_heart();
    const voile::MeshCollider heart{.name = "heart", .positions = mesh.positions, .triangles = mesh.triangles};
    DrapeScene scene = make_scene(queue, item, heart, settings.workgroup_size);
    DrapeScene other = make_scene(queue, item, heart, settings.workgroup_size);
    voile::Solver& solver = scene.solver;

    const voile::Step step{.duration = k_frame, .max_substeps = item.max_substeps};
    const float size = cloth_of(item).width;
    DrapeMeasurement result;
    result.vertices = solver.vertex_count();
    result.triangles = solver.triangle_count();
    result.substeps = solver.stable_substeps(k_frame, step.max_substeps);
    result.dispatches = solver.dispatches(step);
    result.has_budget = solver.stability(scene.cloth, step).needed > result.substeps;
    PassTimes passes(queue);
    std::vector<double> times; // ms
    Positions x;
    for (uint32_t frame = 0; frame < k_frames; ++frame)
    {
        // The host reads the state between frames, and the device lowers its clocks while it waits. The frame first
        // runs unmeasured in a second scene, whose passes are timed on request, so that it is measured as in a
        // continuous run.
        const auto warm_up = [&](VkCommandBuffer cmd)
        {
            if (settings.passes)
                passes.record(cmd, other.solver, step);
            else
                voile::engine::take(other.solver.record(cmd, step));
        };
        const double time =
            queue.time([&](VkCommandBuffer cmd) { voile::engine::take(solver.record(cmd, step)); }, warm_up) / 1000;
        if (frame >= k_first_timed)
        {
            times.push_back(time);
            if (settings.passes)
                passes.read();
        }
        const voile::VertexStreams streams = solver.vertices(scene.cloth);
        x = voile::engine::download_values<glm::vec4>(queue.device(), streams.positions, streams.offset,
                                                      streams.vertices);
        result.stretch_99 = std::max(result.stretch_99, quantile(structural_stretches(x, item.side, size), 0.99));
        if (frame + 1 == k_first_timed)
            result.height = mean_height(x);
    }
    if (settings.passes)
        passes.print(result.substeps);
    const std::vector<double> stretches = structural_stretches(x, item.side, size);
    result.last_stretch = *std::max_element(stretches.begin(), stretches.end());
    if (!hangs(item.subject))
        result.deep_fraction = fraction_deeper(x, heart, 0.005);
    result.gpu_median = quantile(times, 0.5);
    result.gpu_p95 = quantile(times, 0.95);
    return result;
}

} // namespace bench
