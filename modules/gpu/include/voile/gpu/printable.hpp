// Names and other text from files, fit for messages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace voile::gpu
{

// The text for one line of a message on a terminal. At most `most` bytes, cut between characters, and "..." after it
// where something was left out. A '?' stands for each control character, byte that is no UTF-8, and character that
// changes the direction of text or ends a line.
std::string printable(std::string_view text, size_t most = 80);

} // namespace voile::gpu
