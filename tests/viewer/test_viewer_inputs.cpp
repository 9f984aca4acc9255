// Large and odd input, as the program takes it.
#include "viewer/viewer_process.hpp"

#include "samples/viewer/json_tree.hpp"
#include "voile/engine/gpu/device.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

namespace
{

using tests::Ending;
using tests::Run;
using tests::run_viewer;
using tests::ViewerProcess;

const std::string k_cloth = R"({"grid": {"vertices": [3, 3], "size": [1, 1]}, "material": "silk"})";

std::string repeated(const std::string& item, int count)
{
    std::string result = item;
    for (int i = 1; i < count; ++i)
        result += "," + item;
    return result;
}

// Builds the scene and runs no frame.
Ending build(const TestFolder& folder, const std::string& scene)
{
    const auto file = folder.write("s.json", scene);
    return ViewerProcess({file.string(), "--headless", "--frames", "0", "--size", "64x36"}).wait();
}

} // namespace

TEST_CASE("round colliders share their drawn meshes")
{
    const TestFolder folder;
    const auto peak = [&](const std::string& collider, int count)
    {
        const Ending ending =
            build(folder, "{\"cloths\": [" + k_cloth + "],\"colliders\": [" + repeated(collider, count) + "]}");
        CHECK(ending.exit_code == 0);
        return ending.peak_kib;
    };
    const std::string sphere = R"({"sphere": {"center": [0, 0, 0], "radius": 0.5}})";
    const std::string capsule = R"({"capsule": {"from": [0, 0, 0], "to": [1, 0, 0], "radius": 0.5}})";
    (void)peak(sphere, 2000); // drivers that keep compiled kernels take hundreds of MB to compile them in the first run
    const long one = peak(sphere, 1);
    CHECK(peak(sphere, 2000) - one < 50'000); // 5 MB measured, 1.4 GB with a mesh each
    CHECK(peak(capsule, 2000) - one < 50'000);
}

TEST_CASE("very many cloths start quickly")
{
    const TestFolder folder;
    const std::string pinned =
        R"({"grid": {"vertices": [3, 3], "size": [1, 1]}, "material": "silk", "pins": ["corner:0"]})";
    const auto start = std::chrono::steady_clock::now();
    CHECK(build(folder, "{\"cloths\": [" + repeated(pinned, 30000) + "]}").exit_code == 0);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    CHECK(elapsed.count() < 30);
}

TEST_CASE("a film without frames is refused, and everything else is written")
{
    const TestFolder folder;
    const Run run = run_viewer("reference --headless --frames 0 --size 64x36 --cloth-resolution 8 --video " +
                               (folder / "f.mp4").string() + " --stats " + (folder / "s.json").string() + " --export " +
                               (folder / "c.obj").string());
    if (run.errors.find("not installed") != std::string::npos)
        return;
    CHECK(run.exit_code == 1);
    CHECK(run.errors.find("f.mp4: no film: there are no frames\n") != std::string::npos);
    CHECK(run.output.find("s.json\n") != std::string::npos);
    CHECK(viewer::parse_json(folder.read("s.json"), "s.json"));
    CHECK(folder.read("c.obj").find("\nv ") != std::string::npos);
    CHECK(folder.entries() == 2);
}

TEST_CASE("a run without frames has the state of the start")
{
    const TestFolder folder;
    const auto file = folder.write("s.json", R"({"cloths": [{"grid": {"vertices": [2, 2], "size": [2, 4]},
        "transform": {"translate": [0, 1, 0]}, "pins": ["corner:0"]}]})");
    const Run run = run_viewer(file.string() + " --headless --frames 0 --size 64x36 --verify --validate --export " +
                               (folder / "c.obj").string() + " --stats " + (folder / "t.json").string());
    CHECK(run.exit_code == 0);
    CHECK(folder.read("c.obj").find("v -1 1 -2\nv 1 1 -2\nv -1 1 2\nv 1 1 2\nvt 0 1\nvt 1 1\nvt 0 0\nvt 1 0\n"
                                    "vn 0 1 0\nvn 0 1 0\nvn 0 1 0\nvn 0 1 0\nf 1/1/1 3/3/3 4/4/4 2/2/2\n") !=
          std::string::npos);
    CHECK(folder.read("t.json").find("\"verified\": true") != std::string::npos);
}

