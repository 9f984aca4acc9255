// The viewer's window on a virtual display: real keys, a real mouse, and what a window manager does.
#include "support/test_folder.hpp"
#include "viewer/viewer_process.hpp"
#include "viewer/x_display.hpp"

#include "samples/viewer/json_tree.hpp"

#include <X11/keysym.h>

#include <doctest/doctest.h>

#include <cstdlib>
#include <optional>

namespace
{

using tests::Ending;
using tests::ViewerProcess;
using tests::XServer;
using tests::XWindow;

const std::vector<std::string> k_small{"reference", "--cloth-resolution", "16", "--validate"};

// The viewer in a window, paused.
class Session
{
public:
    explicit Session(std::vector<std::string> more, const std::string& size = "320x180")
        : process_(arguments(std::move(more), size), [&] { ::setenv("DISPLAY", server_.name().c_str(), 1); }),
          window(server_, "voile: ")
    {
        REQUIRE(!server_.name().empty());
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
    Ending close()
    {
        window.close();
        Ending ending = process_.wait();
        CAPTURE(ending.errors);
        CHECK(ending.exit_code == 0);
        CHECK(ending.errors.empty());
        return ending;
    }

    Ending wait() { return process_.wait(); }

private:
    static std::vector<std::string> arguments(std::vector<std::string> more, const std::string& size)
    {
        std::vector<std::string> all = k_small;
        all.insert(all.end(), {"--size", size, "--paused"});
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }

    XServer server_;
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
Statistics headless(const TestFolder& folder, int frames)
{
    const std::filesystem::path file = folder / "headless.json";
    ViewerProcess process({"reference", "--cloth-resolution", "16", "--headless", "--frames", std::to_string(frames),
                           "--stats", file.string()});
    REQUIRE(process.wait().exit_code == 0);
    return read_statistics(file);
}

} // namespace

TEST_CASE("a period takes one step while paused, and R starts again")
{
    const TestFolder folder;
    const std::string stats = (folder / "stats.json").string();
    Session session({"--stats", stats});
    session.step(3);
    session.window.press(XK_r);
    REQUIRE(session.window.wait_for_title("at frame 0"));
    session.step(2);
    session.close();
    const Statistics statistics = read_statistics(stats);
    CHECK(statistics.frames == 2);
    CHECK(statistics.hash == headless(folder, 2).hash);
}

TEST_CASE("space pauses and continues, and nothing is simulated while paused or minimized")
{
    Session session({});
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
    Session session({});
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
