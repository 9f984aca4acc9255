// Reading a mesh in any of the formats known.
#pragma once

#include "voile/engine/assets/mesh.hpp"
#include "voile/gpu/result.hpp"

#include <filesystem>

namespace voile::engine
{

// Goes by the extension, in capitals or not: .obj as load_obj does, .ply as load_ply does. Errors: theirs, or another
// extension.
gpu::Result<Mesh> load_mesh(const std::filesystem::path& path, MeshReport* report = nullptr,
                            MeshVertices vertices = MeshVertices::corners);

} // namespace voile::engine
