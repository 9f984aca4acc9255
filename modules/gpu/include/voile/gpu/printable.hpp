// Makes names and other text from files safe for messages.
#pragma once

#include "voile/export.hpp"

#include <cstddef>
#include <string>
#include <string_view>

namespace voile::gpu
{

// Returns text for one line of a message on a terminal. At most `most` bytes, cut between characters, with "..."
// appended if it was cut. A '?' replaces each control character, each byte that is not UTF-8, and each character that
// changes the direction of text or ends a line.
VOILE_GPU_API std::string printable(std::string_view text, size_t most = 80);

} // namespace voile::gpu
