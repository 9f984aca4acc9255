// Characters of capsules in capes.
#include "garments.hpp"

#include "voile/solver.hpp"

#include "voile/fabrics.hpp"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <chrono>
#include <cmath>

namespace bench
{

namespace
{

constexpr uint32_t k_settling_frames = 60;
constexpr uint32_t k_walk_frames = 120;
constexpr uint32_t k_fewer_on_cpu = 10; // times
constexpr float k_spacing = 0.025f;     // m, of the capes

// A capsule of a figure of 1.8 m that stands on the ground, and how it swings about its upper end.
struct Limb
{
    glm::vec3 from; // m, the upper end
    glm::vec3 to;
    float radius; // m
    float swing;  // rad
};

constexpr Limb k_limbs[] = {
    {{0, 1.66f, 0}, {0, 1.72f, 0}, 0.1f, 0},                   // head
    {{0, 1.56f, 0}, {0, 1.5f, 0}, 0.06f, 0},                   // neck
    {{-0.14f, 1.42f, 0}, {0.14f, 1.42f, 0}, 0.08f, 0},         // shoulders
    {{-0.1f, 1.32f, 0}, {0.1f, 1.32f, 0}, 0.11f, 0},           // chest
    {{-0.08f, 1.18f, 0}, {0.08f, 1.18f, 0}, 0.1f, 0},          // ribs
    {{-0.07f, 1.06f, 0}, {0.07f, 1.06f, 0}, 0.09f, 0},         // waist
    {{-0.09f, 0.94f, 0}, {0.09f, 0.94f, 0}, 0.1f, 0},          // hips
    {{-0.1f, 0.92f, -0.03f}, {0.1f, 0.92f, -0.03f}, 0.09f, 0}, // seat
    {{-0.2f, 1.42f, 0}, {-0.23f, 1.14f, 0}, 0.05f, 0.4f},      // arms
    {{0.2f, 1.42f, 0}, {0.23f, 1.14f, 0}, 0.05f, -0.4f},
    {{-0.23f, 1.14f, 0}, {-0.24f, 0.9f, 0.03f}, 0.04f, 0.6f},
    {{0.23f, 1.14f, 0}, {0.24f, 0.9f, 0.03f}, 0.04f, -0.6f},
    {{-0.24f, 0.88f, 0.03f}, {-0.24f, 0.8f, 0.04f}, 0.04f, 0.6f}, // hands
    {{0.24f, 0.88f, 0.03f}, {0.24f, 0.8f, 0.04f}, 0.04f, -0.6f},
    {{-0.1f, 0.9f, 0}, {-0.1f, 0.5f, 0}, 0.08f, -0.5f}, // legs
    {{0.1f, 0.9f, 0}, {0.1f, 0.5f, 0}, 0.08f, 0.5f},
    {{-0.1f, 0.5f, 0}, {-0.1f, 0.1f, 0}, 0.06f, -0.3f},
    {{0.1f, 0.5f, 0}, {0.1f, 0.1f, 0}, 0.06f, 0.3f},
    {{-0.1f, 0.06f, 0}, {-0.1f, 0.06f, 0.16f}, 0.05f, 0}, // feet
    {{0.1f, 0.06f, 0}, {0.1f, 0.06f, 0.16f}, 0.05f, 0},
};

struct Figure
{
    glm::vec3 foot; // m
    float scale = 1;
    float phase = 0; // rad, of its walk
    std::vector<voile::ColliderId> limbs;
    voile::AnchorId neck;
};

struct FigureScene
{
    voile::Solver solver;
    std::vector<Figure> figures;
};

void add_figure(FigureScene& scene, Figure figure, uint32_t side)
{
    for (const Limb& limb : k_limbs)
        figure.limbs.push_back(voile::engine::take(
            scene.solver.add_collider(voile::CapsuleCollider{.from = figure.foot + figure.scale * limb.from,
                                                             .to = figure.foot + figure.scale * limb.to,
                                                             .radius = figure.scale * limb.radius})));
    const float width = k_spacing * static_cast<float>(side - 1);
    voile::GridCloth cape;
    cape.columns = cape.rows = side;
    cape.width = cape.depth = width;
    // Its first row is the upper one, 9 cm behind the neck. The others lean back, and swing onto chest and seat.
    cape.transform = glm::translate(glm::mat4(1), figure.foot + figure.scale * glm::vec3(0, 1.54f, -0.09f)) *
                     glm::rotate(glm::mat4(1), glm::half_pi<float>() + 0.15f, {1, 0, 0}) *
                     glm::translate(glm::mat4(1), {0, 0, width / 2});
    cape.material = voile::cotton();
    cape.integrator = voile::Integrator::verlet;
    const voile::ClothId cloth = voile::engine::take(scene.solver.add_cloth(cape));
    figure.neck = voile::engine::take(scene.solver.add_anchor(glm::mat4(1)));
    std::vector<voile::Attachment> pins;
    for (uint32_t column = side / 4; column < side - side / 4; ++column)
        pins.push_back(voile::pin(column, figure.neck));
    voile::engine::take(scene.solver.set_attachments(cloth, pins));
    scene.figures.push_back(std::move(figure));
}

// FigureScene on a square, farther apart than they walk.
FigureScene make_scene(TimedQueue& queue, uint32_t figures, uint32_t side, float scale, const Settings& settings)
{
    voile::SolverOptions options;
    options.tuning.workgroup_size = settings.workgroup_size;
    FigureScene scene{voile::engine::take(voile::Solver::create(queue.context().handles, options)), {}};
    const auto along = static_cast<uint32_t>(std::lround(std::sqrt(figures)));
    for (uint32_t i = 0; i < figures; ++i)
    {
        const glm::vec3 foot(2 * (i % along), 0, 5 * (i / along));
        add_figure(scene, {.foot = foot, .scale = scale, .phase = static_cast<float>(i), .limbs = {}, .neck = {}},
                   side);
    }
    (void)voile::engine::take(scene.solver.add_collider(voile::PlaneCollider{}));
    voile::Upload kept;
    queue.run([&](VkCommandBuffer cmd) { kept = voile::engine::take(scene.solver.record_upload(cmd)); });
    return scene;
}

// The figures walk to and fro at up to 1.2 m/s, with a step per second.
void walk(FigureScene& scene, uint32_t frame)
{
    const float time = k_frame * static_cast<float>(frame + 1);
    for (const Figure& figure : scene.figures)
    {
        const float stride = std::sin(glm::two_pi<float>() * time + figure.phase) - std::sin(figure.phase);
        const float forward = 0.6f * (std::cos(figure.phase) - std::cos(2 * time + figure.phase));
        const glm::mat4 body = glm::translate(glm::mat4(1), {0, 0, forward});
        for (size_t i = 0; i < std::size(k_limbs); ++i)
        {
            const glm::vec3 joint = figure.foot + figure.scale * k_limbs[i].from;
            const glm::mat4 limb = glm::translate(body, joint) *
                                   glm::rotate(glm::mat4(1), k_limbs[i].swing * stride, {1, 0, 0}) *
                                   glm::translate(glm::mat4(1), -joint);
            voile::engine::take(scene.solver.move_collider(figure.limbs[i], limb));
        }
        voile::engine::take(scene.solver.move_anchor(figure.neck, body));
    }
}

double microseconds_since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

GarmentsMeasurement measure(TimedQueue& queue, uint32_t figures, uint32_t side, float scale, bool moving,
                            const Settings& settings)
{
    FigureScene scene = make_scene(queue, figures, side, scale, settings);
    PassTimes passes(queue);
    const voile::Step step{.duration = k_frame};
    GarmentsMeasurement result{.figures = figures, .side = side, .moving = moving};
    std::vector<double> gpu;
    std::vector<double> moves;
    std::vector<double> records;
    const uint32_t fewer = queue.device().is_cpu() ? k_fewer_on_cpu : 1;
    for (uint32_t frame = 0; frame < (k_settling_frames + k_walk_frames) / fewer; ++frame)
    {
        const auto start = std::chrono::steady_clock::now();
        if (moving)
            walk(scene, frame);
        moves.push_back(microseconds_since(start));
        gpu.push_back(queue.time(
                          [&](VkCommandBuffer cmd)
                          {
                              const auto begin = std::chrono::steady_clock::now();
                              voile::engine::take(scene.solver.record(cmd, step));
                              records.push_back(microseconds_since(begin));
                          }) /
                      1000);
        if (frame + 1 == k_settling_frames / fewer)
            for (std::vector<double>* times : {&gpu, &moves, &records})
                times->clear();
    }
    if (settings.passes)
    {
        queue.run([&](VkCommandBuffer cmd) { passes.record(cmd, scene.solver, step); });
        passes.read();
        passes.print(scene.solver.stable_substeps(k_frame, step.max_substeps));
    }
    queue.run([&](VkCommandBuffer cmd) { voile::engine::take(scene.solver.record_statistics(cmd, 0)); });
    const voile::Statistics state = scene.solver.statistics(0);
    if (state.nan_vertices > 0)
        throw voile::engine::StartupError("garments: a vertex is not finite");
    result.substeps = scene.solver.stable_substeps(k_frame, step.max_substeps);
    result.dispatches = scene.solver.dispatches(step);
    result.gpu = quantile(gpu, 0.5);
    result.gpu_p95 = quantile(gpu, 0.95);
    result.move = quantile(moves, 0.5);
    result.record = quantile(records, 0.5);
    result.contacts = state.contacts;
    result.inside = state.penetrating_vertices;
    return result;
}

} // namespace

std::vector<GarmentsMeasurement> measure_garments(TimedQueue& queue, const Settings& settings)
{
    const bool cpu = queue.device().is_cpu();
    const uint32_t along = cpu ? 2 : 10; // figures
    const auto scale = static_cast<float>(along);
    std::vector<GarmentsMeasurement> rows;
    for (const bool one : {false, true})
        for (const bool moving : {false, true})
            rows.push_back(one ? measure(queue, 1, 32 * along, scale, moving, settings)
                               : measure(queue, along * along, 32, 1, moving, settings));
    return rows;
}

} // namespace bench
