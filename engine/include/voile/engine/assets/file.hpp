// Reads and writes whole files. Errors carry the system's reason.
#pragma once

#include "voile/result.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace voile::engine
{

constexpr uint64_t k_largest_file = uint64_t{4} << 30; // bytes

// Reads regular files only: a pipe or a device may have no end. Errors: "PATH: cannot read: REASON", the reason in the
// words of the system ("Is a directory"), "not a regular file" or "larger than N MiB".
Result<std::string> read_file(const std::filesystem::path& path, uint64_t most_bytes = k_largest_file);

// Writes like AtomicFile: the file is complete or absent. The folder must exist.
Result<void> write_file(const std::filesystem::path& path, std::string_view bytes);

} // namespace voile::engine
