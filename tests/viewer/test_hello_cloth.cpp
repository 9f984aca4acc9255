// The first test: the shortest program runs, and its picture shows a red cloth on the ground under a sky.
#include "support/sample_run.hpp"
#include "support/test_folder.hpp"

#include "voile/engine/assets/image_file.hpp"

#include <doctest/doctest.h>

TEST_CASE("hello_cloth draws a cloth on a sphere")
{
    const TestFolder folder;
    const SampleRun run = run_sample(folder, "hello_cloth", "--headless 30");
    check_progress(run);
    CHECK(run.output == "wrote hello_cloth.png\n");
    const auto picture = voile::engine::load_png(folder / "hello_cloth.png");
    REQUIRE_MESSAGE(picture, picture.error().message);
    CHECK(picture.value().width == 1280);
    CHECK(picture.value().height == 720);
    size_t red = 0;
    size_t blue = 0;
    for (size_t i = 0; i < picture.value().rgba.size(); i += 4)
    {
        const uint8_t* p = &picture.value().rgba[i];
        red += p[0] > 2 * p[1] && p[0] > 2 * p[2]; // the cloth is the only thing of that color
        blue += p[2] > p[0] + 8;                   // sky, and shadows lit by it
    }
    const size_t pixels = size_t{1280} * 720;
    CHECK(red > pixels / 40);
    CHECK(red < pixels / 3);
    CHECK(blue > pixels / 20);
}
