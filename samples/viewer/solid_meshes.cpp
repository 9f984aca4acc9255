// Meshes of solids.
#include "samples/viewer/solid_meshes.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <glm/gtc/matrix_transform.hpp>

namespace viewer
{
namespace
{

glm::mat4 placed(const glm::vec3& origin, const glm::mat3& axes)
{
    glm::mat4 result(axes);
    result[3] = glm::vec4(origin, 1);
    return result;
}

} // namespace

std::shared_ptr<const voile::engine::MeshBuffers> SolidMeshes::unit(Unit unit, uint32_t rings)
{
    std::shared_ptr<const voile::engine::MeshBuffers>& buffers = units_[{unit, rings}];
    if (buffers)
        return buffers;
    switch (unit)
    {
    case Unit::sphere:
        buffers =
            std::make_shared<voile::engine::MeshBuffers>(uploads_, voile::engine::make_sphere(glm::vec3(0), 1, rings));
        break;
    case Unit::dome:
        buffers = std::make_shared<voile::engine::MeshBuffers>(uploads_, voile::engine::make_dome(rings / 2));
        break;
    case Unit::tube:
        buffers = std::make_shared<voile::engine::MeshBuffers>(uploads_, voile::engine::make_tube(2 * rings));
        break;
    case Unit::box:
        buffers =
            std::make_shared<voile::engine::MeshBuffers>(uploads_, voile::engine::make_box(glm::vec3(0), glm::vec3(1)));
        break;
    }
    return buffers;
}

// Of a sphere of 48 segments, whose outline is round even if it fills a picture.
uint32_t SolidMeshes::rings(float radius) const
{
    const float fraction = radius / extent_;
    return fraction > 1.f / 40 ? 48 : fraction > 1.f / 160 ? 24 : 12;
}

std::vector<SolidPart> SolidMeshes::capsule_parts(const CapsuleShape& capsule, const glm::mat4& transform)
{
    const uint32_t count = rings(capsule.radius);
    const float length = glm::distance(capsule.from, capsule.to);
    const glm::mat3 turn =
        voile::engine::turn_to(length > 0 ? (capsule.to - capsule.from) / length : glm::vec3(0, 1, 0));
    const float r = capsule.radius;
    const auto dome = unit(Unit::dome, count);
    std::vector<SolidPart> parts{{dome, transform * placed(capsule.to, r * turn)},
                                 {dome, transform * placed(capsule.from, {r * turn[0], -r * turn[1], -r * turn[2]})}};
    if (length > 0)
        parts.push_back(
            {unit(Unit::tube, count), transform * placed(capsule.from, {r * turn[0], length * turn[1], r * turn[2]})});
    return parts;
}

std::vector<SolidPart> SolidMeshes::parts(const Solid& solid)
{
    if (const auto* sphere = std::get_if<SphereShape>(&solid.shape))
        return {{unit(Unit::sphere, rings(sphere->radius)),
                 solid.transform * placed(sphere->center, glm::mat3(sphere->radius))}};
    if (const auto* capsule = std::get_if<CapsuleShape>(&solid.shape))
        return capsule_parts(*capsule, solid.transform);
    if (const auto* box = std::get_if<BoxShape>(&solid.shape))
    {
        const glm::vec3 size = box->max - box->min;
        return {{unit(Unit::box, 0), solid.transform * glm::scale(glm::translate(glm::mat4(1), box->min), size)}};
    }
    const auto* plane = std::get_if<PlaneShape>(&solid.shape);
    const voile::engine::Mesh mesh = plane != nullptr ? voile::engine::make_ground(30 * extent_, plane->y)
                                                      : std::get<voile::engine::Mesh>(solid.shape);
    return {{std::make_shared<voile::engine::MeshBuffers>(uploads_, mesh), solid.transform}};
}

} // namespace viewer
