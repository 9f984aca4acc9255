// Cloth over meshes from files: timed frame by frame.
#include "real_mesh.hpp"

#include "voile/engine/assets/obj.hpp"
#include "voile/fabrics.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>

namespace bench
{

namespace
{

constexpr uint32_t k_fall_frames = 240;
constexpr uint32_t k_side = 128; // vertices along each side
constexpr uint32_t k_side_on_cpu = 64;
constexpr uint32_t k_frames_per_count = 10; // of intersections
constexpr float k_width = 1.6f;             // m, of the cloth
constexpr float k_gap = 0.05f;              // m, between mesh and cloth at the start

struct MeshScene
{
    voile::Solver solver;
    voile::ColliderId mesh;
};

// Into a cube of 1 m that stands on the ground.
voile::engine::Mesh load_fitted(const std::filesystem::path& file)
{
    voile::engine::Mesh mesh =
        voile::engine::take(voile::engine::load_obj(file, nullptr, voile::engine::MeshVertices::positions));
    const voile::engine::Bounds box = voile::engine::bounds(mesh);
    const glm::vec3 size = box.max - box.min;
    const float scale = 1 / std::max({size.x, size.y, size.z});
    const glm::vec3 foot(0.5f * (box.min.x + box.max.x), box.min.y, 0.5f * (box.min.z + box.max.z));
    for (glm::vec3& p : mesh.positions)
        p = scale * (p - foot);
    return mesh;
}

MeshScene make_scene(TimedQueue& queue, const voile::engine::Mesh& mesh, bool self_collision, const Settings& settings)
{
    voile::SolverOptions options;
    options.tuning.workgroup_size = settings.workgroup_size;
    options.intersections = true;
    MeshScene scene{voile::engine::take(voile::Solver::create(queue.context().handles, options)), {}};
    const uint32_t side = queue.device().is_cpu() ? k_side_on_cpu : k_side;
    voile::GridCloth grid;
    grid.columns = grid.rows = side;
    grid.width = grid.depth = k_width;
    grid.transform[3] = {0, voile::engine::bounds(mesh).max.y + k_gap, 0, 1};
    grid.material = voile::cotton();
    grid.integrator = voile::Integrator::verlet;
    grid.self_collision = self_collision;
    (void)voile::engine::take(scene.solver.add_cloth(grid));
    scene.mesh = voile::engine::take(
        scene.solver.add_collider(voile::MeshCollider{.positions = mesh.positions, .triangles = mesh.triangles}));
    (void)voile::engine::take(scene.solver.add_collider(voile::PlaneCollider{}));
    voile::Upload kept;
    queue.run([&](VkCommandBuffer cmd) { kept = voile::engine::take(scene.solver.record_upload(cmd)); });
    return scene;
}

// The mesh's pose at the end of a frame: 90 degrees per second about the vertical.
void turn(MeshScene& scene, uint32_t frame)
{
    const float angle = glm::radians(90.f) * k_frame * static_cast<float>(frame + 1);
    voile::engine::take(scene.solver.move_collider(scene.mesh, glm::rotate(glm::mat4(1), angle, glm::vec3(0, 1, 0))));
}

uint32_t crossings(TimedQueue& queue, const voile::Solver& solver)
{
    queue.run([&](VkCommandBuffer cmd)
              { voile::engine::take(solver.record_statistics(cmd, 0, voile::Intersections::counted)); });
    const voile::Statistics state = solver.statistics(0);
    if (state.nan_vertices > 0)
        throw voile::engine::StartupError("a vertex is not finite");
    return state.intersections ? state.intersections->collider_pairs : 0;
}

} // namespace

std::vector<RealCase> real_cases(const std::filesystem::path& folder)
{
    std::error_code error;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
        if (entry.path().extension() == ".obj")
            files.push_back(entry.path());
    if (files.empty())
        throw voile::engine::StartupError(folder.string() + ": no OBJ files");
    std::sort(files.begin(), files.end());
    std::vector<RealCase> cases;
    for (const std::filesystem::path& file : files)
    {
        const std::string name = "real-" + file.stem().string();
        cases.push_back({name, file});
        cases.push_back({name + "-turning", file, true});
        cases.push_back({name + "-self", file, false, true});
    }
    return cases;
}

RealMeasurement measure_real(TimedQueue& queue, const RealCase& item, const Settings& settings)
{
    const voile::engine::Mesh mesh = load_fitted(item.file);
    MeshScene scene = make_scene(queue, mesh, item.self_collision, settings);
    MeshScene other = make_scene(queue, mesh, item.self_collision, settings);
    const voile::Step step{.duration = k_frame};
    RealMeasurement result;
    result.vertices = scene.solver.vertex_count();
    result.triangles = static_cast<uint32_t>(mesh.triangles.size());
    result.substeps = scene.solver.stable_substeps(k_frame, step.max_substeps);
    result.dispatches = scene.solver.dispatches(step);
    PassTimes passes(queue);
    std::vector<double> times; // ms
    for (uint32_t frame = 0; frame < k_fall_frames; ++frame)
    {
        if (item.turns)
        {
            turn(scene, frame);
            turn(other, frame);
        }
        // The frame first runs in a second scene, whose passes are timed on request. A GPU does not lower its clocks
        // meanwhile.
        const auto warm_up = [&](VkCommandBuffer cmd)
        {
            if (settings.passes)
                passes.record(cmd, other.solver, step);
            else if (!queue.device().is_cpu())
                voile::engine::take(other.solver.record(cmd, step));
        };
        const auto record = [&](VkCommandBuffer cmd) { voile::engine::take(scene.solver.record(cmd, step)); };
        times.push_back(queue.time(record, warm_up) / 1000);
        if (settings.passes)
            passes.read();
        if (frame % k_frames_per_count == 0 || frame + 1 == k_fall_frames)
        {
            result.last_crossings = crossings(queue, scene.solver);
            result.most_crossings = std::max(result.most_crossings, result.last_crossings);
        }
    }
    if (settings.passes)
        passes.print(result.substeps);
    result.gpu_median = quantile(times, 0.5);
    result.gpu_p95 = quantile(times, 0.95);
    return result;
}

} // namespace bench
