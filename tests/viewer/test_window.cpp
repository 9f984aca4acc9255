// The viewer's window on a virtual display: real keys, a real mouse, and what a window manager does.
#include "viewer/window_session.hpp"

#include <glm/glm.hpp>

#include <cstring>

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
using tests::shows_panel;
using tests::Statistics;
using tests::ViewerProcess;
using tests::with;
using tests::XServer;
using tests::XWindow;

// A sheet that hangs from its rear corners, its middle vertex in the middle of the picture.
constexpr const char* k_sheet = R"({
  "cloths": [{"grid": {"vertices": [17, 17], "size": [1, 1]}, "pins": ["corner:0", "corner:1"],
              "transform": {"translate": [0, 1, 0]}}],
  "camera": {"position": [0, 3, 2], "target": [0, 1, 0], "fov": 60}
})";
// The same sheet behind a box, which no cloth touches.
constexpr const char* k_hidden_sheet = R"({
  "cloths": [{"grid": {"vertices": [17, 17], "size": [1, 1]}, "pins": ["corner:0", "corner:1"],
              "transform": {"translate": [0, 1, 0]}}],
  "colliders": [{"box": {"min": [-0.1, -0.1, -0.1], "max": [0.1, 0.1, 0.1]}, "transform": {"translate": [0, 2, 1]},
                 "layers": []}],
  "camera": {"position": [0, 3, 2], "target": [0, 1, 0], "fov": 60}
})";
constexpr uint32_t k_vertices = 17 * 17;
constexpr uint32_t k_middle = 8 * 17 + 8;

// The positions of the middle vertex, one per frame, from a point cache.
std::vector<glm::vec3> middle_positions(const std::filesystem::path& path)
{
    constexpr size_t k_header = 32;
    const std::string bytes = tests::text_of(path);
    std::vector<glm::vec3> positions;
    for (size_t at = k_header + k_middle * sizeof(glm::vec3); at + sizeof(glm::vec3) <= bytes.size();
         at += k_vertices * sizeof(glm::vec3))
        std::memcpy(&positions.emplace_back(), bytes.data() + at, sizeof(glm::vec3));
    return positions;
}

} // namespace

TEST_CASE("a period takes one step while paused, and R starts again")
{
    const TestFolder folder;
    const std::string stats = (folder / "stats.json").string();
    const XServer display;
    if (is_missing(display))
        return;
    Session session(display, folder, with(k_flag, {"--stats", stats}));
    session.step(3);
    session.window.press(XK_r);
    REQUIRE(session.window.wait_for_title("at frame 0"));
    session.step(2);
    session.close();
    const Statistics statistics = read_statistics(stats);
    CHECK(statistics.frames == 2);
    CHECK(statistics.hash == headless(folder, k_flag, 2).hash);
}

TEST_CASE("space pauses and continues, and nothing is simulated while paused or minimized")
{
    const TestFolder folder;
    const XServer display;
    if (is_missing(display))
        return;
    Session session(display, folder, k_flag);
    XWindow& window = session.window;
    window.press(XK_space);
    REQUIRE(window.wait_for_title("paused", false));
    window.minimize();
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    window.restore();
    window.press(XK_space);
    REQUIRE(window.wait_for_title("paused"));
    const int frames = session.frame();
    CHECK(frames > 0);
    CHECK(frames < 45); // half of what 1.5 s have
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    CHECK(session.frame() == frames);
    session.step(1);
    session.close();
}

TEST_CASE("a window is resized, and Escape closes it")
{
    const TestFolder folder;
    const XServer display;
    if (is_missing(display))
        return;
    Session session(display, folder, k_flag);
    session.step(1);
    for (const unsigned int width : {500u, 200u})
    {
        session.window.resize(width, 160);
        session.step(1);
        CHECK(session.window.picture().width == width);
    }
    session.window.press(XK_Escape);
    CHECK(session.wait().exit_code == 0);
}

