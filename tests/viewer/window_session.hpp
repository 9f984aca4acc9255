// The viewer in a window on a virtual display, and what tests read from it.
#pragma once

#include "support/test_folder.hpp"
#include "viewer/viewer_process.hpp"
#include "viewer/x_display.hpp"

#include "samples/viewer/json_tree.hpp"

#include <X11/keysym.h>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>

namespace tests
{

inline const std::vector<std::string> k_flag{"flag", "--cloth-resolution", "16"};

// ctest skips tests with this message.
inline bool is_missing(const XServer& display)
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
                       ::setenv("XDG_RUNTIME_DIR", "/nowhere", 0); // Wayland's library prints an error without one
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

inline Statistics read_statistics(const std::filesystem::path& path)
{
    const auto tree = viewer::parse_json(text_of(path), "statistics");
    REQUIRE(tree);
    return {tree.value().find("frames")->number, tree.value().find("summary")->find("state_hash")->text};
}

// The same run without a window.
inline Statistics headless(const TestFolder& folder, std::vector<std::string> arguments, int frames)
{
    const std::filesystem::path file = folder / "headless.json";
    arguments.insert(arguments.end(), {"--headless", "--frames", std::to_string(frames), "--stats", file.string()});
    ViewerProcess process(arguments);
    const Ending ending = process.wait();
    CAPTURE(ending.errors);
    REQUIRE(ending.exit_code == 0);
    return read_statistics(file);
}

inline std::vector<std::string> with(std::vector<std::string> list, std::initializer_list<std::string> more)
{
    list.insert(list.end(), more);
    return list;
}

// How much two pictures differ in a rectangle: the mean over its channels, 0..255.
inline double difference(const voile::engine::Picture& a, const voile::engine::Picture& b, uint32_t left,
                         uint32_t right)
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
inline bool shows_panel(const voile::engine::Picture& picture)
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

inline voile::engine::Picture hide_panel(XWindow& window)
{
    window.press(XK_Tab);
    return picture_when(window, [](const voile::engine::Picture& picture) { return !shows_panel(picture); });
}

} // namespace tests
