// Light and shadows in pictures: the sun's shadow, its penumbra, and the sky that bodies hide.
#include "support/stage.hpp"

#include <algorithm>
#include <climits>
#include <cstdlib>

namespace
{

using tests::add_ground;
using tests::brightness;
using tests::pixel;
using tests::Stage;

} // namespace

TEST_CASE("a sphere is lit from the sun's side, and its shadow falls on the other with a soft edge")
{
    Stage stage;
    add_ground(stage);
    stage.scene.sun.direction = {-1, -1, 0}; // from the right
    stage.scene.focus = {0, 0.5f, 0};
    stage.scene.focus_radius = 2;
    stage.scene.camera = {.position = {0, 6, 0.01f}, .target = {0, 0, 0}, .fov = 30}; // from above
    const voile::engine::Picture bare = stage.draw();
    stage.scene.add("ball").add<voile::engine::StaticMesh>(
        stage.uploads, voile::engine::make_sphere({0, 0.5f, 0}, 0.4f), voile::engine::Surface{});
    const voile::engine::Picture picture = stage.draw();
    // 180 pixels show 3.2 m at the ground: 56 per meter. The ball's center appears at 160, its shadow's at x = -0.5 m,
    // 132. The shadow extends 0.4 * sqrt(2) m along x, beyond the ball's own outline.
    CHECK(brightness(pixel(picture, 178, 90)) > brightness(pixel(picture, 146, 90)));
    const int open_ground = brightness(pixel(picture, 40, 90));
    const int shadow = brightness(pixel(picture, 122, 90));
    CHECK(shadow < open_ground * 2 / 3);
    CHECK(brightness(pixel(bare, 122, 90)) > open_ground * 9 / 10);
    int between = 0;
    for (uint32_t x = 80; x < 122; ++x)
    {
        const int value = brightness(pixel(picture, x, 90));
        between += value > shadow + (open_ground - shadow) / 10 && value < open_ground - (open_ground - shadow) / 10;
    }
    CHECK(between >= 1);
}

TEST_CASE("a shadow is harder near what casts it")
{
    // A ball at the height `center`, lit from the right. The camera looks down at its shadow's middle.
    const auto picture_of = [](float center)
    {
        Stage stage;
        add_ground(stage);
        stage.scene.sun.direction = {-1, -1, 0};
        stage.scene.focus = {0, 0.5f, 0};
        stage.scene.focus_radius = 2;
        stage.scene.camera = {.position = {-center, 6, 0.01f}, .target = {-center, 0, 0}, .fov = 30};
        stage.scene.add("ball").add<voile::engine::StaticMesh>(
            stage.uploads, voile::engine::make_sphere({0, center, 0}, 0.2f), voile::engine::Surface{});
        return stage.draw();
    };
    // The number of pixels that are half lit along the middle row, left of the shadow's middle (160).
    const auto half_lit = [](const voile::engine::Picture& picture)
    {
        const int open = brightness(pixel(picture, 100, 90));
        const int shadow = brightness(pixel(picture, 155, 90));
        CHECK(shadow < open * 4 / 5);
        int count = 0;
        for (uint32_t x = 100; x < 155; ++x)
        {
            const int value = brightness(pixel(picture, x, 90));
            count += value > shadow + (open - shadow) / 10 && value < open - (open - shadow) / 10;
        }
        return count;
    };
    const voile::engine::Picture low = picture_of(0.3f);
    const voile::engine::Picture high = picture_of(1.5f);
    CHECK(half_lit(low) <= 4); // measured: 3 and 7
    CHECK(half_lit(high) > half_lit(low) + 1);
}

TEST_CASE("the shadow of a cap that lies close on a ball has no gaps")
{
    constexpr glm::vec3 k_center(0, 0.5f, 0);
    Stage stage;
    add_ground(stage);
    stage.scene.sun.direction = {0, -1, -0.6f};
    stage.scene.focus = {0, 0.5f, 0};
    stage.scene.focus_radius = 1;
    stage.scene.camera = {.position = {0, 0.5f, 0.6f}, .target = k_center, .fov = 12};
    voile::engine::Mesh cap = voile::engine::make_sphere(k_center, 0.086f);
    std::erase_if(cap.triangles,
                  [&](const glm::uvec3& t) {
                      return std::min({cap.positions[t.x].y, cap.positions[t.y].y, cap.positions[t.z].y}) < 0.499f;
                  });
    stage.scene.add("ball").add<voile::engine::StaticMesh>(stage.uploads, voile::engine::make_sphere(k_center, 0.08f),
                                                           voile::engine::Surface{});
    stage.scene.add("cap").add<voile::engine::StaticMesh>(stage.uploads, cap, voile::engine::Surface{});
    const voile::engine::Picture picture = stage.draw();
    // Along rows of its shadow.
    for (uint32_t y = 90; y < 102; ++y)
    {
        int low = INT_MAX;
        int high = 0;
        for (uint32_t x = 148; x < 174; ++x)
        {
            low = std::min(low, brightness(pixel(picture, x, y)));
            high = std::max(high, brightness(pixel(picture, x, y)));
        }
        CAPTURE(y);
        CHECK(high < 530);      // measured: 474; lit 550 to 580
        CHECK(high - low < 60); // measured: 24
    }
}

TEST_CASE("the samples of a wide penumbra make no pattern")
{
    Stage stage;
    add_ground(stage);
    stage.scene.sun.direction = {-1, -1, 0};
    stage.scene.focus = {0, 0.5f, 0};
    stage.scene.focus_radius = 2;
    stage.scene.camera = {.position = {-1.5f, 2.5f, 0.01f}, .target = {-1.5f, 0, 0}, .fov = 30};
    stage.scene.add("ball").add<voile::engine::StaticMesh>(
        stage.uploads, voile::engine::make_sphere({0, 1.5f, 0}, 0.2f), voile::engine::Surface{});
    const voile::engine::Picture picture = stage.draw();
    // Toward the shadow's middle (160) it becomes darker from pixel to pixel. Steps to lighter ones are noise.
    int darker = 0;
    int lighter = 0;
    for (uint32_t y = 88; y < 92; ++y)
        for (uint32_t x = 100; x < 155; ++x)
        {
            const int step = brightness(pixel(picture, x + 1, y)) - brightness(pixel(picture, x, y));
            (step < 0 ? darker : lighter) += std::abs(step);
        }
    CHECK(darker > 500);
    CHECK(lighter < darker / 20); // measured: 3 and 975
}

TEST_CASE("the sky is hidden close to a body, and nowhere else")
{
    Stage stage;
    add_ground(stage);
    stage.scene.sun.irradiance = glm::vec3(0);
    stage.scene.focus = {0, 0.5f, 0};
    stage.scene.focus_radius = 2;
    stage.scene.camera = {.position = {0, 6, 0.01f}, .target = {0, 0, 0}, .fov = 30}; // from above
    const voile::engine::Picture bare = stage.draw();
    stage.scene.add("ball").add<voile::engine::StaticMesh>(
        stage.uploads, voile::engine::make_sphere({0, 0.3f, 0}, 0.3f), voile::engine::Surface{});
    const voile::engine::Picture picture = stage.draw();
    // 56 pixels per meter: the ball ends at 160 + 18, the reach of what hides the sky 0.44 m from there.
    const auto kept = [&](uint32_t x)
    { return static_cast<double>(brightness(pixel(picture, x, 90))) / brightness(pixel(bare, x, 90)); };
    CAPTURE(kept(181));
    CAPTURE(kept(220));
    CHECK(kept(181) < 0.98); // measured: 0.968
    CHECK(kept(220) > 0.995);
}
