// Shaders that change while the window shows them.
#include "viewer/window_session.hpp"

#include <filesystem>
#include <fstream>

namespace
{

using tests::difference;
using tests::headless;
using tests::hide_panel;
using tests::is_missing;
using tests::k_flag;
using tests::picture_when;
using tests::read_statistics;
using tests::Session;
using tests::with;
using tests::XServer;
using tests::XWindow;

} // namespace

TEST_CASE("a changed shader of the cloth starts the scene again, and one that is refused is reported")
{
    const TestFolder folder;
    std::filesystem::copy(tests::source("shaders"), folder / "shaders", std::filesystem::copy_options::recursive);
    const std::filesystem::path cloth = folder / "shaders" / "cloth";
    const auto write = [&](const char* file, const std::string& part, const std::string& by)
    {
        std::string changed = tests::text_of(tests::source("shaders/cloth") / file);
        REQUIRE(changed.find(part) != std::string::npos);
        std::ofstream(cloth / file) << changed.replace(changed.find(part), part.size(), by);
    };
    const std::vector<std::string> arguments = with(k_flag, {"--shaders", (folder / "shaders").string()});
    const std::string stats = (folder / "stats.json").string();
    const XServer display;
    if (is_missing(display))
        return;
    Session session(display, folder, with(arguments, {"--stats", stats}));
    XWindow& window = session.window;
    session.step(2);
    write("forces/forces.glsl", "* step_input.gravity;", "* -step_input.gravity;");
    REQUIRE(window.wait_for_title("at frame 0"));
    write("constraints/pin.comp", "void main()",
          "layout(constant_id = 99) const int odd = 1; int f() { return odd; } void main()");
    REQUIRE(session.wait_for_errors("kernel \"cloth pins\": specialization constant 99"));
    write("constraints/pin.comp", "void main()", "void main(");
    REQUIRE(session.wait_for_errors("pin.comp:"));
    session.step(2); // with the last shaders that work
    session.close(true);
    write("constraints/pin.comp", "void main()", "void main()");
    const std::string hash = read_statistics(stats).hash;
    CHECK(hash == headless(folder, arguments, 2).hash);
    CHECK(hash != headless(folder, k_flag, 2).hash);
}

TEST_CASE("a changed shader changes the picture, and a broken one is reported by its line")
{
    const TestFolder folder;
    std::filesystem::copy(tests::source("shaders"), folder / "shaders", std::filesystem::copy_options::recursive);
    const std::filesystem::path sky = folder / "shaders" / "render" / "sky.glsl";
    const std::string text = tests::text_of(sky);
    const auto write = [&](const std::string& part, const std::string& by)
    {
        std::string changed = text;
        REQUIRE(changed.find(part) != std::string::npos);
        std::ofstream(sky) << changed.replace(changed.find(part), part.size(), by);
    };
    const XServer display;
    if (is_missing(display))
        return;
    Session session(
        display, folder,
        with({"reference", "--cloth-resolution", "16"}, {"--shaders", (folder / "shaders/render").string()}));
    XWindow& window = session.window;
    const voile::engine::Picture before = hide_panel(window);
    write("return gradient + glow;", "return vec3(1, 0, 0);");
    const voile::engine::Picture red = picture_when(window, [&](const voile::engine::Picture& picture)
                                                    { return difference(picture, before, 0, 320) > 10; });
    write("return gradient + glow;", "return gradient + gloom;");
    REQUIRE(session.wait_for_errors("sky.glsl:15: 'gloom' : undeclared identifier"));
    session.step(1); // a frame with the last shaders that work
    CHECK(difference(window.picture(), red, 0, 320) < 2);
    write("return gradient + glow;", "return gradient + glow;");
    REQUIRE(session.wait_for_errors("the changed shaders are in use"));
    (void)picture_when(window,
                       [&](const voile::engine::Picture& picture) { return difference(picture, before, 0, 320) < 2; });
    session.close(true);
}
