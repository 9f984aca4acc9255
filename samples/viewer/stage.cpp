// Building the scene.
#include "samples/viewer/stage.hpp"

#include "samples/viewer/cloths.hpp"
#include "samples/viewer/looks.hpp"
#include "samples/viewer/solid_meshes.hpp"
#include "samples/viewer/step_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace viewer
{
namespace
{

std::optional<voile::Friction> friction(const Solid& solid)
{
    if (!solid.friction)
        return std::nullopt;
    return voile::Friction{solid.friction->static_friction, solid.friction->kinetic_friction};
}

voile::Sidedness sides(const Solid& solid)
{
    if (!solid.sides)
        return voile::Sidedness::automatic;
    return *solid.sides == MeshSides::one ? voile::Sidedness::one_sided : voile::Sidedness::two_sided;
}

voile::PlaneCollider plane_collider(const PlaneShape& plane, const glm::mat4& transform)
{
    voile::PlaneCollider result;
    result.normal = glm::normalize(glm::vec3(transform[1]));
    result.offset = plane.y + glm::dot(result.normal, glm::vec3(transform[3]));
    return result;
}

voile::Collider collider_of(const Solid& solid)
{
    const auto placed = [&](const glm::vec3& p) { return glm::vec3(solid.transform * glm::vec4(p, 1)); };
    if (const auto* plane = std::get_if<PlaneShape>(&solid.shape))
        return plane_collider(*plane, solid.transform);
    if (const auto* sphere = std::get_if<SphereShape>(&solid.shape))
        return voile::SphereCollider{.center = placed(sphere->center), .radius = sphere->radius};
    if (const auto* capsule = std::get_if<CapsuleShape>(&solid.shape))
        return voile::CapsuleCollider{
            .from = placed(capsule->from), .to = placed(capsule->to), .radius = capsule->radius};
    if (const auto* box = std::get_if<BoxShape>(&solid.shape))
        return voile::BoxCollider{.min = box->min, .max = box->max, .transform = solid.transform};
    const auto& mesh = std::get<voile::engine::Mesh>(solid.shape);
    return voile::MeshCollider{.positions = mesh.positions,
                               .triangles = mesh.triangles,
                               .transform = solid.transform,
                               .sidedness = sides(solid),
                               .deforms = solid.frames != nullptr};
}

voile::Result<voile::ColliderId> add_to_solver(voile::Solver& solver, const SceneFile& scene, const Solid& solid)
{
    voile::Collider collider = collider_of(solid);
    std::visit(
        [&](auto& c)
        {
            c.name = solid.name;
            c.friction = friction(solid);
            c.layers = solid.layers;
        },
        collider);
    auto added = solver.add_collider(collider);
    if (!added)
        return solid.location.line > 0 ? error_at(scene, solid.location, added.error().message) : added.error();
    return added;
}

// Draws a solid, and has the motions move it if it does.
void add_to_scene(voile::engine::App& app, const Solid& solid, SolidMeshes& meshes, voile::ColliderId collider,
                  Stage& stage)
{
    const bool ground = solid.is_ground() || std::holds_alternative<PlaneShape>(solid.shape);
    const voile::engine::Surface surface = ground ? voile::engine::ground_surface() : solid_surface(solid.look);
    const size_t index = stage.colliders.size();
    voile::engine::Entity& entity = app.scene().add(solid.name);
    std::vector<DrawnPart> parts;
    if (solid.frames)
    {
        const auto& mesh = std::get<voile::engine::Mesh>(solid.shape);
        auto& deforming = entity.add<voile::engine::DeformingMesh>(app.uploads(), app.slots(), mesh, surface,
                                                                   solid.name, solid.transform);
        stage.motions->deforming.push_back({.solid = index,
                                            .collider = collider,
                                            .frames = solid.frames,
                                            .body = &deforming,
                                            .positions = mesh.positions,
                                            .placed = solid.transform,
                                            .location = solid.location});
        parts.push_back({&deforming, solid.transform});
    }
    else
        for (const SolidPart& part : meshes.parts(solid))
        {
            auto& mesh = entity.add<voile::engine::StaticMesh>(part.mesh, surface, solid.name, part.placed);
            parts.push_back({&mesh, part.placed});
        }
    if (solid.motion)
        stage.motions->solids.push_back({.solid = index,
                                         .collider = collider,
                                         .motion = *solid.motion,
                                         .parts = std::move(parts),
                                         .location = solid.location});
    stage.colliders.push_back(collider);
}

// The box that the camera shows and the shadow map covers: cloths, solids above ground, and the ground below them.
voile::engine::Bounds bounds_of(const std::vector<glm::vec3>& positions)
{
    voile::engine::Bounds box{positions.front(), positions.front()};
    for (const glm::vec3& p : positions)
    {
        box.min = glm::min(box.min, p);
        box.max = glm::max(box.max, p);
    }
    return box;
}

voile::engine::Bounds stage_bounds(const std::vector<StageCloth>& cloths, const std::vector<Solid>& solids)
{
    std::optional<voile::engine::Bounds> box;
    for (const StageCloth& cloth : cloths)
        box = merge(box, bounds_of(cloth.start));
    for (const Solid& solid : solids)
    {
        if (const auto height = solid.ground_height())
            box->min.y = std::min(box->min.y, *height);
        else if (const auto swept = solid.swept_bounds())
            box = merge(box, *swept);
    }
    return *box;
}

// The distance from the box's middle, in the direction of `view` and looking back, at which all of its corners are in
// the picture.
float viewing_distance(const voile::engine::Bounds& box, const glm::vec3& view, float fov, float aspect)
{
    constexpr float k_filled = 0.92f; // of half the picture
    const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), view));
    const glm::vec3 up = glm::cross(view, right);
    const float tangent = k_filled * std::tan(glm::radians(0.5f * fov));
    float distance = 0;
    for (int corner = 0; corner < 8; ++corner)
    {
        const glm::bvec3 far((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
        const glm::vec3 p = glm::mix(box.min, box.max, far) - 0.5f * (box.min + box.max);
        const float needed =
            std::max(std::abs(glm::dot(p, right)) / (tangent * aspect), std::abs(glm::dot(p, up)) / tangent);
        distance = std::max(distance, glm::dot(p, view) + needed);
    }
    return distance;
}

void frame_scene(voile::engine::Scene& scene, const SceneFile& file, const voile::engine::Bounds& box, float aspect)
{
    scene.focus = 0.5f * (box.min + box.max);
    scene.focus_radius = std::max(0.5f * glm::distance(box.min, box.max), 1e-3f);
    if (file.camera)
    {
        scene.camera = {file.camera->position, file.camera->target, file.camera->fov};
        return;
    }
    const glm::vec3 view = glm::normalize(glm::vec3(0.45f, 0.4f, 1));
    const float distance = viewing_distance(box, view, scene.camera.fov, aspect);
    scene.camera.target = scene.focus;
    scene.camera.position = scene.focus + std::max(distance, 1e-3f) * view;
}

} // namespace

