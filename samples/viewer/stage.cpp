// Building the scene.
#include "samples/viewer/stage.hpp"

#include "samples/viewer/materials.hpp"

#include "engine/assets/shapes.hpp"
#include "engine/scene/static_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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

uint32_t corner_vertex(const cloth::Grid& grid, uint32_t corner)
{
    const uint32_t row = corner < 2 ? 0 : grid.rows - 1;
    const uint32_t column = corner % 2 == 0 ? 0 : grid.columns - 1;
    return row * grid.columns + column;
}

void hold_edge(const cloth::Grid& grid, Edge edge, std::vector<uint32_t>& held)
{
    const bool along_row = edge == Edge::top || edge == Edge::bottom;
    const uint32_t count = along_row ? grid.columns : grid.rows;
    const uint32_t line = edge == Edge::bottom ? grid.rows - 1 : edge == Edge::right ? grid.columns - 1 : 0;
    for (uint32_t i = 0; i < count; ++i)
        held.push_back(along_row ? line * grid.columns + i : i * grid.columns + line);
}

void hold_box(const cloth::Grid& grid, const BoxPin& box, std::vector<uint32_t>& held)
{
    for (uint32_t row = 0; row < grid.rows; ++row)
        for (uint32_t column = 0; column < grid.columns; ++column)
        {
            const glm::vec3 p = grid_point(grid, row, column);
            if (glm::all(glm::greaterThanEqual(p, box.min)) && glm::all(glm::lessThanEqual(p, box.max)))
                held.push_back(row * grid.columns + column);
        }
}

void hold(const cloth::Grid& grid, const PinEntry& pin, std::vector<uint32_t>& held)
{
    if (const auto* corner = std::get_if<CornerPin>(&pin.at))
        held.push_back(corner_vertex(grid, corner->corner));
    else if (const auto* edge = std::get_if<EdgePin>(&pin.at))
        hold_edge(grid, edge->edge, held);
    else if (const auto* vertex = std::get_if<VertexPin>(&pin.at))
        held.push_back(vertex->vertex);
    else
        hold_box(grid, std::get<BoxPin>(pin.at), held);
}

gpu::Result<cloth::Grid> make_grid(const SceneFile& scene, const ClothEntry& entry, const Options& options)
{
    const auto unsupported = [&](uint32_t line, const std::string& what)
    { return gpu::Error{place(scene, line) + ": cloth \"" + entry.name + "\": " + what + " is not supported yet"}; };
    const auto* form = std::get_if<GridEntry>(&entry.form);
    if (form == nullptr)
        return unsupported(entry.line, "a cloth from a mesh file");
    if (entry.integrator != Integrator::rk4)
        return unsupported(entry.line, "the integrator \"verlet\"");
    cloth::Grid grid;
    grid.name = entry.name;
    grid.columns = options.cloth_resolution.value_or(form->columns);
    grid.rows = options.cloth_resolution.value_or(form->rows);
    grid.width = form->size.x;
    grid.depth = form->size.y;
    grid.transform = matrix(entry.transform);
    grid.velocity = entry.velocity;
    const glm::vec2 spacing(grid.width / static_cast<float>(grid.columns - 1),
                            grid.depth / static_cast<float>(grid.rows - 1));
    auto material = make_grid_material(scene, entry.material, spacing);
    if (!material)
        return material.error();
    grid.material = material.value();
    for (const PinEntry& pin : entry.pins)
    {
        if (pin.motion)
            return unsupported(pin.line, "a pin's \"motion\"");
        hold(grid, pin, grid.held);
    }
    return grid;
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
engine::Bounds stage_bounds(const SceneFile& scene, const std::vector<Solid>& solids)
{
    std::optional<engine::Bounds> box;
    for (const ClothEntry& cloth : scene.cloths)
        box = merge(box, grid_bounds(cloth));
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

} // namespace

glm::vec3 grid_point(const cloth::Grid& grid, uint32_t row, uint32_t column)
{
    const float x = (static_cast<float>(column) / static_cast<float>(grid.columns - 1) - 0.5f) * grid.width;
    const float z = (static_cast<float>(row) / static_cast<float>(grid.rows - 1) - 0.5f) * grid.depth;
    return grid.transform * glm::vec4(x, 0, z, 1);
}

glm::vec3 wind_at(const WindEntry& wind, double time)
{
    // Two sines whose periods have no small common multiple.
    const double gust =
        0.6 * std::sin(2 * 3.14159265358979 * 0.31 * time) + 0.4 * std::sin(2 * 3.14159265358979 * 0.83 * time + 1.7);
    return wind.velocity * static_cast<float>(1 + static_cast<double>(wind.gust) * gust);
}

gpu::Result<Stage> set_stage(engine::App& app, const SceneFile& scene, const std::vector<Solid>& solids,
                             const Options& options)
{
    Stage stage;
    stage.wind = scene.wind;
    auto& world = app.scene().add("cloth").add<cloth::component::ClothWorld>(app.device(), app.slots());
    stage.world = &world;
    world.step.gravity = scene.gravity;
    world.step.substeps = scene.step.substeps.value_or(0);
    world.collect_statistics = true;
    const engine::Bounds box = stage_bounds(scene, solids);
    frame_scene(app.scene(), scene, box);

    for (const ClothEntry& entry : scene.cloths)
    {
        auto grid = make_grid(scene, entry, options);
        if (!grid)
            return grid.error();
        const Colors& colors = k_fabrics[stage.cloths.size() % k_fabrics.size()];
        const float size = std::max(grid.value().width, grid.value().depth);
        const auto added = world.solver().add_cloth(grid.value());
        if (!added)
            return gpu::Error{place(scene, entry.line) + ": " + added.error().message};
        app.scene()
            .add(entry.name)
            .add<cloth::component::Sheet>(world, app.uploads(), added.value(),
                                          cloth::component::fabric_surface(colors.front, colors.back, size));
        stage.cloths.push_back({entry.name, added.value(), std::move(grid.value())});
    }
    for (const Solid& solid : solids)
    {
        if (const auto added = add_to_solver(world.solver(), solid); !added)
            return gpu::Error{added.error().message};
        add_to_scene(app, solid, glm::distance(box.min, box.max));
    }
    return stage;
}

} // namespace viewer
