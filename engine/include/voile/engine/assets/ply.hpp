// Reading PLY.
#pragma once

#include "voile/engine/assets/mesh.hpp"
#include "voile/result.hpp"

#include <filesystem>

namespace voile::engine
{

// Loads a PLY file, ASCII or binary of either endianness, as one mesh: x, y, z of the element "vertex" and the list
// "vertex_indices" or "vertex_index" of the element "face". Coordinates may have any type, indices any integer type.
// Everything else in the file is skipped, so texture coordinates are zero and normals are always computed. Faces are
// triangulated and cleaned like those of load_obj. Errors name the file, the line (in a binary file the vertex or face)
// and the reason: missing, unreadable, empty, malformed or truncated file; data after the last element; an index out of
// range; a coordinate that is not finite; no triangles left.
Result<Mesh> load_ply(const std::filesystem::path& path, MeshReport* report = nullptr,
                      MeshVertices vertices = MeshVertices::corners);

} // namespace voile::engine
