// StaticMesh: a component that draws a mesh whose vertices do not change.
#pragma once

#include "engine/scene/drawn_mesh.hpp"

namespace engine
{

class StaticMesh : public DrawnMesh
{
public:
    // Copies the mesh into device buffers through `uploads`.
    StaticMesh(UploadBatch& uploads, const Mesh& mesh, const Surface& surface, std::string label = "mesh",
               const glm::mat4& model = glm::mat4(1.f));

private:
    gpu::Buffer positions_;
    gpu::Buffer normals_;
};

} // namespace engine
