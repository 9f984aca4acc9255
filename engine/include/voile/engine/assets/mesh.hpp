// Mesh: an indexed triangle mesh on the host.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace voile::engine
{

// Texture coordinates as a file has them: a position at a seam has several.
struct TextureMap
{
    std::vector<glm::vec2> coordinates;
    std::vector<glm::uvec3> triangles; // indices into coordinates, parallel to the mesh's triangles
};

struct Mesh
{
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;             // one per position, unit length
    std::vector<glm::vec2> texture_coordinates; // one per position; all zero when the file has none
    std::vector<glm::uvec3> triangles;          // indices into positions, counter-clockwise seen from outside
    TextureMap texture_map;                     // MeshVertices::positions alone; empty if a corner has no coordinate
};

// How the vertices of a loaded mesh are formed.
enum class MeshVertices
{
    corners,   // one per combination of position, texture coordinate and normal in use: for drawing
    positions, // one per position of the file, used or not, in file order: for connected meshes such as cloth. Normals
               // are computed. A position with several texture coordinates keeps the first
    faces, // like positions, and the triangulation does not depend on the positions: polygons are cut from their first
           // corner, none is dropped. No normals, no texture coordinates. For meshes that share the faces of another
};

struct Bounds
{
    glm::vec3 min{0.f};
    glm::vec3 max{0.f};
};

Bounds bounds(const Mesh& mesh); // zero for a mesh without positions

// The changes that loading made. They explain counts that differ from the file.
struct MeshReport
{
    uint32_t polygons_triangulated = 0; // faces with more than three corners
    uint32_t degenerate_triangles = 0;  // dropped: height at most 2^-22 of the mesh's largest coordinate
    uint32_t duplicate_triangles = 0;   // dropped: same three points as an earlier one, in either winding
    bool normals_computed = false;      // the file had none, or not for every corner
};

} // namespace voile::engine
