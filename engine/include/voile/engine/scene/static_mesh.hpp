// StaticMesh: a component that draws a mesh whose vertices do not change.
#pragma once

#include "voile/engine/scene/drawn_mesh.hpp"

#include <memory>

namespace voile::engine
{

// A mesh in device buffers. Any number of components may draw it.
class MeshBuffers
{
public:
    // Copies the mesh through `uploads`. StartupError if a buffer cannot be made.
    MeshBuffers(UploadBatch& uploads, const Mesh& mesh);
    void attach(Drawable& drawable) const;

private:
    MeshFaces faces_;
    gpu::Buffer positions_;
    gpu::Buffer normals_;
};

class StaticMesh : public DrawnMesh
{
public:
    StaticMesh(std::shared_ptr<const MeshBuffers> buffers, const Surface& surface, std::string label = "mesh",
               const glm::mat4& model = glm::mat4(1.f));
    // Owns its buffers.
    StaticMesh(UploadBatch& uploads, const Mesh& mesh, const Surface& surface, std::string label = "mesh",
               const glm::mat4& model = glm::mat4(1.f));

private:
    std::shared_ptr<const MeshBuffers> buffers_;
};

} // namespace voile::engine
