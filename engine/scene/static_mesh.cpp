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
    : label_(std::move(label)),
      positions_(uploads.buffer("mesh positions", padded(mesh.positions), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT)),
      normals_(uploads.buffer("mesh normals", padded(mesh.normals), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT)),
      texture_coordinates_(
          uploads.buffer("mesh texture coordinates", mesh.texture_coordinates, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT)),
      indices_(uploads.buffer("mesh indices", mesh.triangles, VK_BUFFER_USAGE_INDEX_BUFFER_BIT))
{
    drawable_.positions = positions_.handle();
    drawable_.normals = normals_.handle();
    drawable_.texture_coordinates = texture_coordinates_.handle();
    drawable_.indices = indices_.handle();
    drawable_.index_count = static_cast<uint32_t>(3 * mesh.triangles.size());
    drawable_.model = model;
    drawable_.surface = surface;
    drawable_.label = label_.c_str();
}

void StaticMesh::record_draw(VkCommandBuffer cmd, View& view)
{
    view.draw(cmd, drawable_);
}

} // namespace engine
