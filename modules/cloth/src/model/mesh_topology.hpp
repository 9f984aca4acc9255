// The springs, bending stencils and vertex areas of a triangle mesh: what makes it a cloth, before any material.
#pragma once

#include "voile/descriptions.hpp"

#include "model/membrane.hpp"
#include "model/mesh_lists.hpp"
#include "shared/cloth_layout.h"

#include <span>

namespace voile
{

// Lists one after the other: vertex i has springs first_spring .. + springs, in ascending order of neighbors, and
// the same for corners, in the order of the triangles. Each spring is listed twice, once per end. A fabric's mesh has a
// membrane corner for each corner.
struct MeshTopology
{
    MeshLists lists;
    SharedArray<MembraneTriangle> membrane;     // of a fabric
    SharedArray<double> areas;                  // m^2, a third of the triangles around each vertex; 0: isolated
    SharedArray<glm::uvec3> triangles;          // as they were given
    SharedArray<glm::vec2> texture_coordinates; // m of fabric, as they were given or projected
    MeshReport report;
    bool isometric = false;      // it has the coefficients of isometric bending
    bool uniform_masses = false; // it has springs along its edges in place of a membrane

    // Bounds for the fastest modes of a fabric (a vertex of mass areal density * area) and of uniform springs; the
    // membrane's follows from the fabric (membrane_rates).
    struct Bounds
    {
        double edge = 0;     // uniform: 1 (times k / m)
        double opposite = 0; // fabric: 1/m^4 (times B / rho); uniform: 1
        double bending = 0;  // of the isometric model: 1/m^4 (times B / rho); uniform: 1/m^2 (times B / m)
    };
    Bounds fabric;
    Bounds uniform;
    double mean_area = 0; // m^2, of the vertices that have any
};

// m. Indices must be within the positions, here and below.
double longest_side(std::span<const glm::dvec3> positions, const glm::uvec3& triangle);
// m^2; 0 for a degenerate triangle: if its height is 0 within the precision of float, for sides of `least_side` m and
// more. Bending of lower ones is beyond the range of floats.
double solid_area(std::span<const glm::dvec3> positions, const glm::uvec3& triangle, double least_side = 0.01);

// `positions`: the shape at rest. `isometric`: with the coefficients of isometric bending,
// which reaches half as many vertices again as springs do. `uniform_masses`: the vertices' masses are not in proportion
// to their areas, and springs along the edges take the place of a membrane; else `fabric` has its direction.
MeshTopology make_mesh_topology(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles,
                                const FabricCoordinates& fabric, bool isometric, bool uniform_masses);

} // namespace voile
