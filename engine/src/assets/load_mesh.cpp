// Selects the loader of a mesh format.
#include "voile/engine/assets/load_mesh.hpp"

#include "voile/engine/assets/obj.hpp"
#include "voile/engine/assets/ply.hpp"
#include "voile/engine/assets/words.hpp"

#include <string>

namespace voile::engine
{

Result<Mesh> load_mesh(const std::filesystem::path& path, MeshReport* report, MeshVertices vertices)
{
    std::string extension = path.extension().string();
    for (char& c : extension)
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (extension == ".obj")
        return load_obj(path, report, vertices);
    if (extension == ".ply")
        return load_ply(path, report, vertices);
    return Error{path_text(path) + ": not a mesh format that can be read, the name does not end in .obj or .ply"};
}

} // namespace voile::engine
