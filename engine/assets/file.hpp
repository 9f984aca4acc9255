// Whole files in and out, with the system's reason when it does not work.
#pragma once

#include "gpu/result.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace engine
{

// Errors: "PATH: cannot read: REASON", the reason in the words of the system ("Is a directory").
gpu::Result<std::string> read_file(const std::filesystem::path& path);

// Writes beside the path and renames when complete, so that nobody ever sees half a file. The folder must exist.
gpu::Result<void> write_file(const std::filesystem::path& path, std::string_view bytes);

} // namespace engine
