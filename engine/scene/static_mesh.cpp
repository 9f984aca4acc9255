// StaticMesh: vertex streams on the device, in the layout that Drawable asks for.
#include "engine/scene/static_mesh.hpp"

namespace engine
{

namespace
{

std::vector<glm::vec4> padded(const std::vector<glm::vec3>& values)
{
    std::vector<glm::vec4> result;
    result.reserve(values.size());
    for (const glm::vec3& value : values)
        result.emplace_back(value, 0.f);
    return result;
}

} // namespace

StaticMesh::StaticMesh(UploadBatch& uploads, const Mesh& mesh, const Surface& surface, std::string label,
                       const glm::mat4& model)
    : DrawnMesh(uploads, mesh, surface, std::move(label), model),
      positions_(uploads.buffer("mesh positions", padded(mesh.positions), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT)),
      normals_(uploads.buffer("mesh normals", padded(mesh.normals), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT))
{
    drawable_.positions = positions_.handle();
    drawable_.normals = normals_.handle();
}

} // namespace engine
