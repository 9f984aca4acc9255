// A state of surfaces as OBJ or PLY. Vertices keep their order, coordinates are the scene's (meters, y up). Every file
// appears under its name only when it is complete.
#pragma once

#include "samples/viewer/surface.hpp"

#include "voile/result.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace viewer
{

// The file of each surface: `path` itself for a single one, else FILE_NAME.EXT with characters that do not suit a file
// name replaced, and a number added where two would then be the same.
std::vector<std::filesystem::path> export_paths(const std::filesystem::path& path,
                                                const std::vector<std::string>& names);

// Errors: too many vertices or faces for files, a value that is not finite, an index out of range, a wrong number of
// normals.
voile::Result<void> check_surface(const std::filesystem::path& path, const Surface& surface);

// The first value with a coordinate that is not finite: such a file would break whoever reads it.
std::optional<size_t> first_not_finite(std::span<const glm::vec3> values);

// Text; numbers with as many digits as bring the same float back. Errors: those of check_surface, and the system's.
voile::Result<void> save_surface_obj(const std::filesystem::path& path, const Surface& surface);

// Binary little endian: float x y z, with normals also float nx ny nz, with texture coordinates float s t; faces as
// uchar count and int vertex_indices. Texture coordinates with seams are a list per face, uchar count and float
// texcoord.
voile::Result<void> save_surface_ply(const std::filesystem::path& path, const Surface& surface);

// All surfaces, as OBJ or PLY by the extension of `path`. Returns the files written; none if a surface is unsound.
voile::Result<std::vector<std::filesystem::path>> export_surfaces(const std::filesystem::path& path,
                                                                  const std::vector<Surface>& surfaces);

} // namespace viewer
