// Building the scene.
#include "samples/viewer/stage.hpp"

#include "samples/viewer/cloths.hpp"

#include "engine/assets/shapes.hpp"
#include "engine/scene/static_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace viewer
{
namespace
{

struct Colors
{
    glm::vec3 front;
    glm::vec3 back;
};

// Linear; cloths take them in turn.
constexpr std::array<Colors, 4> k_fabrics{{
    {{0.50f, 0.04f, 0.07f}, {0.42f, 0.30f, 0.16f}},
    {{0.05f, 0.16f, 0.38f}, {0.40f, 0.36f, 0.28f}},
    {{0.06f, 0.28f, 0.17f}, {0.42f, 0.34f, 0.20f}},
    {{0.50f, 0.26f, 0.04f}, {0.30f, 0.10f, 0.12f}},
}};

engine::Surface solid_surface()
{
    engine::Surface surface;
    surface.base_color = {0.66f, 0.60f, 0.50f};
    surface.roughness = 0.45f;
    return surface;
}

std::optional<cloth::Friction> friction(const Solid& solid)
{
    if (!solid.friction)
        return std::nullopt;
    return cloth::Friction{solid.friction->static_friction, solid.friction->kinetic_friction};
}

gpu::Result<cloth::ColliderId> add_to_solver(cloth::Solver& solver, const Solid& solid)
{
    if (const auto* plane = std::get_if<PlaneShape>(&solid.shape))
        return solver.add_collider(
            cloth::PlaneCollider{.name = solid.name, .offset = plane->y, .friction = friction(solid)});
    if (const auto* sphere = std::get_if<SphereShape>(&solid.shape))
        return solver.add_collider(cloth::SphereCollider{
            .name = solid.name, .center = sphere->center, .radius = sphere->radius, .friction = friction(solid)});
    const auto& mesh = std::get<engine::Mesh>(solid.shape);
    return solver.add_collider(cloth::MeshCollider{.name = solid.name,
                                                   .positions = mesh.positions,
                                                   .triangles = mesh.triangles,
                                                   .transform = solid.transform,
                                                   .friction = friction(solid)});
}

void add_to_scene(engine::App& app, const Solid& solid, float extent)
{
    engine::Entity& entity = app.scene().add(solid.name);
    if (const auto* plane = std::get_if<PlaneShape>(&solid.shape))
        entity.add<engine::StaticMesh>(app.uploads(), engine::make_ground(30 * extent, plane->y),
                                       engine::ground_surface(), solid.name);
    else if (const auto* sphere = std::get_if<SphereShape>(&solid.shape))
        entity.add<engine::StaticMesh>(app.uploads(), engine::make_sphere(sphere->center, sphere->radius),
                                       solid_surface(), solid.name);
    else
        entity.add<engine::StaticMesh>(app.uploads(), std::get<engine::Mesh>(solid.shape),
                                       solid.is_ground() ? engine::ground_surface() : solid_surface(), solid.name,
                                       solid.transform);
}

// What the camera looks at and the shadow map covers: cloths, solids above ground, and the ground below them.
engine::Bounds bounds_of(const std::vector<glm::vec3>& places)
{
    engine::Bounds box{places.front(), places.front()};
    for (const glm::vec3& p : places)
    {
        box.min = glm::min(box.min, p);
        box.max = glm::max(box.max, p);
    }
    return box;
}

engine::Bounds stage_bounds(const std::vector<StageCloth>& cloths, const std::vector<Solid>& solids)
{
    std::optional<engine::Bounds> box;
    for (const StageCloth& cloth : cloths)
        box = merge(box, bounds_of(cloth.start));
    for (const Solid& solid : solids)
    {
        if (const auto* plane = std::get_if<PlaneShape>(&solid.shape))
            box->min.y = std::min(box->min.y, plane->y);
        else if (solid.is_ground())
            box->min.y = std::min(box->min.y, solid.bounds()->min.y);
        else
            box = merge(box, *solid.bounds());
    }
    return *box;
}

void frame_scene(engine::Scene& scene, const SceneFile& file, const engine::Bounds& box)
{
    scene.focus = 0.5f * (box.min + box.max);
    scene.focus_radius = std::max(0.5f * glm::distance(box.min, box.max), 1e-3f);
    if (file.camera)
    {
        scene.camera = {file.camera->position, file.camera->target, file.camera->fov};
        return;
    }
    const float distance = 1.05f * scene.focus_radius / std::sin(glm::radians(0.5f * scene.camera.fov));
    scene.camera.target = scene.focus;
    scene.camera.position = scene.focus + distance * glm::normalize(glm::vec3(0.45f, 0.4f, 1));
}

// Tells of cloths that the substeps are too few for: they stretch more than their material says.
void tell_softened(const Stage& stage, float duration)
{
    cloth::Step step = stage.world->step;
    step.duration = duration;
    for (const StageCloth& cloth : stage.cloths)
    {
        const cloth::Stability stability = stage.world->solver().stability(cloth.id, step);
        if (stability.stiffness_share < 1)
            std::fprintf(stderr,
                         "viewer: note: cloth \"%s\" needs %u substeps a frame and gets %u: it has %.2g %% of its "
                         "stiffness\n",
                         cloth.name.c_str(), stability.needed, stability.used,
                         100 * static_cast<double>(stability.stiffness_share));
    }
}

} // namespace

void advance(Stage& stage, double time, double duration)
{
    for (const MovingPin& pin : stage.moving_pins)
        engine::take(stage.world->solver().move_anchor(pin.anchor, matrix(pin.motion, time + duration)));
}

gpu::Result<Stage> set_stage(engine::App& app, const SceneFile& scene, const std::vector<Solid>& solids,
                             const Options& options)
{
    Stage stage;
    auto& world = app.scene().add("cloth").add<cloth::component::ClothWorld>(app.device(), app.slots());
    stage.world = &world;
    world.step.gravity = scene.gravity;
    world.step.wind = scene.wind.velocity;
    world.step.gust = scene.wind.gust;
    world.step.gust_length = scene.wind.gust_length;
    world.step.substeps = scene.step.substeps.value_or(0);
    world.collect_statistics = true;
    for (const ClothEntry& entry : scene.cloths)
    {
        auto added = add_cloth(world.solver(), scene, entry, options);
        if (!added)
            return added.error();
        stage.moving_pins.insert(stage.moving_pins.end(), added.value().moving_pins.begin(),
                                 added.value().moving_pins.end());
        stage.cloths.push_back({entry.name, added.value().id, std::move(added.value().start)});
    }
    const engine::Bounds box = stage_bounds(stage.cloths, solids);
    frame_scene(app.scene(), scene, box);
    for (size_t i = 0; i < stage.cloths.size(); ++i)
    {
        const StageCloth& cloth = stage.cloths[i];
        const Colors& colors = k_fabrics[i % k_fabrics.size()];
        const engine::Bounds extent = bounds_of(cloth.start);
        const glm::vec3 size = extent.max - extent.min;
        app.scene()
            .add(cloth.name)
            .add<cloth::component::Sheet>(
                world, app.uploads(), cloth.id,
                cloth::component::fabric_surface(colors.front, colors.back, std::max({size.x, size.y, size.z, 1e-3f})));
    }
    for (const Solid& solid : solids)
    {
        if (const auto added = add_to_solver(world.solver(), solid); !added)
            return gpu::Error{added.error().message};
        add_to_scene(app, solid, glm::distance(box.min, box.max));
    }
    tell_softened(stage, 1 / scene.step.rate);
    return stage;
}

} // namespace viewer
