// A component of your own: a ball that swings through a curtain. A component is one class. The scene calls its hooks
// each frame: `update` for the host's work, `record_draw` for each view. With a display this opens a window. Without
// one (--headless [FRAMES]) it simulates a second, writes own_component.png and prints how many vertices of the curtain
// the ball touched.
#include "samples/arguments.hpp"
#include "samples/progress.hpp"

#include "voile/cloth_component.hpp"
#include "voile/fabrics.hpp"

#include "voile/engine/app/app.hpp"
#include "voile/engine/assets/atomic_file.hpp"
#include "voile/engine/assets/shapes.hpp"
#include "voile/engine/render/readback.hpp"
#include "voile/engine/scene/static_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <numbers>

namespace
{

using voile::engine::FrameInfo;

// A sphere on a string of `k_string` m, drawn and simulated at the same pose.
class SwingingBall : public voile::engine::Component
{
public:
    SwingingBall(voile::component::ClothWorld& world, voile::engine::UploadBatch& uploads)
        : world_(world), collider_(world.add_collider(voile::SphereCollider{.center = k_lowest, .radius = k_radius})),
          mesh_(uploads, voile::engine::make_sphere(k_lowest, k_radius - 0.004f),
                voile::engine::Surface{.base_color{0.8f, 0.62f, 0.2f}, .roughness = 0.3f}, "ball")
    {
    }

    // The pose at the end of this frame. The solver moves the collider there at constant velocity.
    void update(const FrameInfo& frame) override
    {
        const double time = frame.time + static_cast<double>(frame.time_step);
        const double angle = 0.9 * std::cos(2 * std::numbers::pi * time / 2.4);
        const auto along = static_cast<float>(std::sin(angle));
        const auto up = static_cast<float>(1 - std::cos(angle));
        glm::mat4 motion(1.f);
        motion[3] = {0, k_string * up, k_string * along, 1};
        voile::engine::take(world_.solver().move_collider(collider_, motion));
        mesh_.set_model(motion);
    }

    void record_draw(VkCommandBuffer cmd, voile::engine::View& view) override { mesh_.record_draw(cmd, view); }

private:
    static constexpr float k_string = 1.5f;
    static constexpr float k_radius = 0.22f;
    static constexpr glm::vec3 k_lowest{0, 0.75f, 0};

    voile::component::ClothWorld& world_;
    voile::ColliderId collider_;
    voile::engine::StaticMesh mesh_;
};

// In x and y, held along its upper edge.
voile::GridCloth curtain()
{
    voile::GridCloth grid{.name = "curtain", .columns = 36, .rows = 32, .width = 1.6f, .depth = 1.4f};
    grid.transform =
        glm::mat4(glm::vec4(1, 0, 0, 0), glm::vec4(0, 0, 1, 0), glm::vec4(0, -1, 0, 0), glm::vec4(0, 1, 0, 1));
    grid.material = voile::silk();
    grid.integrator = voile::Integrator::verlet;
    for (uint32_t column = 0; column < grid.columns; ++column)
        grid.pins.push_back(column);
    return grid;
}

void run(const samples::Arguments& arguments)
{
    samples::Progress progress(arguments.frames);
    voile::engine::App app({.title = "a component of your own", .headless = arguments.headless});
    if (!app.has_window()) // before the simulation: an output that cannot be written is reported at once
        (void)voile::engine::take(voile::engine::AtomicFile::create("own_component.png"));
    voile::engine::Scene& scene = app.scene();
    scene.camera = {.position = {2.6f, 1.5f, 2.2f}, .target = {0, 0.9f, 0.2f}};
    scene.focus = {0, 0.8f, 0};
    scene.focus_radius = 2.5f;

    auto& world = scene.add("cloth").add<voile::component::ClothWorld>(app.device(), app.slots());
    world.collect_statistics = true;
    scene.add("curtain").add<voile::component::Sheet>(
        world, app.uploads(), curtain(),
        voile::component::fabric_surface({0.1f, 0.2f, 0.45f}, {0.5f, 0.5f, 0.6f}, 1.6f));
    scene.add("ball").add<SwingingBall>(world, app.uploads());
    scene.add("ground").add<voile::engine::StaticMesh>(app.uploads(), voile::engine::make_ground(60),
                                                       voile::engine::ground_surface());

    voile::engine::Readback readback(app.device(), app.renderer().extent(), app.slots());
    const voile::engine::IdleGuard idle(app.device());
    uint32_t last_slot = 0;
    uint32_t most_contacts = 0;
    app.draws = [frames = arguments.frames](const FrameInfo& frame) { return frame.index + 1 == frames; };
    app.after_render = [&](VkCommandBuffer cmd, const FrameInfo& frame)
    {
        if (!app.has_window() && app.draws(frame))
            readback.record(cmd, app.renderer().color(), last_slot = frame.slot);
    };
    app.completed = [&](const FrameInfo& frame)
    {
        most_contacts = std::max(most_contacts, world.solver().statistics(frame.slot).contacts);
        if (!app.has_window())
            progress.update(frame.index + 1);
    };
    app.run(arguments.frames);
    if (app.has_window())
        return;
    voile::engine::take(voile::engine::save_png("own_component.png", readback.picture(last_slot)));
    std::printf("wrote own_component.png\n");
    std::printf("at most %u vertices touched\n", most_contacts);
}

} // namespace

int main(int argc, char** argv)
{
    try
    {
        if (const auto arguments = samples::parse_arguments("own_component", argc, argv))
            run(*arguments);
        return 0;
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "own_component: %s\n", error.what());
        return 1;
    }
}
