// Reading and writing OBJ.
#pragma once

#include "voile/engine/assets/mesh.hpp"
#include "voile/result.hpp"

#include <filesystem>

namespace voile::engine
{

// Loads every shape of an OBJ file as one mesh (through tinyobjloader; materials and lines are ignored). Polygons are
// triangulated. Corners that share a position but not a texture coordinate or normal become separate vertices. The
// vertices follow the order of the file's positions, without unused ones (MeshVertices::corners). Missing normals are
// computed, weighted by angle (Thürmer and Wüthrich 1998) across all triangles that share the position. Errors, each
// naming the file and, if there is one, the line: missing, unreadable, empty or malformed file; an index out of range;
// a coordinate that is not finite; no triangles left.
Result<Mesh> load_obj(const std::filesystem::path& path, MeshReport* report = nullptr,
                      MeshVertices vertices = MeshVertices::corners);

// Writes positions and triangles in vertex order, every float exactly, through a temporary file that is renamed when it
// is complete. Errors name the file: a position that is not finite, an index out of range, the system's reason.
Result<void> save_obj(const std::filesystem::path& path, const Mesh& mesh);

} // namespace voile::engine
