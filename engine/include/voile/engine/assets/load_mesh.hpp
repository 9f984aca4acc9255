// Loads a mesh of any known format.
#pragma once

#include "voile/engine/assets/mesh.hpp"
#include "voile/result.hpp"

#include <filesystem>

namespace voile::engine
{

// Selects the format by the extension, in either case: .obj (load_obj) or .ply (load_ply). Errors: those of the loader,
// or an unknown extension.
Result<Mesh> load_mesh(const std::filesystem::path& path, MeshReport* report = nullptr,
                       MeshVertices vertices = MeshVertices::corners);

} // namespace voile::engine
