// DrawnMesh: faces, texture coordinates and the draw.
#include "voile/engine/scene/drawn_mesh.hpp"

namespace voile::engine
{

MeshFaces::MeshFaces(UploadBatch& uploads, const Mesh& mesh)
    : texture_coordinates_(
          uploads.buffer("mesh texture coordinates", mesh.texture_coordinates, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT)),
      indices_(uploads.buffer("mesh indices", mesh.triangles, VK_BUFFER_USAGE_INDEX_BUFFER_BIT)),
      index_count_(static_cast<uint32_t>(3 * mesh.triangles.size()))
{
}

void MeshFaces::attach(Drawable& drawable) const
{
    drawable.texture_coordinates = texture_coordinates_.handle();
    drawable.indices = indices_.handle();
    drawable.index_count = index_count_;
}

DrawnMesh::DrawnMesh(const Surface& surface, std::string label, const glm::mat4& model) : label_(std::move(label))
{
    drawable_.model = model;
    drawable_.surface = surface;
    drawable_.label = label_.c_str();
}

void DrawnMesh::record_draw(VkCommandBuffer cmd, View& view)
{
    view.draw(cmd, drawable_);
}

} // namespace voile::engine