TEST_CASE("names from files and the command line are printed safely")
{
    const TestFolder folder;
    const std::string odd = "\x1b]0;title\x07\n";
    const auto check = [&](const Run& run)
    {
        CAPTURE(run.errors);
        CHECK(run.exit_code == 1);
        CHECK(run.errors.find('\x1b') == std::string::npos);
        CHECK(run.errors.find('\x07') == std::string::npos);
        CHECK(std::count(run.errors.begin(), run.errors.end(), '\n') == 1);
        CHECK(run.errors.size() < 600);
    };
    folder.write(odd + ".obj", "v 0 0 0\n");
    folder.write(odd + ".json", "{\"cloths\": [{\"mesh\": \"\\u001b]0;title\\u0007\\n.obj\"}]}");
    check(run_viewer('\'' + (folder / (odd + ".json")).string() + "' --headless"));
    check(run_viewer("reference --headless --collider '" + (folder / (odd + ".obj")).string() + "'"));
    check(run_viewer("reference --headless --frames 1 --device '" + odd + std::string(100000, 'd') + "'"));
    check(run_viewer("'" + odd + std::string(100000, 's') + "' --headless"));
    check(run_viewer("reference --headless --stats '" + (folder / ("gone" + odd + "/s.json")).string() + "'"));
    check(run_viewer("reference --headless --frames 1 --out '" + (folder / (odd + ".obj/frames")).string() + "'"));
}

TEST_CASE("watched shaders need their files and a compiler, whose absence is reported once")
{
    const TestFolder folder;
    const std::string scene = folder.write("s.json", "{\"cloths\": [" + k_cloth + "]}").string();
    const std::string arguments = "'" + scene + "' --headless --frames 3 --size 64x36 --shaders '";
    tests::check_refused(run_viewer(arguments + folder.path().string() + "'"), {"--shaders", "has no dot.vert"});
    const Run run = run_viewer(arguments + tests::source("shaders/render").string() + "'", "PATH=/nonexistent");
    CHECK(run.exit_code == 0);
    const std::string line = "viewer: shaders: glslangValidator is not installed (or not in PATH)\n";
    CHECK(run.errors.find(line) == 0);
    CHECK(run.errors.rfind(line) == 0);
}

TEST_CASE("a device that is not there is named with the one that was likely meant")
{
    std::string name = voile::engine::list_devices().front().name;
    name = name.substr(0, name.find(' ')); // its first word, with two letters swapped
    std::string wrong = name;
    std::swap(wrong[1], wrong[2]);
    if (wrong == name)
        wrong += 'x';
    tests::check_refused(run_viewer("drape --headless --frames 0 --device " + wrong),
                         {"--device: no device is called \"" + wrong + "\"; did you mean \"" + name + "\"?"});
}

TEST_CASE("what is refused while it is loaded or moves is named with its line and entry")
{
    const TestFolder folder;
    folder.write("none.obj", "v 0 0 0\n");
    folder.write("w_0.obj", "v 0 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\n");
    folder.write("w_1.obj", "v 3e38 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\n");
    const auto check = [&](const std::string& pins, const std::string& collider, const char* place, const char* reason)
    {
        CAPTURE(std::string(place));
        const auto file =
            folder.write("s.json", "{\"step\": {\"rate\": 2},\n\"cloths\": [\n{\"grid\": {\"vertices\": [3, 3], "
                                   "\"size\": [1, 1]}, \"pins\": [" +
                                       pins + "]}],\n\"colliders\": [\n" + collider + "]}");
        const Run run = run_viewer(file.string() + " --headless --frames 3 --size 64x36");
        CHECK(run.exit_code == 1);
        CHECK(run.errors.find(file.string() + place) != std::string::npos);
        CHECK(run.errors.find(reason) != std::string::npos);
    };
    const std::string plane = R"({"plane": {"y": -1}})";
    check("", R"({"mesh": "none.obj"})", ":5: colliders[0].mesh: ", "none.obj: no faces\n");
    check("", R"({"sphere": {"center": [999999, 0, 0], "radius": 1}, "motion": {"velocity": [10000, 0, 0]}})",
          ":5: colliders[0].motion: ", "its center is (");
    check("", R"({"frames": "w_%d.obj", "rate": 2})", ":5: colliders[0].frames: ", "position 0 is at (");
    check(R"({"at": "corner:0", "motion": {"spin": [0, 3e38, 0], "velocity": [0, 0, 0]}})", plane,
          ":3: cloths[0].pins[0].motion: ", "its transform is not finite\n");
}
