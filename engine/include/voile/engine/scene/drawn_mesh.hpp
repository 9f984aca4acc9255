// DrawnMesh: the common part of StaticMesh and DeformingMesh, which hold the vertices.
#pragma once

#include "voile/engine/assets/mesh.hpp"
#include "voile/engine/gpu/upload.hpp"
#include "voile/engine/scene/component.hpp"

#include <string>

namespace voile::engine
{

// The faces and texture coordinates of a mesh, in device buffers.
class MeshFaces
{
public:
    MeshFaces(UploadBatch& uploads, const Mesh& mesh);
    void attach(Drawable& drawable) const;

private:
    gpu::Buffer texture_coordinates_;
    gpu::Buffer indices_;
    uint32_t index_count_;
};

class DrawnMesh : public Component
{
public:
    // Sets the transform from the next recorded frame on.
    void set_model(const glm::mat4& world_from_model) { drawable_.model = world_from_model; }

    void record_draw(VkCommandBuffer cmd, View& view) override;

protected:
    DrawnMesh(const Surface& surface, std::string label, const glm::mat4& model);

    Drawable drawable_; // without buffers

private:
    std::string label_;
};

} // namespace voile::engine
