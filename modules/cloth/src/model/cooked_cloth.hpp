// What a CookedCloth holds.
#pragma once

#include "voile/cooked.hpp"

#include "geometry/shared_array.hpp"
#include "model/mesh_topology.hpp"

#include <glm/glm.hpp>

namespace voile
{

struct CookedCloth::State
{
    glm::mat4 transform{1.f}; // that gives the shape at rest
    SharedArray<glm::vec3> positions;
    std::shared_ptr<const MeshTopology> mesh;
};

} // namespace voile
