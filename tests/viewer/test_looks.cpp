// The looks of cloths in scene files.
#include "scene_text.hpp"

#include <doctest/doctest.h>

using scene_text::cloth_message;

namespace
{

viewer::LookEntry look(const std::string& text)
{
    auto scene = scene_text::parse("{\"cloths\": [{" + scene_text::k_grid + ", \"look\": " + text + "}]}");
    REQUIRE_MESSAGE(scene, scene.error().message);
    return scene.value().cloths[0].look;
}

} // namespace

TEST_CASE("every key of a look is read")
{
    const viewer::LookEntry all = look(R"({"color": [0.5, 0.25, 1], "back_color": "#ff8000", "weave": "satin",
        "pattern": "stripes", "roughness": 0.3, "sheen": 0.2, "translucency": 0.4})");
    CHECK(all.color == glm::vec3(0.5f, 0.25f, 1));
    REQUIRE(all.back_color);
    CHECK(all.back_color->r == 1.f);
    CHECK(all.back_color->g == doctest::Approx(0.21586).epsilon(1e-4)); // sRGB 128
    CHECK(all.back_color->b == 0.f);
    CHECK(all.weave == voile::engine::Surface::Weave::satin);
    CHECK(all.pattern == voile::engine::Surface::Pattern::stripes);
    CHECK(all.roughness == 0.3f);
    CHECK(all.sheen == 0.2f);
    CHECK(all.translucency == 0.4f);

    const viewer::LookEntry none = look("{}");
    CHECK_FALSE((none.color || none.back_color || none.weave || none.pattern || none.roughness || none.sheen ||
                 none.translucency));
}

TEST_CASE("looks that are wrong are refused by key and value")
{
    CHECK(cloth_message("\"look\": {\"color\": \"red\"}") ==
          "dir/s.json:1: cloths[0].look.color is \"red\"; a color is \"#rrggbb\" or three numbers from 0 to 1");
    CHECK(cloth_message("\"look\": {\"color\": \"#12345g\"}") ==
          "dir/s.json:1: cloths[0].look.color is \"#12345g\"; a color is \"#rrggbb\" or three numbers from 0 to 1");
    CHECK(cloth_message("\"look\": {\"color\": [0, 0, 2]}").find("cloths[0].look.color[2]") != std::string::npos);
    CHECK(cloth_message("\"look\": {\"weave\": \"knit\"}").find("plain, twill, satin, grain") != std::string::npos);
    CHECK(cloth_message("\"look\": {\"roughness\": 0}").find("look.roughness") != std::string::npos);
    CHECK(cloth_message("\"look\": {\"colour\": [0, 0, 0]}").find("colour") != std::string::npos);
}
