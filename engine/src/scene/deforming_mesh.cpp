// DeformingMesh: vertex streams written by the host, one buffer per slot.
#include "voile/engine/scene/deforming_mesh.hpp"

#include "voile/engine/assets/normals.hpp"
#include "voile/engine/gpu/device.hpp"

#include <algorithm>

namespace voile::engine
{

DeformingMesh::DeformingMesh(UploadBatch& uploads, uint32_t slots, const Mesh& mesh, const Surface& surface,
                             std::string label, const glm::mat4& model)
    : DrawnMesh(surface, std::move(label), model), faces_(uploads, mesh), triangles_(mesh.triangles),
      vertices_(2 * mesh.positions.size()), slots_(slots)
{
    faces_.attach(drawable_);
    const size_t bytes = vertices_.size() * sizeof(glm::vec4);
    for (Slot& slot : slots_)
        slot.vertices = take(gpu::create_buffer(uploads.context(), "deforming vertices", bytes,
                                                VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, Memory::upload));
    drawable_.normal_offset = bytes / 2;
    set_positions(mesh.positions);
}

void DeformingMesh::set_positions(std::span<const glm::vec3> positions)
{
    sum_normals(positions, triangles_, normal_sums_);
    for (size_t i = 0; i < positions.size(); ++i)
    {
        vertices_[i] = glm::vec4(positions[i], 0);
        vertices_[positions.size() + i] = glm::vec4(unit_normal(normal_sums_[i]), 0);
    }
    for (Slot& slot : slots_)
        slot.current = false;
}

// The submission that follows makes the host's writes visible.
void DeformingMesh::record_compute(VkCommandBuffer /*cmd*/, const FrameInfo& frame)
{
    Slot& slot = slots_[frame.slot];
    if (!slot.current)
    {
        const auto bytes = std::as_bytes(std::span(vertices_));
        std::copy(bytes.begin(), bytes.end(), slot.vertices.mapped().begin());
        slot.vertices.flush();
        slot.current = true;
    }
    drawable_.positions = drawable_.normals = slot.vertices.handle();
}

} // namespace voile::engine
