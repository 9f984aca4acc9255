// The viewer's window on a virtual display: real keys, a real mouse, and what a window manager does.
#include "support/test_folder.hpp"
#include "viewer/viewer_process.hpp"
#include "viewer/x_display.hpp"

#include "samples/viewer/json_tree.hpp"

#include <X11/keysym.h>

#include <doctest/doctest.h>
#include <glm/glm.hpp>

#include <cmath>
#include <cstdlib>
#include <cstring>

namespace
{

using tests::Ending;
using tests::ViewerProcess;
using tests::XServer;
using tests::XWindow;

const std::vector<std::string> k_reference{"reference", "--cloth-resolution", "16"};

// ctest skips tests with this message.
bool is_missing(const XServer& display)
{
    if (display.name().empty())
        MESSAGE("skipped: no display, because Xvfb is not installed or did not start");
    return display.name().empty();
}

// The viewer in a window, paused, with validation. It runs in `folder`.
class Session
{
public:
    Session(const XServer& display, const TestFolder& folder, std::vector<std::string> arguments,
            const std::string& size = "320x180")
        : process_(complete(std::move(arguments), size),
                   [&]
                   {
                       ::setenv("DISPLAY", display.name().c_str(), 1);
                       (void)!::chdir(folder.path().c_str());
                   }),
          window(display, "voile: ")
    {
        REQUIRE(window.wait());
        REQUIRE(window.wait_for_title("paused at frame 0"));
    }

    // Steps, one key each.
    void step(int count)
    {
        for (int i = 0; i < count; ++i)
        {
            const int frame = this->frame();
            window.press(XK_period);
            REQUIRE(window.wait_for_title("at frame " + std::to_string(frame + 1)));
        }
    }

    // At which it is paused.
    int frame()
    {
        const std::string title = window.title();
        const size_t number = title.rfind(' ');
        REQUIRE(title.find("at frame ") != std::string::npos);
        return std::atoi(title.c_str() + number + 1);
    }

    // Closes the window. No validation message, and exit code 0.
    Ending close(bool with_errors = false)
    {
        window.close();
        Ending ending = process_.wait();
        CAPTURE(ending.errors);
        CHECK(ending.exit_code == 0);
        CHECK(ending.errors.empty() == !with_errors);
        return ending;
    }

    Ending wait() { return process_.wait(); }
    bool wait_for_errors(const std::string& part)
    {
        return ViewerProcess::wait_until([&] { return process_.errors().find(part) != std::string::npos; });
    }

private:
    static std::vector<std::string> complete(std::vector<std::string> arguments, const std::string& size)
    {
        arguments.insert(arguments.end(), {"--size", size, "--paused", "--validate"});
        return arguments;
    }

    ViewerProcess process_;

public:
    XWindow window;
};

struct Statistics
{
    double frames = 0;
    std::string hash;
};

Statistics read_statistics(const std::filesystem::path& path)
{
    const auto tree = viewer::parse_json(tests::text_of(path), "statistics");
    REQUIRE(tree);
    return {tree.value().find("frames")->number, tree.value().find("summary")->find("state_hash")->text};
}

// The same run without a window.
Statistics headless(const TestFolder& folder, std::vector<std::string> arguments, int frames)
{
    const std::filesystem::path file = folder / "headless.json";
    arguments.insert(arguments.end(), {"--headless", "--frames", std::to_string(frames), "--stats", file.string()});
    ViewerProcess process(arguments);
    const Ending ending = process.wait();
    CAPTURE(ending.errors);
    REQUIRE(ending.exit_code == 0);
    return read_statistics(file);
}

std::vector<std::string> with(std::vector<std::string> list, std::initializer_list<std::string> more)
{
    list.insert(list.end(), more);
    return list;
}

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

// How much two pictures differ in a rectangle: the mean over its channels, 0..255.
double difference(const voile::engine::Picture& a, const voile::engine::Picture& b, uint32_t left, uint32_t right)
{
    REQUIRE(a.rgba.size() == b.rgba.size());
    double sum = 0;
    for (uint32_t y = 0; y < a.height; ++y)
        for (uint32_t x = left; x < right; ++x)
            for (uint32_t c = 0; c < 3; ++c)
            {
                const size_t i = 4 * (size_t{y} * a.width + x) + c;
                sum += std::abs(static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i]));
            }
    return sum / (3.0 * a.height * (right - left));
}

// A dark bar where the panel has its title, and otherwise sky or ground.
bool shows_panel(const voile::engine::Picture& picture)
{
    const uint8_t* p = &picture.rgba[size_t{4} * (size_t{14} * picture.width + 150)];
    return p[0] + p[1] + p[2] < 330;
}

