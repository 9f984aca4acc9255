// DeformingMesh: a component that draws a mesh whose vertices the host moves.
#pragma once

#include "voile/engine/scene/drawn_mesh.hpp"

#include <span>
#include <vector>

namespace voile::engine
{

// Vertices are drawn from memory that the host writes, a buffer for each frame in flight: a frame's is written when
// that slot's previous use has completed, so that no frame waits for another and nothing is copied.
class DeformingMesh : public DrawnMesh
{
public:
    // `slots`: frames in flight. StartupError when a buffer cannot be made.
    DeformingMesh(UploadBatch& uploads, uint32_t slots, const Mesh& mesh, const Surface& surface,
                  std::string label = "mesh", const glm::mat4& model = glm::mat4(1.f));

    // Where its vertices are, from the next frame that is recorded on: as many as the mesh has, m, in its space.
    // Normals follow (sum_normals).
    void set_positions(std::span<const glm::vec3> positions);

    void record_compute(VkCommandBuffer cmd, const FrameInfo& frame) override;

private:
    struct Slot
    {
        gpu::Buffer vertices;
        bool current = false; // it holds vertices_
    };

    MeshFaces faces_;
    std::vector<glm::uvec3> triangles_;
    std::vector<glm::dvec3> normal_sums_; // kept for its memory
    std::vector<glm::vec4> vertices_;     // all positions, then all normals, as drawn
    std::vector<Slot> slots_;
};

} // namespace voile::engine
