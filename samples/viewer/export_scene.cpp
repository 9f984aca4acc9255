// ExportScene: cloths and solids as surfaces.
#include "samples/viewer/export_scene.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <algorithm>

namespace viewer
{
namespace
{

constexpr uint32_t k_rings = 32;        // of round shapes, from pole to pole
constexpr float k_plane_half_size = 10; // of a plane's square, in extents of the scene

std::vector<glm::vec3> moved(std::vector<glm::vec3> positions, const glm::mat4& transform)
{
    for (glm::vec3& p : positions)
        p = glm::vec3(transform * glm::vec4(p, 1));
    return positions;
}

std::vector<glm::vec3> turned(std::vector<glm::vec3> normals, const glm::mat4& transform)
{
    const glm::mat3 turn = glm::transpose(glm::inverse(glm::mat3(transform)));
    for (glm::vec3& n : normals)
        n = glm::normalize(turn * n);
    return normals;
}

// Files without texture coordinates give zeros.
bool is_textured(const voile::engine::Mesh& mesh)
{
    return std::ranges::any_of(mesh.texture_coordinates, [](const glm::vec2& uv) { return uv != glm::vec2(0); });
}

ExportObject solid_object(const Solid& solid, size_t number, float extent)
{
    const voile::engine::Mesh mesh = mesh_of(solid, extent);
    ExportObject object;
    object.solid = number;
    object.motion = solid.frames   ? SurfaceMotion::deforming
                    : solid.motion ? SurfaceMotion::rigid
                                   : SurfaceMotion::still;
    object.surface.name = solid.name;
    object.surface.positions = moved(mesh.positions, solid.transform);
    object.surface.normals = turned(mesh.normals, solid.transform);
    object.surface.faces = triangle_faces(mesh.triangles);
    if (is_textured(mesh))
        object.surface.texture_coordinates = mesh.texture_coordinates;
    return object;
}

} // namespace

voile::engine::Mesh mesh_of(const Solid& solid, float extent)
{
    if (const auto* plane = std::get_if<PlaneShape>(&solid.shape))
        return voile::engine::make_ground(k_plane_half_size * extent, plane->y);
    if (const auto* sphere = std::get_if<SphereShape>(&solid.shape))
        return voile::engine::make_sphere(sphere->center, sphere->radius, k_rings);
    if (const auto* capsule = std::get_if<CapsuleShape>(&solid.shape))
        return voile::engine::make_capsule(capsule->from, capsule->to, capsule->radius, k_rings);
    if (const auto* box = std::get_if<BoxShape>(&solid.shape))
        return voile::engine::make_box(box->min, box->max);
    return std::get<voile::engine::Mesh>(solid.shape);
}

ExportScene::ExportScene(const Stage& stage, const std::vector<Solid>& solids, const std::vector<FinalCloth>& start,
                         float extent, const Options& options)
    : solids_(solids)
{
    for (size_t i = 0; i < stage.cloths.size(); ++i)
    {
        const StageCloth& cloth = stage.cloths[i];
        ExportObject& object = objects_.emplace_back();
        object.motion = SurfaceMotion::deforming;
        object.surface = {cloth.name, cloth.start, {}, cloth.texture_coordinates, cloth.faces};
        if (i < start.size())
        {
            object.surface.positions = start[i].positions;
            object.surface.normals = start[i].normals;
        }
    }
    const bool with_solids =
        options.export_colliders || std::ranges::any_of(options.exports, [](const ExportTarget& target)
                                                        { return target.format == ExportFormat::usd; });
    for (size_t i = 0; with_solids && i < solids.size(); ++i)
        objects_.push_back(solid_object(solids[i], i, extent));
}

glm::mat4 ExportScene::pose(const ExportObject& object, double seconds) const
{
    const auto& motion = solids_[*object.solid].motion;
    return motion ? matrix(*motion, seconds) : glm::mat4(1);
}

std::vector<glm::vec3> ExportScene::positions(const ExportObject& object, double seconds) const
{
    const Solid& solid = solids_[*object.solid];
    if (!solid.frames)
        return moved(object.surface.positions, pose(object, seconds));
    std::vector<glm::vec3> positions;
    solid.frames->positions_at(seconds, positions);
    return moved(std::move(positions), pose(object, seconds) * solid.transform);
}

std::vector<Surface> ExportScene::surfaces(const std::vector<FinalCloth>& state, double seconds) const
{
    std::vector<Surface> surfaces;
    for (size_t i = 0; i < objects_.size(); ++i)
    {
        const ExportObject& object = objects_[i];
        Surface& surface = surfaces.emplace_back(object.surface);
        if (!object.solid)
        {
            surface.positions = state[i].positions;
            surface.normals = state[i].normals;
            continue;
        }
        surface.positions = positions(object, seconds);
        surface.normals = object.motion == SurfaceMotion::deforming
                              ? surface_normals(surface.positions, surface.faces)
                              : turned(std::move(surface.normals), pose(object, seconds));
    }
    return surfaces;
}

} // namespace viewer
