// DrawnMesh: what the components that draw a mesh share. Where its vertices are is up to StaticMesh and DeformingMesh.
#pragma once

#include "engine/assets/mesh.hpp"
#include "engine/gpu/upload.hpp"
#include "engine/scene/component.hpp"

#include <string>

namespace engine
{

class DrawnMesh : public Component
{
public:
    // Moves it, from the next frame that is recorded on.
    void set_model(const glm::mat4& world_from_model) { drawable_.model = world_from_model; }

    void record_draw(VkCommandBuffer cmd, View& view) override;

protected:
    // Copies faces and texture coordinates into device buffers through `uploads`.
    DrawnMesh(UploadBatch& uploads, const Mesh& mesh, const Surface& surface, std::string label,
              const glm::mat4& model);

    Drawable drawable_; // without positions and normals

private:
    std::string label_;
    gpu::Buffer texture_coordinates_;
    gpu::Buffer indices_;
};

} // namespace engine
