// Bounds of a mesh.
#include "voile/engine/assets/mesh.hpp"

namespace voile::engine
{

Bounds bounds(const Mesh& mesh)
{
    if (mesh.positions.empty())
        return {};
    Bounds box{mesh.positions.front(), mesh.positions.front()};
    for (const glm::vec3& position : mesh.positions)
    {
        box.min = glm::min(box.min, position);
        box.max = glm::max(box.max, position);
    }
    return box;
}

} // namespace voile::engine
