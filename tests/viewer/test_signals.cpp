// The viewer is asked to end, at any time: nothing unfinished stays, nothing complete is lost.
#include "viewer/viewer_process.hpp"

#include "samples/viewer/json_tree.hpp"

#include <doctest/doctest.h>

#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace
{

namespace fs = std::filesystem;
using tests::Ending;
using tests::ViewerProcess;

// Without contact, so that the first frame comes soon.
const std::vector<std::string> k_endless = {"flag",   "--headless", "--frames",           "100000000",
                                            "--size", "64x36",      "--cloth-resolution", "16"};

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more)
{
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

std::vector<fs::path> unfinished(const TestFolder& folder)
{
    std::vector<fs::path> result;
    for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
        if (entry.path().extension() == ".part")
            result.push_back(entry.path());
    return result;
}

bool has_ffmpeg()
{
    return std::system("ffmpeg -version >/dev/null 2>&1") == 0;
}

} // namespace

TEST_CASE("a run that a signal ends leaves no unfinished file and keeps complete ones")
{
    for (const int signal : {SIGHUP, SIGTERM})
    {
        CAPTURE(signal);
        const TestFolder folder;
        folder.write("c.pc2", "complete");
        folder.write("f.mp4", "complete");
        std::vector<std::string> arguments =
            with(k_endless, {"--export", (folder / "c.pc2").string(), "--out", (folder / "frames").string()});
        const bool film = has_ffmpeg();
        if (film)
            arguments = with(arguments, {"--video", (folder / "f.mp4").string()});
        ViewerProcess viewer(arguments);
        // Both files are begun, and frames come.
        const auto is_running = [&]
        { return unfinished(folder).size() >= (film ? 2u : 1u) && fs::exists(folder / "frames/frame_0003.png"); };
        REQUIRE(ViewerProcess::wait_until(is_running));
        viewer.send(signal);
        const Ending ending = viewer.wait();
        CHECK(ending.signal == signal);
        CHECK(ending.errors.find("viewer: interrupted by SIG") != std::string::npos);
        std::this_thread::sleep_for(std::chrono::milliseconds(50)); // an encoder that lives on would write
        CHECK(unfinished(folder).empty());
        CHECK(folder.read("c.pc2") == "complete");
        CHECK(folder.read("f.mp4") == "complete");
    }
}

TEST_CASE("Ctrl-C finishes all files with the frames so far")
{
    const TestFolder folder;
    const auto path = [&](const char* name) { return (folder / name).string(); };
    std::vector<std::string> arguments =
        with(k_endless, {"--export", path("c.pc2"), "--export", path("c.usda"), "--export", path("c.obj"), "--stats",
                         path("s.json"), "--out", path("frames"), "--every", "5"});
    const bool film = has_ffmpeg();
    if (film)
        arguments = with(arguments, {"--video", path("f.mp4")});
    ViewerProcess viewer(arguments);
    REQUIRE(ViewerProcess::wait_until([&] { return fs::exists(folder / "frames/frame_0005.png"); }));
    viewer.send(SIGINT);
    const Ending ending = viewer.wait();
    CHECK(ending.signal == SIGINT);
    CHECK(ending.errors.find("viewer: interrupted; files are finished with the frames so far") != std::string::npos);
    CHECK(unfinished(folder).empty());
    for (const char* name : {"c.pc2.json", "c.usda", "c.obj"})
        CHECK(fs::exists(folder / name));
    CHECK(fs::exists(folder / "f.mp4") == film);
    const auto statistics = viewer::parse_json(folder.read("s.json"), "s.json");
    REQUIRE(statistics);
    const auto frames = static_cast<size_t>(statistics.value().find("frames")->number);
    CHECK(frames >= 6);
    CHECK(statistics.value().find("per_frame")->items.size() == frames);
    CHECK(fs::file_size(folder / "c.pc2") == 32 + (frames + 1) * 16 * 16 * 12);
    // The last state has a picture.
    std::string number = std::to_string(frames - 1);
    number.insert(0, 4 - number.size(), '0');
    CHECK(fs::exists(folder / ("frames/frame_" + number + ".png")));
}

