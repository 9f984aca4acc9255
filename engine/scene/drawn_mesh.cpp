// DrawnMesh: faces, texture coordinates and the draw.
#include "engine/scene/drawn_mesh.hpp"

namespace engine
{

DrawnMesh::DrawnMesh(UploadBatch& uploads, const Mesh& mesh, const Surface& surface, std::string label,
                     const glm::mat4& model)
    : label_(std::move(label)),
      texture_coordinates_(
          uploads.buffer("mesh texture coordinates", mesh.texture_coordinates, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT)),
      indices_(uploads.buffer("mesh indices", mesh.triangles, VK_BUFFER_USAGE_INDEX_BUFFER_BIT))
{
    drawable_.texture_coordinates = texture_coordinates_.handle();
    drawable_.indices = indices_.handle();
    drawable_.index_count = static_cast<uint32_t>(3 * mesh.triangles.size());
    drawable_.model = model;
    drawable_.surface = surface;
    drawable_.label = label_.c_str();
}

void DrawnMesh::record_draw(VkCommandBuffer cmd, View& view)
{
    view.draw(cmd, drawable_);
}

} // namespace engine