TEST_CASE("the mouse grabs a vertex, which follows the cursor until it is released")
{
    const TestFolder folder;
    const std::filesystem::path scene = folder.write("sheet.json", k_sheet);
    const XServer display;
    if (is_missing(display))
        return;
    Session session(display, folder, {scene.string(), "--export", (folder / "sheet.pc2").string()});
    XWindow& window = session.window;
    (void)hide_panel(window);
    window.move(160, 90);
    window.button(1, true);
    window.move(160, 70);
    session.step(30);
    window.button(1, false);
    session.step(20);
    session.close();

    // The cursor's point in the plane through the vertex that faces the camera.
    const float pixel = 2 * std::sqrt(8.f) * std::tan(std::acos(-1.f) / 6) / 180; // m
    const glm::vec3 up(0, std::sqrt(0.5f), -std::sqrt(0.5f));
    const glm::vec3 start(0, 1, 0);
    const glm::vec3 target = start + 20 * pixel * up;
    const std::vector<glm::vec3> positions = middle_positions(folder / "sheet.pc2");
    REQUIRE(positions.size() == 51); // the first is that before the first step
    const float held = glm::distance(positions[30], target);
    const float released = glm::distance(positions[50], target);
    CAPTURE(held);
    CAPTURE(released);
    CHECK(held < 0.2f * glm::distance(start, target));
    CHECK(released > 3 * held);
}

TEST_CASE("dragging beside the cloth, or on a solid before it, orbits, and the cloth is left alone")
{
    const TestFolder folder;
    const std::filesystem::path scene = folder.write("sheet.json", k_hidden_sheet);
    const std::string stats = (folder / "stats.json").string();
    const XServer display;
    if (is_missing(display))
        return;
    Session session(display, folder, {scene.string(), "--stats", stats});
    XWindow& window = session.window;
    (void)hide_panel(window);
    session.step(1);
    const voile::engine::Picture before = window.picture();
    window.move(160, 90); // on the box
    window.button(1, true);
    window.move(120, 110);
    window.button(1, false);
    const auto differs_from = [](const voile::engine::Picture& other)
    { return [&](const voile::engine::Picture& picture) { return difference(other, picture, 0, 320) > 1; }; };
    const voile::engine::Picture turned = picture_when(window, differs_from(before));
    window.move(300, 10); // beside both
    window.button(1, true);
    window.move(200, 40);
    window.button(1, false);
    const voile::engine::Picture after = picture_when(window, differs_from(turned));
    window.press(XK_Home);
    (void)picture_when(window, differs_from(after));
    session.step(1);
    session.close();
    CHECK(read_statistics(stats).hash == headless(folder, {scene.string()}, 2).hash);
}

TEST_CASE("a dropped mesh becomes a collider, and the saved scene is what runs")
{
    const TestFolder folder;
    const std::string box =
        folder.write("box.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n").string();
    const std::string scene =
        folder
            .write("fast.json",
                   R"({"cloths": [{"grid": {"vertices": [9, 9], "size": [1, 1]}}], "gravity": [0, -100, 0]})")
            .string();
    const std::string stats = (folder / "stats.json").string();
    const XServer display;
    if (is_missing(display))
        return;
    Session session(display, folder, {scene, "--stats", stats});
    session.step(1);
    session.window.drop(box);
    REQUIRE(session.window.wait_for_title("at frame 0"));
    session.window.press(XK_s, true);
    const std::filesystem::path saved = folder / "fast_1.json";
    REQUIRE(ViewerProcess::wait_until([&] { return std::filesystem::exists(saved); }));
    session.step(8);
    session.close();
    const std::string hash = read_statistics(stats).hash;
    CHECK(hash == headless(folder, {scene, "--collider", box}, 8).hash);
    CHECK(hash == headless(folder, {saved.string()}, 8).hash);
    CHECK(hash != headless(folder, {scene}, 8).hash); // it has touched the mesh
}

#if VOILE_HAS_PANEL

namespace
{

// A sheet that has fallen over a ball, right of the panel.
constexpr const char* k_pulled_sheet = R"({
  "cloths": [{"name": "sheet", "grid": {"vertices": [40, 40], "size": [1.9, 1.9]}, "material": "cotton",
              "integrator": "verlet", "transform": {"translate": [0, 1.15, 0], "rotate": [0, 20, 0]}}],
  "colliders": [{"sphere": {"center": [0, 0.55, 0], "radius": 0.5}}, {"plane": {"y": 0}}],
  "camera": {"position": [-0.62, 1.6, 3.2], "target": [-0.62, 0.65, 0], "fov": 40}
})";

// For people who want to see what these tests see.
void keep(const char* name, const voile::engine::Picture& picture)
{
    if (const char* folder = std::getenv("VOILE_WINDOW_PICTURES"))
        CHECK(voile::engine::save_png(std::filesystem::path(folder) / name, picture));
}

} // namespace