// The window once it fulfills the condition.
template <typename Condition>
voile::engine::Picture picture_when(XWindow& window, Condition condition)
{
    voile::engine::Picture picture;
    CHECK(ViewerProcess::wait_until([&] { return condition(picture = window.picture()); }));
    return picture;
}

voile::engine::Picture hide_panel(XWindow& window)
{
    window.press(XK_Tab);
    return picture_when(window, [](const voile::engine::Picture& picture) { return !shows_panel(picture); });
}

} // namespace

TEST_CASE("a period takes one step while paused, and R starts again")
{
    const XServer display;
    if (is_missing(display))
        return;
    const TestFolder folder;
    const std::string stats = (folder / "stats.json").string();
    Session session(display, folder, with(k_reference, {"--stats", stats}));
    session.step(3);
    session.window.press(XK_r);
    REQUIRE(session.window.wait_for_title("at frame 0"));
    session.step(2);
    session.close();
    const Statistics statistics = read_statistics(stats);
    CHECK(statistics.frames == 2);
    CHECK(statistics.hash == headless(folder, k_reference, 2).hash);
}

TEST_CASE("space pauses and continues, and nothing is simulated while paused or minimized")
{
    const XServer display;
    if (is_missing(display))
        return;
    const TestFolder folder;
    Session session(display, folder, k_reference);
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
    const XServer display;
    if (is_missing(display))
        return;
    const TestFolder folder;
    Session session(display, folder, k_reference);
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
    const XServer display;
    if (is_missing(display))
        return;
    const TestFolder folder;
    const std::filesystem::path scene = folder.write("sheet.json", k_sheet);
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
    const XServer display;
    if (is_missing(display))
        return;
    const TestFolder folder;
    const std::filesystem::path scene = folder.write("sheet.json", k_hidden_sheet);
    const std::string stats = (folder / "stats.json").string();
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
    const XServer display;
    if (is_missing(display))
        return;
    const TestFolder folder;
    const std::string box =
        folder.write("box.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n").string();
    const std::string scene =
        folder
            .write("fast.json",
                   R"({"cloths": [{"grid": {"vertices": [9, 9], "size": [1, 1]}}], "gravity": [0, -100, 0]})")
            .string();
    const std::string stats = (folder / "stats.json").string();
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
    const std::vector<std::string> arguments = with(k_reference, {"--shaders", (folder / "shaders").string()});
    const std::string stats = (folder / "stats.json").string();
    Session session(folder, with(arguments, {"--stats", stats}));
    XWindow& window = session.window;
    session.step(2);
    write("forces/forces.glsl", "* push.gravity;", "* -push.gravity;");
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
    CHECK(hash != headless(folder, k_reference, 2).hash);
}

TEST_CASE("a changed shader changes the picture, and a broken one is reported by its line")
{
    const XServer display;
    if (is_missing(display))
        return;
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
    Session session(display, folder, with(k_reference, {"--shaders", (folder / "shaders/render").string()}));
    XWindow& window = session.window;
    const voile::engine::Picture before = hide_panel(window);
    write("return gradient + glow;", "return vec3(1, 0, 0);");
    const voile::engine::Picture red = picture_when(window, [&](const voile::engine::Picture& picture)
                                                    { return difference(picture, before, 0, 320) > 20; });
    write("return gradient + glow;", "return gradient + gloom;");
    REQUIRE(session.wait_for_errors("sky.glsl:15: 'gloom' : undeclared identifier"));
    session.step(1); // a frame with the last shaders that work
    CHECK(difference(window.picture(), red, 0, 320) < 2);
    write("return gradient + glow;", "return gradient + glow;");
    REQUIRE(session.wait_for_errors("the shaders are compiled again"));
    (void)picture_when(window,
                       [&](const voile::engine::Picture& picture) { return difference(picture, before, 0, 320) < 2; });
    session.close(true);
}

#if VOILE_HAS_PANEL

namespace
{

// For people who want to see what these tests see.
void keep(const char* name, const voile::engine::Picture& picture)
{
    if (const char* folder = std::getenv("VOILE_WINDOW_PICTURES"))
        CHECK(voile::engine::save_png(std::filesystem::path(folder) / name, picture));
}

} // namespace

TEST_CASE("the panel shows and hides, and a picture is saved without it")
{
    const XServer display;
    if (is_missing(display))
        return;
    const TestFolder folder;
    Session session(display, folder, k_reference, "640x400");
    XWindow& window = session.window;
    session.step(2);
    window.press(XK_F2);
    const std::filesystem::path saved = folder / "reference_1.png";
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
    const XServer display;
    if (is_missing(display))
        return;
    const TestFolder folder;
    const std::string weightless = std::string(k_sheet).replace(0, 1, "{\"gravity\": [0, 0, 0],"); // it does not move
    const std::string scene = folder.write("sheet.json", weightless).string();
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

#endif
