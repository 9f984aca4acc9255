// StaticMesh: vertex streams on the device, in the layout of Drawable.
#include "voile/engine/scene/static_mesh.hpp"

namespace voile::engine
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

MeshBuffers::MeshBuffers(UploadBatch& uploads, const Mesh& mesh)
    : faces_(uploads, mesh),
      positions_(uploads.buffer("mesh positions", padded(mesh.positions), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT)),
      normals_(uploads.buffer("mesh normals", padded(mesh.normals), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT))
{
}

void MeshBuffers::attach(Drawable& drawable) const
{
    faces_.attach(drawable);
    drawable.positions = positions_.handle();
    drawable.normals = normals_.handle();
}

StaticMesh::StaticMesh(std::shared_ptr<const MeshBuffers> buffers, const Surface& surface, std::string label,
                       const glm::mat4& model)
    : DrawnMesh(surface, std::move(label), model), buffers_(std::move(buffers))
{
    buffers_->attach(drawable_);
}

StaticMesh::StaticMesh(UploadBatch& uploads, const Mesh& mesh, const Surface& surface, std::string label,
                       const glm::mat4& model)
    : StaticMesh(std::make_shared<const MeshBuffers>(uploads, mesh), surface, std::move(label), model)
{
}

} // namespace voile::engine