TEST_CASE("the panel shows and hides, and a picture is saved without it")
{
    const TestFolder folder;
    const XServer display;
    if (is_missing(display))
        return;
    Session session(display, folder, k_flag, "640x400");
    XWindow& window = session.window;
    session.step(2);
    window.press(XK_F2);
    const std::filesystem::path saved = folder / "flag_1.png";
    REQUIRE(ViewerProcess::wait_until([&] { return std::filesystem::exists(saved); }));
    const auto file = voile::engine::load_png(saved);
    REQUIRE(file);
    // Conditions wait, because a window can be read while its picture is replaced.
    window.press(XK_Tab);
    (void)picture_when(window, [&](const voile::engine::Picture& picture)
                       { return difference(picture, file.value(), 0, 640) < 1; });
    window.press(XK_Tab);
    keep("panel.png", picture_when(window,
                                   [&](const voile::engine::Picture& picture) {
                                       return difference(picture, file.value(), 8, 358) > 20 &&
                                              difference(picture, file.value(), 400, 640) < 1;
                                   }));
    session.close();
}

TEST_CASE("the panel has buttons and sliders that work")
{
    const TestFolder folder;
    const std::string weightless = std::string(k_sheet).replace(0, 1, "{\"gravity\": [0, 0, 0],"); // it does not move
    const std::string scene = folder.write("sheet.json", weightless).string();
    const XServer display;
    if (is_missing(display))
        return;
    Session session(display, folder, {scene}, "1000x760");
    XWindow& window = session.window;
    (void)picture_when(window, shows_panel);
    // A step shows that a frame has seen what was before it.
    const auto click = [&](int x, int y)
    {
        window.move(x, y);
        session.step(1);
        window.button(1, true);
        session.step(1);
        window.button(1, false);
        session.step(1);
    };
    window.move(110, 45); // step
    session.step(1);
    window.button(1, true);
    session.step(1);
    const int frame = session.frame();
    window.button(1, false);
    REQUIRE(window.wait_for_title("at frame " + std::to_string(frame + 1)));
    click(150, 154); // folds times and energy
    const voile::engine::Picture plain = window.picture();
    click(25, 200); // wireframe
    keep("wires.png", picture_when(window, [&](const voile::engine::Picture& picture)
                                   { return difference(picture, plain, 400, 1000) > 0.2; }));
    click(150, 177); // folds the views
    click(150, 223); // unfolds wind and step
    click(62, 269);  // the upper end of the wind along x
    keep("sliders.png", window.picture());
    click(55, 131); // save scene
    const std::filesystem::path saved = folder / "sheet_1.json";
    REQUIRE(ViewerProcess::wait_until([&] { return std::filesystem::exists(saved); }));
    const auto tree = viewer::parse_json(tests::text_of(saved), "scene");
    REQUIRE(tree);
    const viewer::JsonNode* wind = tree.value().find("wind");
    REQUIRE(wind != nullptr);
    CHECK(wind->find("velocity")->items[0].number > 100);
    CHECK(wind->find("velocity")->items[1].number == 0);
    session.close();
}

// scripts/pictures.sh runs it for docs/window.png, ctest does not: ffmpeg takes the picture, which has the cursor.
TEST_CASE("the picture of the window" * doctest::skip())
{
    const char* pictures = std::getenv("VOILE_WINDOW_PICTURES");
    REQUIRE(pictures != nullptr);
    const TestFolder folder;
    const std::string scene = folder.write("sheet.json", k_pulled_sheet).string();
    const XServer display;
    REQUIRE(!display.name().empty());
    Session session(display, folder, {scene, "--debug", "strain"}, "1280x720");
    XWindow& window = session.window;
    session.step(40);
    window.move(760, 330);
    window.button(1, true);
    for (int i = 1; i <= 10; ++i)
    {
        window.move(760 + 10 * i, 330 - 18 * i);
        session.step(1);
    }
    session.step(6);
    const std::string take = "ffmpeg -loglevel error -y -f x11grab -video_size 1280x720 -i " + display.name() +
                             " -frames:v 1 " + pictures + "/window.png </dev/null";
    CHECK(std::system(take.c_str()) == 0);
    window.button(1, false);
    session.close();
}

#endif
