// StaticMesh: a component that draws a mesh whose vertices do not change.
#pragma once

#include "engine/assets/mesh.hpp"
#include "engine/gpu/upload.hpp"
#include "engine/scene/component.hpp"

#include <string>

namespace engine
{

class StaticMesh : public Component
{
public:
    // Copies the mesh into device buffers through `uploads`.
    StaticMesh(UploadBatch& uploads, const Mesh& mesh, const Surface& surface, std::string label = "mesh",
               const glm::mat4& model = glm::mat4(1.f));

    // Moves it, from the next frame that is recorded on.
    void set_model(const glm::mat4& world_from_model) { drawable_.model = world_from_model; }

    void record_draw(VkCommandBuffer cmd, View& view) override;

private:
    std::string label_;
    gpu::Buffer positions_;
    gpu::Buffer normals_;
    gpu::Buffer texture_coordinates_;
    gpu::Buffer indices_;
    Drawable drawable_;
};

} // namespace engine
