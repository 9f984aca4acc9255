// Mesh: an indexed triangle mesh on the host.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace voile::engine
{

struct Mesh
{
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;             // one a position, unit length
    std::vector<glm::vec2> texture_coordinates; // one a position; all zero when the file has none
    std::vector<glm::uvec3> triangles;          // indices into positions, counter-clockwise seen from outside
};

// What becomes a vertex of a mesh that is loaded.
enum class MeshVertices
{
    corners,   // each combination of position, texture coordinate and normal in use: for drawing
    positions, // each position of the file, used or not, in its order: for what must hang together, as cloth does.
               // Normals are computed; of several texture coordinates the first counts
    faces, // as positions, and no triangle depends on where they are: polygons are cut from their first corner, none
           // is dropped. No normals, no texture coordinates. For meshes that must have the faces of another
};

struct Bounds
{
    glm::vec3 min{0.f};
    glm::vec3 max{0.f};
};

Bounds bounds(const Mesh& mesh); // zero for a mesh without positions

// What loading changed, for a reader who wonders why counts differ.
struct MeshReport
{
    uint32_t polygons_triangulated = 0; // faces with more than three corners
    uint32_t degenerate_triangles = 0;  // dropped: no height above 2^-22 of the mesh's largest coordinate
    uint32_t duplicate_triangles = 0;   // dropped: the same three points as an earlier one, whichever way round
    bool normals_computed = false;      // the file had none (or not for every corner)
};

} // namespace voile::engine