TEST_CASE("a second Ctrl-C ends a run at once")
{
    const TestFolder folder;
    folder.write("c.pc2", "complete");
    // An encoder that never ends keeps the viewer from finishing, however fast its frames are.
    const fs::path encoder = folder.write("ffmpeg", "#!/bin/sh\ncat >/dev/null\nexec sleep 600\n");
    fs::permissions(encoder, fs::perms::owner_all);
    const auto with_encoder = [&]
    {
        const char* path = std::getenv("PATH");
        ::setenv("PATH", (folder.path().string() + ":" + (path != nullptr ? path : "")).c_str(), 1);
    };
    ViewerProcess viewer(with(k_endless, {"--export", (folder / "c.pc2").string(), "--video",
                                          (folder / "f.mp4").string(), "--out", (folder / "frames").string()}),
                         with_encoder);
    REQUIRE(ViewerProcess::wait_until([&] { return fs::exists(folder / "frames/frame_0000.png"); }));
    viewer.send(SIGINT);
    const auto asked = [&] { return viewer.errors().find("Again: ends at once") != std::string::npos; };
    REQUIRE(ViewerProcess::wait_until(asked));
    viewer.send(SIGINT);
    const Ending ending = viewer.wait();
    CHECK(ending.signal == SIGINT);
    CHECK(ending.errors.find("viewer: interrupted by SIGINT; unfinished files are gone") != std::string::npos);
    CHECK(unfinished(folder).empty());
    CHECK(folder.read("c.pc2") == "complete");
    CHECK(!fs::exists(folder / "f.mp4"));
}

TEST_CASE("a file size limit is an error like a full disk")
{
    const TestFolder folder;
    folder.write("c.pc2", "complete");
    ViewerProcess viewer(with(k_endless, {"--export", (folder / "c.pc2").string()}));
    // A driver may keep device memory in files, which it has when frames come.
    const auto exports = [&]
    {
        const std::vector<fs::path> files = unfinished(folder);
        return !files.empty() && fs::file_size(files[0]) > 0;
    };
    REQUIRE(ViewerProcess::wait_until(exports));
    viewer.limit_files(100'000);
    const Ending ending = viewer.wait();
    CHECK(ending.exit_code == 1);
    CHECK(ending.errors.find("c.pc2: cannot be written: File too large") != std::string::npos);
    CHECK(unfinished(folder).empty());
    CHECK(folder.read("c.pc2") == "complete");
}

TEST_CASE("a closed terminal does not end a run")
{
    const TestFolder folder;
    const auto broken = []
    {
        int ends[2];
        if (::pipe(ends) != 0)
            ::_exit(126);
        ::close(ends[0]);
        ::dup2(ends[1], STDERR_FILENO);
        ::dup2(ends[1], STDOUT_FILENO);
    };
    ViewerProcess viewer({"flag", "--headless", "--frames", "20", "--size", "64x36", "--cloth-resolution", "16",
                          "--stats", (folder / "s.json").string(), "--export", (folder / "c.pc2").string()},
                         broken);
    const Ending ending = viewer.wait();
    CHECK(ending.signal == 0);
    CHECK(ending.exit_code == 0);
    CHECK(fs::file_size(folder / "c.pc2") == 32 + 21 * 16 * 16 * 12);
    CHECK(fs::exists(folder / "s.json"));
    CHECK(unfinished(folder).empty());
}

TEST_CASE("a pipe instead of a scene or a mesh is refused and delays no signal")
{
    const TestFolder folder;
    const std::string fifo = (folder / "pipe.obj").string();
    REQUIRE(::mkfifo(fifo.c_str(), 0600) == 0);
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{fifo, "--headless"}, {"flag", "--headless", "--collider", fifo}})
    {
        ViewerProcess viewer(arguments);
        const Ending ending = viewer.wait();
        CHECK(ending.exit_code == 1);
        CHECK(ending.errors == "viewer: " + fifo + ": cannot read: not a regular file\n");
    }
    // Where the viewer does wait for somebody else, signals end it: a pipe as a target has no reader.
    ViewerProcess viewer({"flag", "--headless", "--frames", "1", "--stats", fifo});
    std::this_thread::sleep_for(std::chrono::seconds(1));
    viewer.send(SIGINT);
    CHECK(viewer.wait().signal == SIGINT);
}

TEST_CASE("ignored signals stay ignored, as nohup requires")
{
    const TestFolder folder;
    ViewerProcess viewer({"flag", "--headless", "--frames", "80", "--size", "64x36", "--cloth-resolution", "16",
                          "--export", (folder / "c.pc2").string()},
                         [] { ::signal(SIGHUP, SIG_IGN); });
    REQUIRE(ViewerProcess::wait_until([&] { return !unfinished(folder).empty(); }));
    viewer.send(SIGHUP);
    CHECK(viewer.wait().exit_code == 0);
    CHECK(fs::exists(folder / "c.pc2"));
}
