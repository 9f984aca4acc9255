// Loading and placing the solids.
#include "samples/viewer/colliders.hpp"

#include "engine/assets/load_mesh.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace viewer
{
namespace
{

engine::Bounds transformed(const engine::Bounds& box, const glm::mat4& transform)
{
    engine::Bounds result{glm::vec3(INFINITY), glm::vec3(-INFINITY)};
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

// The box around a cloth at the start. Of a mesh that cannot be read, which is told later, a point.
engine::Bounds cloth_bounds(const ClothEntry& cloth)
{
    engine::Bounds box;
    if (const auto* grid = std::get_if<GridEntry>(&cloth.form))
    {
        const glm::vec3 half(0.5f * grid->size.x, 0, 0.5f * grid->size.y);
        box = {-half, half};
    }
    else if (const auto mesh = engine::load_mesh(std::get<std::filesystem::path>(cloth.form)))
        box = engine::bounds(mesh.value());
    return transformed(box, matrix(cloth.transform));
}

gpu::Result<Solid> load_solid(const SceneFile& scene, const ColliderEntry& entry)
{
    const auto unsupported = [&](const char* what)
    { return gpu::Error{place(scene, entry.line) + ": colliders: " + what + " is not supported yet"}; };
    if (entry.motion)
        return unsupported("\"motion\"");
    if (entry.frames)
        return unsupported("\"frames\"");
    Solid solid;
    solid.friction = entry.friction;
    if (const auto* plane = std::get_if<PlaneShape>(&entry.shape))
    {
        solid.name = "plane";
        solid.shape = *plane;
    }
    else if (const auto* sphere = std::get_if<SphereShape>(&entry.shape))
    {
        solid.name = "sphere";
        solid.shape = *sphere;
    }
    else if (const auto* mesh = std::get_if<MeshShape>(&entry.shape))
    {
        auto loaded = engine::load_mesh(mesh->file);
        if (!loaded)
            return loaded.error();
        solid.name = mesh->file.stem().string();
        solid.shape = std::move(loaded.value());
        solid.transform = matrix(entry.transform);
    }
    else
        return unsupported(std::holds_alternative<CapsuleShape>(entry.shape) ? "a capsule" : "a box");
    return solid;
}

// How high the ground is: of a plane or a level mesh.
std::optional<float> ground_height(const Solid& solid)
{
    if (const auto* plane = std::get_if<PlaneShape>(&solid.shape))
        return plane->y;
    return solid.is_ground() ? std::optional<float>(solid.bounds()->max.y) : std::nullopt;
}

// Where the scene's meshes stand, above the ground; without one, a cube below the cloths that they cover.
engine::Bounds collider_box(const SceneFile& scene, const std::vector<Solid>& solids)
{
    std::optional<engine::Bounds> box;
    for (const Solid& solid : solids)
        if (std::holds_alternative<engine::Mesh>(solid.shape) && !solid.is_ground())
            box = merge(box, *solid.bounds());
    if (box)
    {
        for (const Solid& solid : solids)
            if (const auto height = ground_height(solid); height && *height < box->max.y)
                box->min.y = std::max(box->min.y, *height);
        return *box;
    }
    std::optional<engine::Bounds> cloths;
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
engine::Bounds part_of(const engine::Bounds& box, size_t i, size_t n)
{
    const int axis = box.max.x - box.min.x >= box.max.z - box.min.z ? 0 : 2;
    const float width = (box.max[axis] - box.min[axis]) / static_cast<float>(n);
    engine::Bounds part = box;
    part.min[axis] = box.min[axis] + static_cast<float>(i) * width;
    part.max[axis] = part.min[axis] + width;
    return part;
}

glm::mat4 fit(const engine::Bounds& mesh, const engine::Bounds& box)
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
    if (!box || !std::holds_alternative<engine::Mesh>(shape))
        return false;
    const glm::vec3 size = box->max - box->min;
    return size.y <= 1e-3f * std::max(size.x, size.z);
}

std::optional<engine::Bounds> Solid::bounds() const
{
    if (const auto* mesh = std::get_if<engine::Mesh>(&shape))
        return transformed(engine::bounds(*mesh), transform);
    if (const auto* sphere = std::get_if<SphereShape>(&shape))
        return engine::Bounds{sphere->center - sphere->radius, sphere->center + sphere->radius};
    return std::nullopt;
}

engine::Bounds merge(const std::optional<engine::Bounds>& a, const engine::Bounds& b)
{
    return a ? engine::Bounds{glm::min(a->min, b.min), glm::max(a->max, b.max)} : b;
}

gpu::Result<std::vector<Solid>> load_solids(const SceneFile& scene, const Options& options)
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

    const engine::Bounds box = collider_box(scene, solids);
    std::erase_if(solids, [](const Solid& solid)
                  { return std::holds_alternative<engine::Mesh>(solid.shape) && !solid.is_ground(); });
    for (size_t i = 0; i < options.colliders.size(); ++i)
    {
        auto mesh = engine::load_mesh(options.colliders[i]);
        if (!mesh)
            return mesh.error();
        Solid solid;
        solid.name = options.colliders[i].stem().string();
        solid.transform = fit(engine::bounds(mesh.value()), part_of(box, i, options.colliders.size()));
        solid.shape = std::move(mesh.value());
        solids.push_back(std::move(solid));
    }
    return solids;
}

} // namespace viewer
