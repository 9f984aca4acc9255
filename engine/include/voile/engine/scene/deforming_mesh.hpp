// DeformingMesh: a component that draws a mesh whose vertices the host moves.
#pragma once

#include "voile/engine/scene/drawn_mesh.hpp"

#include <span>
#include <vector>

namespace voile::engine
{

// Draws vertices from memory that the host writes, one buffer per frame in flight. A buffer is written when its slot's
// previous use has completed, so no frame waits for another and nothing is copied.
class DeformingMesh : public DrawnMesh
{
public:
    // `slots`: frames in flight. StartupError if a buffer cannot be made.
    DeformingMesh(UploadBatch& uploads, uint32_t slots, const Mesh& mesh, const Surface& surface,
                  std::string label = "mesh", const glm::mat4& model = glm::mat4(1.f));

    // Sets the vertex positions from the next recorded frame on: as many as the mesh has, m, in model space. Normals
    // are recomputed (sum_normals).
    void set_positions(std::span<const glm::vec3> positions);

    void record_compute(VkCommandBuffer cmd, const FrameInfo& frame) override;

private:
    struct Slot
    {
        gpu::Buffer vertices;
        bool current = false; // contains vertices_
    };

    MeshFaces faces_;
    std::vector<glm::uvec3> triangles_;
    std::vector<glm::dvec3> normal_sums_; // kept to reuse its memory
    std::vector<glm::vec4> vertices_;     // all positions, then all normals, as drawn
    std::vector<Slot> slots_;
};

} // namespace voile::engine
