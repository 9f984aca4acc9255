// 8-bit images on the host, read and written as PNG through stb.
#pragma once

#include "voile/gpu/result.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace voile::engine
{

struct Picture
{
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<uint8_t> rgba; // 4 bytes a pixel, rows from the top, sRGB
};

// Grey and palette pictures are expanded, 16 bits a channel cut to 8. Errors name the file and the reason.
gpu::Result<Picture> load_png(const std::filesystem::path& path);
// Alpha is dropped: the file has three channels. Tuned for speed, as frames of a film are written by the hundred. The
// file appears complete or not at all. Each side 1 to 16384. Errors name the file and the reason.
gpu::Result<void> save_png(const std::filesystem::path& path, const Picture& picture);

} // namespace voile::engine
