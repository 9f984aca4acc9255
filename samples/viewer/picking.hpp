// Picking: the vertex of a cloth under the cursor.
#pragma once

#include "voile/engine/scene/scene.hpp"

#include <glm/glm.hpp>

#include <optional>
#include <span>

namespace viewer
{

struct Ray
{
    glm::vec3 origin{0.f};
    glm::vec3 direction{0.f, 0.f, -1.f}; // of unit length
};

// From the camera through a point of the picture: (0, 0) is its upper left corner, (1, 1) its lower right one.
// `aspect`: width over height.
Ray ray_through(const voile::engine::Camera& camera, const glm::vec2& cursor, float aspect);

// The point of the ray in the plane through `point` that faces the camera.
glm::vec3 point_in_plane(const voile::engine::Camera& camera, const Ray& ray, const glm::vec3& point);

struct PickedVertex
{
    uint32_t vertex = 0;
    float distance = 0; // m, along the ray to the surface
};

// Of the triangle that the ray hits first, the corner that is nearest to the hit and free. `positions`: x y z and
// inverse mass, as in voile::VertexStreams; a vertex without inverse mass is not free. None: the ray hits no triangle,
// or one without a free corner.
std::optional<PickedVertex> pick_vertex(const Ray& ray, std::span<const glm::vec4> positions,
                                        std::span<const glm::uvec3> triangles);

// The distance along the ray to a mesh, m. `placed`: world from mesh.
std::optional<float> hit_distance(const Ray& ray, const glm::mat4& placed, std::span<const glm::vec3> positions,
                                  std::span<const glm::uvec3> triangles);

} // namespace viewer
