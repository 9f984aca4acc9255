// Reading and writing PNG.
#include "voile/engine/assets/image_file.hpp"

#include "support/test_folder.hpp"
#include "voile/engine/assets/file.hpp"

#include <doctest/doctest.h>
#include <glm/glm.hpp>

#include <cstdint>
#include <string>

namespace
{

// Every channel differs between pixels and between rows.
voile::engine::Picture make_picture(uint32_t width, uint32_t height)
{
    voile::engine::Picture picture{width, height, {}};
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            for (const uint32_t value : {7 * x + y, 3 * y + 1, x ^ y, 255u})
                picture.rgba.push_back(static_cast<uint8_t>(value));
    return picture;
}

std::string load_message(const std::filesystem::path& path)
{
    const auto result = voile::engine::load_png(path);
    return result ? "accepted" : result.error().message;
}

std::string save_message(const std::filesystem::path& path, const voile::engine::Picture& picture)
{
    const auto result = voile::engine::save_png(path, picture);
    return result ? "accepted" : result.error().message;
}

} // namespace

TEST_CASE("a picture survives a round trip through PNG")
{
    const TestFolder folder;
    for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(1, 300), glm::uvec2(333, 2), glm::uvec2(64, 48)})
    {
        CAPTURE(size.x);
        const voile::engine::Picture picture = make_picture(size.x, size.y);
        REQUIRE(voile::engine::save_png(folder / "a.png", picture));
        const auto loaded = voile::engine::load_png(folder / "a.png");
        REQUIRE_MESSAGE(loaded, loaded.error().message);
        CHECK(loaded.value().width == size.x);
        CHECK(loaded.value().height == size.y);
        CHECK(loaded.value().rgba == picture.rgba);
    }
}

TEST_CASE("alpha is dropped when saving")
{
    const TestFolder folder;
    voile::engine::Picture picture{1, 2, {10, 20, 30, 0, 40, 50, 60, 128}};
    REQUIRE(voile::engine::save_png(folder / "a.png", picture));
    CHECK(voile::engine::load_png(folder / "a.png").value().rgba ==
          std::vector<uint8_t>{10, 20, 30, 255, 40, 50, 60, 255});
}

TEST_CASE("a file that is not a PNG is named with the reason")
{
    const TestFolder folder;
    const std::string missing = (folder / "gone.png").string();
    CHECK(load_message(missing) == missing + ": cannot read: No such file or directory");
    const std::string directory = (folder / "").string();
    CHECK(load_message(directory) == directory + ": cannot read: Is a directory");
    const std::string empty = folder.write("empty.png", "").string();
    CHECK(load_message(empty) == empty + ": file is empty");
    const std::string text = folder.write("text.png", "v 0 0 0\n").string();
    CHECK(load_message(text).starts_with(text + ": not a readable PNG: "));
}

TEST_CASE("a PNG truncated anywhere is refused in one line with a reason")
{
    const TestFolder folder;
    REQUIRE(voile::engine::save_png(folder / "a.png", make_picture(16, 16)));
    const std::string whole = voile::engine::read_file(folder / "a.png").value();
    // The last twelve bytes, the IEND chunk, contain nothing about the picture.
    for (size_t length = 1; length + 12 < whole.size(); ++length)
    {
        CAPTURE(length);
        const std::string path = folder.write("cut.png", whole.substr(0, length)).string();
        const std::string start = path + ": not a readable PNG: ";
        const std::string message = load_message(path);
        CAPTURE(message);
        REQUIRE(message.starts_with(start));
        REQUIRE(message.size() > start.size());
        REQUIRE(message.find_first_of(std::string("\n\0", 2)) == std::string::npos);
    }
}

TEST_CASE("a PNG with a damaged header is refused")
{
    const TestFolder folder;
    REQUIRE(voile::engine::save_png(folder / "a.png", make_picture(4, 4)));
    const std::string whole = voile::engine::read_file(folder / "a.png").value();
    for (const size_t byte : {0u, 12u, 16u, 24u, 25u}) // signature, IHDR's name, width, bits, color type
    {
        CAPTURE(byte);
        std::string damaged = whole;
        damaged[byte] = 'x';
        CHECK(load_message(folder.write("bad.png", damaged)).find(": not a readable PNG: ") != std::string::npos);
    }
}

TEST_CASE("an invalid picture is not saved")
{
    const TestFolder folder;
    const std::string path = (folder / "a.png").string();
    CHECK(save_message(path, {}) == path + ": a picture of 0 x 0 pixels cannot be written");
    CHECK(save_message(path, {16385, 1, {}}) == path + ": a picture of 16385 x 1 pixels cannot be written");
    CHECK(save_message(path, {2, 2, {1, 2, 3}}) == path + ": a picture of 2 x 2 pixels has 3 bytes, needs 4 per pixel");
    CHECK(folder.is_empty());
}

TEST_CASE("a picture with the longest allowed side can be saved")
{
    const TestFolder folder;
    const voile::engine::Picture picture = make_picture(16384, 1);
    REQUIRE(voile::engine::save_png(folder / "a.png", picture));
    CHECK(voile::engine::load_png(folder / "a.png").value().rgba == picture.rgba);
}

TEST_CASE("a picture that cannot be written leaves nothing behind")
{
    const TestFolder folder;
    const voile::engine::Picture picture = make_picture(4, 4);
    const std::string nowhere = (folder / "gone/a.png").string();
    CHECK(save_message(nowhere, picture) ==
          nowhere + ": cannot be written: there is no folder " + (folder / "gone").string());
    CHECK(folder.is_empty());

    std::filesystem::create_directory(folder / "a.png"); // occupies the path
    const std::string taken = (folder / "a.png").string();
    CHECK(save_message(taken, picture) == taken + ": cannot be written: it is a folder");
    std::filesystem::remove(folder / "a.png");
    CHECK(folder.is_empty());
}
