// Statistics: what is counted on the GPU, once a frame, over all cloths.
#pragma once

#include <cstdint>

namespace cloth
{

struct Statistics
{
    float max_stretch = 0;             // max of l / L - 1 over the structural and shear springs, or a mesh's edges
    float mean_stretch = 0;            // mean of the same
    float kinetic_energy = 0;          // J
    float deepest_penetration = 0;     // m under the surface of a collider; 0 if no vertex is under one
    uint32_t penetrating_vertices = 0; // vertices under the surface of a collider
    uint32_t nan_vertices = 0;         // vertices whose position or velocity is not finite
    uint32_t contacts = 0;             // vertices that touched a collider in the last substep
    uint32_t candidates = 0;           // triangles of colliders in the lists that vertices keep
    uint32_t overflowing_vertices = 0; // vertices near more triangles than a list holds. They traverse the hierarchy in
                                       // every substep: slower, and nothing is left out
};

} // namespace cloth
