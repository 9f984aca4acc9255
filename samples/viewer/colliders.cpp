// Loading and placing the solids.
#include "samples/viewer/colliders.hpp"

#include "voile/engine/assets/load_mesh.hpp"
#include "voile/gpu/printable.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace viewer
{
namespace
{

voile::engine::Bounds transformed(const voile::engine::Bounds& box, const glm::mat4& transform)
{
    voile::engine::Bounds result{glm::vec3(INFINITY), glm::vec3(-INFINITY)};
    for (int corner = 0; corner < 8; ++corner)
    {
        const glm::vec3 p((corner & 1) != 0 ? box.max.x : box.min.x, (corner & 2) != 0 ? box.max.y : box.min.y,
                          (corner & 4) != 0 ? box.max.z : box.min.z);
        const glm::vec3 q(transform * glm::vec4(p, 1));
        result.min = glm::min(result.min, q);
        result.max = glm::max(result.max, q);
    }
    return result;
}

// The box around a cloth at the start. A point for a mesh that cannot be read, which is reported later.
voile::engine::Bounds cloth_bounds(const ClothEntry& cloth)
{
    voile::engine::Bounds box;
    if (const auto* grid = std::get_if<GridEntry>(&cloth.form))
    {
        const glm::vec3 half(0.5f * grid->size.x, 0, 0.5f * grid->size.y);
        box = {-half, half};
    }
    else if (const auto mesh = voile::engine::load_mesh(std::get<std::filesystem::path>(cloth.form)))
        box = voile::engine::bounds(mesh.value());
    return transformed(box, matrix(cloth.transform));
}

// A turn and a move, once the scale is in the shape.
glm::mat4 rigid(TransformEntry transform)
{
    transform.scale = 1;
    return matrix(transform);
}

PlaneShape scaled(PlaneShape plane, float scale)
{
    return {scale * plane.y};
}
SphereShape scaled(const SphereShape& sphere, float scale)
{
    return {scale * sphere.center, scale * sphere.radius};
}
CapsuleShape scaled(const CapsuleShape& capsule, float scale)
{
    return {scale * capsule.from, scale * capsule.to, scale * capsule.radius};
}
BoxShape scaled(const BoxShape& box, float scale)
{
    return {scale * box.min, scale * box.max};
}

// The solver gets the poses at both ends of a frame and takes the shorter rotation between them.
voile::Result<void> check_spin(const SceneFile& scene, const ColliderEntry& entry)
{
    const glm::vec3 spin = entry.motion ? glm::abs(entry.motion->spin) : glm::vec3(0);
    if (spin.x + spin.y + spin.z < 180 * scene.step.rate)
        return {};
    return error_at(scene, {entry.location.line, entry.location.path + ".motion.spin"},
                    "is half a turn per frame or more");
}

voile::Result<Solid> load_sequence(const ColliderEntry& entry)
{
    auto loaded = MeshSequence::load(*entry.frames, std::get<MeshShape>(entry.shape).file);
    if (!loaded)
        return loaded.error();
    const auto frames = std::make_shared<const MeshSequence>(std::move(loaded.value()));
    return Solid{.name = voile::gpu::printable(sequence_name(*entry.frames)),
                 .shape = frames->first(),
                 .transform = matrix(entry.transform),
                 .frames = frames};
}

voile::Result<Solid> load_shape(const ColliderEntry& entry)
{
    if (const auto* mesh = std::get_if<MeshShape>(&entry.shape))
    {
        auto loaded = voile::engine::load_mesh(mesh->file);
        if (!loaded)
            return loaded.error();
        return Solid{.name = voile::gpu::printable(mesh->file.stem().string()),
                     .shape = std::move(loaded.value()),
                     .transform = matrix(entry.transform)};
    }
    const float scale = entry.transform.scale;
    const glm::mat4 transform = rigid(entry.transform);
    if (const auto* plane = std::get_if<PlaneShape>(&entry.shape))
        return Solid{.name = "plane", .shape = scaled(*plane, scale), .transform = transform};
    if (const auto* sphere = std::get_if<SphereShape>(&entry.shape))
        return Solid{.name = "sphere", .shape = scaled(*sphere, scale), .transform = transform};
    if (const auto* capsule = std::get_if<CapsuleShape>(&entry.shape))
        return Solid{.name = "capsule", .shape = scaled(*capsule, scale), .transform = transform};
    return Solid{.name = "box", .shape = scaled(std::get<BoxShape>(entry.shape), scale), .transform = transform};
}

voile::Result<Solid> load_solid(const SceneFile& scene, const ColliderEntry& entry)
{
    if (auto spin = check_spin(scene, entry); !spin)
        return spin.error();
    auto solid = entry.frames ? load_sequence(entry) : load_shape(entry);
    if (!solid)
        return error_at(scene, {entry.location.line, entry.location.path + (entry.frames ? ".frames" : ".mesh")},
                        solid.error().message);
    solid.value().friction = entry.friction;
    solid.value().motion = entry.motion;
    solid.value().sides = entry.sides;
    solid.value().layers = entry.layers;
    solid.value().look = entry.look;
    solid.value().location = entry.location;
    return solid;
}

bool is_replaced(const Solid& solid)
{
    return std::holds_alternative<voile::engine::Mesh>(solid.shape) && !solid.is_ground();
}

// The box of the scene's meshes above the ground. Without a mesh, a cube below the cloths.
voile::engine::Bounds collider_box(const SceneFile& scene, const std::vector<Solid>& solids)
{
    std::optional<voile::engine::Bounds> box;
    for (const Solid& solid : solids)
        if (is_replaced(solid))
            box = merge(box, *solid.bounds());
    if (box)
    {
        for (const Solid& solid : solids)
            if (const auto height = solid.ground_height(); height && *height < box->max.y)
                box->min.y = std::max(box->min.y, *height);
        return *box;
    }
    std::optional<voile::engine::Bounds> cloths;
    for (const ClothEntry& cloth : scene.cloths)
        cloths = merge(cloths, cloth_bounds(cloth));
    const glm::vec3 size = cloths->max - cloths->min;
    const float side = 0.5f * std::max({size.x, size.y, size.z});
    const glm::vec3 middle = 0.5f * (cloths->min + cloths->max);
    const float top = cloths->min.y - 0.1f * side;
    return {{middle.x - 0.5f * side, top - side, middle.z - 0.5f * side},
            {middle.x + 0.5f * side, top, middle.z + 0.5f * side}};
}

// The i-th of n equal parts along the longer horizontal side.
voile::engine::Bounds part_of(const voile::engine::Bounds& box, size_t i, size_t n)
{
    const int axis = box.max.x - box.min.x >= box.max.z - box.min.z ? 0 : 2;
    const float width = (box.max[axis] - box.min[axis]) / static_cast<float>(n);
    voile::engine::Bounds part = box;
    part.min[axis] = box.min[axis] + static_cast<float>(i) * width;
    part.max[axis] = part.min[axis] + width;
    return part;
}

glm::mat4 fit(const voile::engine::Bounds& mesh, const voile::engine::Bounds& box)
{
    float scale = INFINITY;
    for (int axis = 0; axis < 3; ++axis)
        if (mesh.max[axis] > mesh.min[axis])
            scale = std::min(scale, (box.max[axis] - box.min[axis]) / (mesh.max[axis] - mesh.min[axis]));
    if (!std::isfinite(scale))
        scale = 1;
    const glm::vec3 mesh_foot(0.5f * (mesh.min.x + mesh.max.x), mesh.min.y, 0.5f * (mesh.min.z + mesh.max.z));
    const glm::vec3 box_foot(0.5f * (box.min.x + box.max.x), box.min.y, 0.5f * (box.min.z + box.max.z));
    return glm::scale(glm::translate(glm::mat4(1.f), box_foot - scale * mesh_foot), glm::vec3(scale));
}

} // namespace

bool Solid::is_ground() const
{
    const auto box = bounds();
    if (!box || !std::holds_alternative<voile::engine::Mesh>(shape) || frames)
        return false;
    const glm::vec3 size = box->max - box->min;
    return size.y <= 1e-3f * std::max(size.x, size.z);
}

std::optional<float> Solid::ground_height() const
{
    if (const auto* plane = std::get_if<PlaneShape>(&shape))
        return transform[1].y > 0.999f ? std::optional(transform[3].y + plane->y) : std::nullopt;
    return is_ground() ? std::optional(bounds()->max.y) : std::nullopt;
}

std::optional<voile::engine::Bounds> Solid::bounds() const
{
    const auto placed = [&](const glm::vec3& p) { return glm::vec3(transform * glm::vec4(p, 1)); };
    if (const auto* mesh = std::get_if<voile::engine::Mesh>(&shape))
        return transformed(voile::engine::bounds(*mesh), transform);
    if (const auto* sphere = std::get_if<SphereShape>(&shape))
        return voile::engine::Bounds{placed(sphere->center) - sphere->radius, placed(sphere->center) + sphere->radius};
    if (const auto* capsule = std::get_if<CapsuleShape>(&shape))
    {
        const glm::vec3 from = placed(capsule->from);
        const glm::vec3 to = placed(capsule->to);
        return voile::engine::Bounds{glm::min(from, to) - capsule->radius, glm::max(from, to) + capsule->radius};
    }
    if (const auto* box = std::get_if<BoxShape>(&shape))
        return transformed({box->min, box->max}, transform);
    return std::nullopt;
}

std::optional<voile::engine::Bounds> Solid::swept_bounds() const
{
    const auto still = frames ? transformed(frames->bounds(), transform) : bounds();
    if (!still || !motion)
        return still;
    MotionEntry there = *motion;
    there.velocity = glm::vec3(0);
    const float spin = glm::length(there.spin);
    const float period = std::max(spin > 0 ? 360 / spin : 0.f, there.sway ? there.sway->period : 0.f);
    constexpr int k_samples = 64;
    voile::engine::Bounds all = *still;
    for (int i = 0; i < k_samples; ++i)
        all = merge(all, transformed(*still, matrix(there, static_cast<double>(period) * i / k_samples)));
    return all;
}

voile::engine::Bounds merge(const std::optional<voile::engine::Bounds>& a, const voile::engine::Bounds& b)
{
    return a ? voile::engine::Bounds{glm::min(a->min, b.min), glm::max(a->max, b.max)} : b;
}

voile::Result<std::vector<Solid>> load_solids(const SceneFile& scene, const Options& options)
{
    std::vector<Solid> solids;
    for (const ColliderEntry& entry : scene.colliders)
    {
        auto solid = load_solid(scene, entry);
        if (!solid)
            return solid.error();
        solids.push_back(std::move(solid.value()));
    }
    if (options.colliders.empty())
        return solids;

    const voile::engine::Bounds box = collider_box(scene, solids);
    const auto replaced = std::find_if(solids.begin(), solids.end(), is_replaced);
    const auto motion = replaced != solids.end() ? replaced->motion : std::nullopt;
    const uint32_t layers = replaced != solids.end() ? replaced->layers : ~0u;
    std::erase_if(solids, is_replaced);
    for (size_t i = 0; i < options.colliders.size(); ++i)
    {
        auto mesh = voile::engine::load_mesh(options.colliders[i]);
        if (!mesh)
            return mesh.error();
        Solid solid;
        solid.name = voile::gpu::printable(options.colliders[i].stem().string());
        solid.transform = fit(voile::engine::bounds(mesh.value()), part_of(box, i, options.colliders.size()));
        solid.shape = std::move(mesh.value());
        solid.motion = motion;
        solid.layers = layers;
        solid.file = options.colliders[i];
        solids.push_back(std::move(solid));
    }
    return solids;
}

} // namespace viewer