voile::Result<Stage> set_stage(voile::engine::App& app, const SceneFile& scene, const std::vector<Solid>& solids,
                               const Options& options)
{
    Stage stage;
    voile::SolverOptions solver_options;
    std::vector<voile::ShaderReplacement> shaders;
    for (const voile::engine::ShaderCode& shader : options.cloth_shaders)
        shaders.push_back({shader.name, shader.spirv});
    solver_options.shaders = shaders;
    solver_options.intersections = options.debug.intersections || options.verify || app.has_window();
    auto& world = app.scene().add("cloth").add<voile::component::ClothWorld>(app.device(), app.slots(), solver_options);
    stage.world = &world;
    apply_step(scene, world.step);
    if (const auto valid = voile::validate(world.step); !valid)
        return step_error(scene, valid.error().message);
    world.collect_statistics = true;
    stage.motions = &app.scene().add("motions").add<Motions>(world.solver(), scene.path);
    for (const ClothEntry& entry : scene.cloths)
    {
        auto added = add_cloth(world.solver(), scene, entry, solids, options);
        if (!added)
            return added.error();
        stage.motions->pins.insert(stage.motions->pins.end(), added.value().moving_pins.begin(),
                                   added.value().moving_pins.end());
        stage.motions->following.insert(stage.motions->following.end(), added.value().following_pins.begin(),
                                        added.value().following_pins.end());
        stage.motions->releases.insert(stage.motions->releases.end(), added.value().released_pins.begin(),
                                       added.value().released_pins.end());
        Surface& surface = added.value().surface;
        stage.cloths.push_back({entry.name, added.value().id, std::move(surface.positions), entry.layers,
                                std::move(surface.faces), std::move(surface.texture_coordinates)});
    }
    const voile::engine::Bounds box = stage_bounds(stage.cloths, solids);
    frame_scene(app.scene(), scene, box, static_cast<float>(options.width) / static_cast<float>(options.height));
    for (size_t i = 0; i < stage.cloths.size(); ++i)
    {
        StageCloth& cloth = stage.cloths[i];
        const voile::engine::Bounds extent = bounds_of(cloth.start);
        const glm::vec3 size = extent.max - extent.min;
        cloth.size = std::max({size.x, size.y, size.z, 1e-3f});
        cloth.sheet = &app.scene()
                           .add(cloth.name)
                           .add<voile::component::Sheet>(world, app.uploads(), cloth.id,
                                                         cloth_surface(scene.cloths[i], i, cloth.size));
    }
    SolidMeshes meshes(app.uploads(), glm::distance(box.min, box.max));
    for (const Solid& solid : solids)
    {
        const auto added = add_to_solver(world.solver(), scene, solid);
        if (!added)
            return added.error();
        add_to_scene(app, solid, meshes, added.value(), stage);
    }
    return stage;
}

} // namespace viewer
