// 8-bit images on the host, read and written as PNG through stb.
#pragma once

#include "voile/result.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace voile::engine
{

struct Picture
{
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<uint8_t> rgba; // 4 bytes per pixel, rows from the top, sRGB
};

// Expands gray and palette pictures and truncates 16 bits per channel to 8. Errors name the file and the reason.
Result<Picture> load_png(const std::filesystem::path& path);
// Writes three channels and drops alpha. Compression is tuned for speed, because films write hundreds of frames. The
// file appears complete or not at all. Each side has 1 to 16384 pixels. Errors name the file and the reason.
Result<void> save_png(const std::filesystem::path& path, const Picture& picture);

} // namespace voile::engine
