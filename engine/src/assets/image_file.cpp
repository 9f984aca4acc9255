// PNG in and out through stb, whose two single-header libraries are compiled here and nowhere else.
#include "voile/engine/assets/image_file.hpp"

#include "voile/engine/assets/file.hpp"
#include "voile/engine/assets/words.hpp"

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_FAILURE_USERMSG
#include <stb_image.h>

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

#include <limits>
#include <memory>
#include <string>
#include <string_view>

namespace voile::engine
{

namespace
{

// A film writes hundreds of frames, so speed counts for more than size: stb's fastest compression, and one filter for
// all rows instead of trying all five. "Up" suits rendered pictures, where most rows resemble the one above.
constexpr int k_quickest = 5;
constexpr int k_filter_up = 2;

void append(void* context, void* data, int size)
{
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(size));
}

std::string encode_png(const Picture& picture)
{
    // stb keeps its settings in globals. They are set once, before the first use, also when several threads write
    // pictures.
    [[maybe_unused]] static const bool k_settings = []
    {
        stbi_write_png_compression_level = k_quickest;
        stbi_write_force_png_filter = k_filter_up;
        return true;
    }();
    const size_t pixels = size_t{picture.width} * picture.height;
    std::vector<uint8_t> rgb(3 * pixels);
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c)
            rgb[3 * i + c] = picture.rgba[4 * i + c];
    std::string bytes;
    const int width = static_cast<int>(picture.width);
    const int height = static_cast<int>(picture.height);
    if (stbi_write_png_to_func(append, &bytes, width, height, 3, rgb.data(), 3 * width) == 0)
        bytes.clear();
    return bytes;
}

} // namespace

Result<Picture> load_png(const std::filesystem::path& path)
{
    const Result<std::string> file = read_file(path);
    if (!file)
        return file.error();
    const std::string& bytes = file.value();
    if (bytes.empty())
        return Error{path_text(path) + ": file is empty"};
    if (bytes.size() > size_t{std::numeric_limits<int>::max()})
        return Error{path_text(path) + ": file is larger than 2 GiB"};
    int width = 0;
    int height = 0;
    int channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()), &width,
                              &height, &channels, 4),
        stbi_image_free);
    if (!pixels)
        return Error{path_text(path) + ": not a readable PNG: " + stbi_failure_reason()};
    Picture picture{static_cast<uint32_t>(width), static_cast<uint32_t>(height), {}};
    picture.rgba.assign(pixels.get(), pixels.get() + 4 * size_t{picture.width} * picture.height);
    return picture;
}

Result<void> save_png(const std::filesystem::path& path, const Picture& picture)
{
    const std::string size = std::to_string(picture.width) + " x " + std::to_string(picture.height);
    constexpr uint32_t k_longest_side = 16384; // stb counts bytes in int
    if (picture.width == 0 || picture.height == 0 || picture.width > k_longest_side || picture.height > k_longest_side)
        return Error{path_text(path) + ": a picture of " + size + " pixels cannot be written"};
    if (picture.rgba.size() != 4 * size_t{picture.width} * picture.height)
        return Error{path_text(path) + ": a picture of " + size + " pixels has " + std::to_string(picture.rgba.size()) +
                     " bytes, needs 4 per pixel"};
    const std::string bytes = encode_png(picture);
    if (bytes.empty())
        return Error{path_text(path) + ": a picture of " + size + " pixels could not be compressed"};
    return write_file(path, bytes);
}

} // namespace voile::engine
