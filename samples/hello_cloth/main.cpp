// The shortest complete program: a cloth falls on a sphere. With a display it opens a window. Without one
// (--headless [FRAMES]) it simulates one second and writes hello_cloth.png.
#include "samples/arguments.hpp"
#include "samples/progress.hpp"

#include "voile/cloth_component.hpp"

#include "voile/engine/app/app.hpp"
#include "voile/engine/assets/atomic_file.hpp"
#include "voile/engine/assets/shapes.hpp"
#include "voile/engine/render/readback.hpp"
#include "voile/engine/scene/static_mesh.hpp"

#include <cstdio>
#include <exception>

namespace
{

void run(const samples::Arguments& arguments)
{
    samples::Progress progress(arguments.frames);
    voile::engine::App app({.title = "hello cloth", .headless = arguments.headless});
    if (!app.has_window()) // before the simulation: an output that cannot be written is reported at once
        (void)voile::engine::take(voile::engine::AtomicFile::create("hello_cloth.png"));
    voile::engine::Scene& scene = app.scene();
    scene.camera = {.position = {1.6f, 1.7f, 2.6f}, .target = {0, 0.55f, 0}};
    scene.focus = {0, 0.5f, 0};
    scene.focus_radius = 2;

    // The world owns the solver. Colliders are added to the world, and sheets of cloth live in it.
    auto& world = scene.add("cloth").add<voile::component::ClothWorld>(app.device(), app.slots());
    world.add_collider(voile::SphereCollider{.center = {0, 0.5f, 0}, .radius = 0.5f});
    world.add_collider(voile::PlaneCollider{});

    voile::GridCloth sheet{.name = "sheet", .width = 2, .depth = 2};
    sheet.transform[3] = {0, 1.2f, 0, 1};
    scene.add("sheet").add<voile::component::Sheet>(
        world, app.uploads(), sheet, voile::component::fabric_surface({0.55f, 0.05f, 0.08f}, {0.6f, 0.5f, 0.35f}, 2));

    scene.add("sphere").add<voile::engine::StaticMesh>(app.uploads(), voile::engine::make_sphere({0, 0.5f, 0}, 0.495f),
                                                       voile::engine::Surface{.base_color{0.75f, 0.72f, 0.65f}});
    scene.add("ground").add<voile::engine::StaticMesh>(app.uploads(), voile::engine::make_ground(60),
                                                       voile::engine::ground_surface());

    voile::engine::Readback readback(app.device(), app.renderer().extent(), app.slots());
    const voile::engine::IdleGuard idle(app.device());
    uint32_t last_slot = 0;
    app.draws = [&](const voile::engine::FrameInfo& frame) { return frame.index + 1 == arguments.frames; };
    app.after_render = [&](VkCommandBuffer cmd, const voile::engine::FrameInfo& frame)
    {
        if (!app.has_window() && app.draws(frame))
            readback.record(cmd, app.renderer().color(), last_slot = frame.slot);
    };
    app.completed = [&](const voile::engine::FrameInfo& frame)
    {
        if (!app.has_window())
            progress.update(frame.index + 1);
    };
    app.run(arguments.frames);
    if (app.has_window())
        return;
    voile::engine::take(voile::engine::save_png("hello_cloth.png", readback.picture(last_slot)));
    std::printf("wrote hello_cloth.png\n");
}

} // namespace

int main(int argc, char** argv)
{
    try
    {
        if (const auto arguments = samples::parse_arguments("hello_cloth", argc, argv))
            run(*arguments);
        return 0;
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "hello_cloth: %s\n", error.what());
        return 1;
    }
}
