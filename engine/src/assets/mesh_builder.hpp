// Makes a clean Mesh from the polygons of a mesh file of any format.
#pragma once

#include "voile/engine/assets/mesh.hpp"
#include "voile/result.hpp"

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

namespace voile::engine
{

// A corner of a face: indices into the lists of Polygons, -1 if missing.
struct Corner
{
    int32_t position = 0;
    int32_t texture_coordinate = -1;
    int32_t normal = -1;

    auto operator<=>(const Corner&) const = default;
};

// The contents of a file: all indices in range, all numbers finite, every face with at least 3 corners.
struct Polygons
{
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> texture_coordinates;
    std::vector<glm::vec3> normals; // any length
    std::vector<Corner> corners;    // of all faces, concatenated
    std::vector<uint32_t> face_sizes;
};

// Triangulates the faces, drops degenerate and duplicate triangles, and computes the normals unless every corner has
// one. Makes one vertex per combination of position, texture coordinate and normal in use, in the order of the
// positions, or one per position. MeshVertices::faces only triangulates. `report` may be null. Error: "NAME: REASON" if
// no triangle is left.
Result<Mesh> build_mesh(Polygons polygons, const std::string& name, MeshReport* report,
                        MeshVertices vertices = MeshVertices::corners);

} // namespace voile::engine
