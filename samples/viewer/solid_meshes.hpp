// SolidMeshes: what a solid is drawn with. Shapes of one kind share a mesh of unit size, which its model matrix places.
#pragma once

#include "samples/viewer/colliders.hpp"

#include "voile/engine/scene/static_mesh.hpp"

#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace viewer
{

struct SolidPart
{
    std::shared_ptr<const voile::engine::MeshBuffers> mesh;
    glm::mat4 placed{1.f}; // world from mesh, at time 0
};

class SolidMeshes
{
public:
    // `extent`: m, of the scene. A plane is drawn 60 times as large, and a small round shape with fewer faces.
    SolidMeshes(voile::engine::UploadBatch& uploads, float extent) : uploads_(uploads), extent_(extent) {}

    // A capsule has several. Not for solids that deform.
    std::vector<SolidPart> parts(const Solid& solid);

private:
    enum class Unit
    {
        sphere,
        dome,
        tube,
        box
    };
    std::shared_ptr<const voile::engine::MeshBuffers> unit(Unit unit, uint32_t rings);
    [[nodiscard]] uint32_t rings(float radius) const;
    std::vector<SolidPart> capsule_parts(const CapsuleShape& capsule, const glm::mat4& transform);

    voile::engine::UploadBatch& uploads_;
    float extent_;
    std::map<std::pair<Unit, uint32_t>, std::shared_ptr<const voile::engine::MeshBuffers>> units_; // with rings
};

} // namespace viewer
