// The viewer as its users run it: what it writes, and the one clear line that bad input gets.
#include "support/test_folder.hpp"
#include "viewer/viewer_run.hpp"

#include "samples/viewer/json_tree.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

namespace
{

namespace fs = std::filesystem;
using tests::check_refused;
using tests::Run;
using tests::run_viewer;
using tests::text_of;

// The reference scene in small.
const std::string k_small = "reference --headless --size 64x36 --cloth-resolution 24 ";

const std::string k_triangle = "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 3 2\n";

std::string scene_with(const std::string& cloth, const std::string& rest = "")
{
    return "{\n\"cloths\": [" + cloth + "]" + rest + "\n}\n";
}

const std::string k_cloth = R"({"grid": {"vertices": [16, 16], "size": [1, 1]}, "material": "cotton"})";

} // namespace

TEST_CASE("a mesh that cannot be used is named with its line and the reason")
{
    const TestFolder folder;
    struct Case
    {
        std::string name;
        std::string text;
        std::vector<std::string> parts;
    };
    const Case cases[] = {
        {"empty.obj", "", {"empty.obj"}},
        {"cut.obj", "v 0 0 0\nv 1 0 0\nv 0 0", {"cut.obj:3"}},
        {"letters.obj", "v 0 0 0\nv 1 x 0\n", {"letters.obj:2"}},
        {"index.obj", k_triangle + "f 1 2 9\n", {"index.obj:5", "9"}},
        {"zero.obj", k_triangle + "f 0 1 2\n", {"zero.obj:5"}},
        {"nan.obj", "v 0 nan 0\n" + k_triangle, {"nan.obj:1"}},
        {"infinite.obj", "v 0 1e999 0\n" + k_triangle, {"infinite.obj:1"}},
        {"points.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\n", {"points.obj"}},
        {"flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", {"flat.obj"}},
        {"text.obj", "not a mesh at all\n", {"text.obj"}},
    };
    for (const Case& c : cases)
    {
        CAPTURE(c.name);
        const fs::path file = folder.write(c.name, c.text);
        check_refused(run_viewer(k_small + "--frames 1 --collider " + file.string()), c.parts);
    }
    check_refused(run_viewer(k_small + "--collider " + (folder / "missing.obj").string()), {"missing.obj"});
}

TEST_CASE("a scene that cannot be used is named with its path and the reason")
{
    const TestFolder folder;
    struct Case
    {
        std::string name;
        std::string text;
        std::vector<std::string> parts;
    };
    const Case cases[] = {
        {"empty.json", "", {"empty.json"}},
        {"cut.json", "{\"cloths\": [", {"cut.json:1"}},
        {"comma.json", "{\n\"cloths\": [],\n}", {"comma.json:3"}},
        {"key.json", scene_with(k_cloth, ",\n\"gravty\": [0, -9.81, 0]"), {"key.json:3", "gravty"}},
        {"preset.json",
         scene_with(R"({"grid": {"vertices": [8, 8], "size": [1, 1]}, "material": "chiffon"})"),
         {"preset.json:2", "chiffon"}},
        {"one.json",
         scene_with(R"({"grid": {"vertices": [1, 8], "size": [1, 1]}, "material": "silk"})"),
         {"one.json:2", "vertices"}},
        {"none.json",
         scene_with(R"({"grid": {"vertices": [8, 0], "size": [1, 1]}, "material": "silk"})"),
         {"none.json:2", "vertices"}},
        {"size.json",
         scene_with(R"({"grid": {"vertices": [8, 8], "size": [1, 1e999]}, "material": "silk"})"),
         {"size.json:2"}},
        {"mesh.json",
         scene_with(k_cloth, ",\n\"colliders\": [{\"mesh\": \"nowhere.obj\"}]"),
         {"mesh.json:3", "nowhere.obj"}},
        {"raw.json",
         scene_with(R"({"grid": {"vertices": [8, 8], "size": [1, 1]},
"material": {"preset": "reference", "areal_density": 0.2}})"),
         {"raw.json:3", "reference"}},
        {"pin.json",
         scene_with(R"({"grid": {"vertices": [8, 8], "size": [1, 1]}, "material": "silk",
"pins": ["vertex:64"]})"),
         {"pin.json", "64"}},
    };
    for (const Case& c : cases)
    {
        CAPTURE(c.name);
        const fs::path file = folder.write(c.name, c.text);
        check_refused(run_viewer(file.string() + " --headless --frames 1 --size 64x36"), c.parts);
    }
    check_refused(run_viewer("nosuchscene --headless"), {"nosuchscene", "reference"});
    check_refused(run_viewer((folder / "missing.json").string() + " --headless"), {"missing.json"});
}

TEST_CASE("options that cannot be used are named")
{
    check_refused(run_viewer(k_small + "--cloth-resolution 0"), {"--cloth-resolution"});
    check_refused(run_viewer("reference --headless --cloth-resolution 1"), {"--cloth-resolution", "1"});
    check_refused(run_viewer("reference --headless --cloth-resolution 100000"), {"--cloth-resolution", "100000"});
    check_refused(run_viewer(k_small + "--device no-such-card"), {"no-such-card"});
    check_refused(run_viewer(k_small + "--frobnicate"), {"--frobnicate"});
    check_refused(run_viewer(k_small + "--frames many"), {"--frames", "many"});
    check_refused(run_viewer("reference --headless --size 0x10"), {"--size", "0x10"});
}

TEST_CASE("a cloth beyond the device's memory is refused, not crashed on")
{
    const Run run = run_viewer("reference --headless --frames 1 --size 64x36 --cloth-resolution 8192");
    if (run.exit_code != 0) // a device with hundreds of GiB may take it
        check_refused(run, {"8192 x 8192", "MiB"});
}

TEST_CASE("files that cannot be written are refused before the run, and nothing is left behind")
{
    const TestFolder folder;
    const fs::path file = folder.write("file", "in the way");
    check_refused(run_viewer(k_small + "--frames 1 --out " + (file / "frames").string()), {"--out", "frames"});
    check_refused(run_viewer(k_small + "--frames 1 --out " + file.string()), {"--out", "file"});
    check_refused(run_viewer(k_small + "--frames 1 --stats " + (folder / "nowhere/s.json").string()), {"s.json"});
    check_refused(run_viewer(k_small + "--frames 1 --export " + (folder / "nowhere/c.obj").string()), {"c.obj"});
    check_refused(run_viewer(k_small + "--frames 1 --out /proc/nowhere"), {"--out", "/proc/nowhere"});
    check_refused(
        run_viewer(k_small + "--frames 1 --stats " + (folder / "s.json").string() + " --collider " + file.string()),
        {"file"});
    CHECK(std::distance(fs::recursive_directory_iterator(folder.path()), {}) == 1); // the one that was there
}

TEST_CASE("validation messages make the exit code 2")
{
    // Its advice is more than this program follows.
    const Run run = run_viewer(k_small + "--validate --frames 1",
                               "VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_BEST_PRACTICES_EXT");
    CAPTURE(run.errors);
    CHECK(run.exit_code == 2);
    CHECK(run.errors.find(" validation messages\n") != std::string::npos);
}

TEST_CASE("a run without Vulkan prints one line that says so")
{
    check_refused(run_viewer(k_small + "--frames 1", "VK_DRIVER_FILES=/nowhere.json VK_ICD_FILENAMES=/nowhere.json"),
                  {"Vulkan"});
    check_refused(run_viewer("--list-devices", "VK_DRIVER_FILES=/nowhere.json VK_ICD_FILENAMES=/nowhere.json"),
                  {"Vulkan"});
}

TEST_CASE("a run writes its requested files, the same every time, without a validation message")
{
    const TestFolder folder;
    std::string hashes[2];
    for (int i = 0; i < 2; ++i)
    {
        const std::string name = std::to_string(i);
        const Run run = run_viewer(k_small + "--validate --verify --frames 30 --every 12 --out " +
                                       (folder / name).string() + " --stats " + (folder / name / "s.json").string() +
                                       " --export " + (folder / (name + ".obj")).string(),
                                   i == 0 ? "" : "VK_INSTANCE_LAYERS="); // makes all pipelines in advance, as for users
        CAPTURE(run.errors);
        REQUIRE(run.exit_code == 0);
        CHECK(run.errors.find("30 frames in ") != std::string::npos);
        for (const std::string file : {"frame_0000.png", "frame_0012.png", "frame_0024.png", "frame_0029.png"})
            CHECK(fs::file_size(folder / (name + "/" + file)) > 500);
        CHECK(std::distance(fs::directory_iterator(folder / name), {}) == 5); // each 12th, and the last; statistics
        const auto statistics = viewer::parse_json(text_of(folder / name / "s.json"), name);
        REQUIRE(statistics);
        const viewer::JsonNode* summary = statistics.value().find("summary");
        REQUIRE(summary != nullptr);
        CHECK(summary->find("vertices")->number == 24 * 24);
        const viewer::JsonNode* last = summary->find("last");
        CHECK(last->find("nan_vertices")->number == 0);
        CHECK(last->find("deepest_penetration")->number < 1e-3);
        CHECK(last->find("kinetic_energy")->number > 0);
        // It has stretched when it landed.
        double most = 0;
        for (const viewer::JsonNode& frame : statistics.value().find("per_frame")->items)
            most = std::max(most, frame.find("max_stretch")->number);
        CHECK(summary->find("maxima")->find("max_stretch")->number == most);
        CHECK(most >= last->find("max_stretch")->number);
        CHECK(statistics.value().find("per_frame")->items.size() == 30);
        hashes[i] = summary->find("state_hash")->text;
    }
    CHECK(hashes[0].size() == 16);
    CHECK(hashes[0] == hashes[1]);
    CHECK(text_of(folder / "0.obj") == text_of(folder / "1.obj"));
}

TEST_CASE("a point cache holds the start and every frame, and each of several cloths gets a file")
{
    const TestFolder folder;
    const std::string two =
        scene_with(R"({"name": "a", "grid": {"vertices": [8, 8], "size": [1, 1]}, "material": "silk"},
{"name": "b", "grid": {"vertices": [5, 4], "size": [1, 1]}, "material": "denim", "pins": ["corner:0", "edge:bottom"]})",
                   ",\n\"colliders\": [{\"plane\": {\"y\": -0.2}}, {\"sphere\": {\"center\": "
                   "[0, -0.1, 0], \"radius\": 0.05}}], \"wind\": {\"velocity\": [1, 0, 0], "
                   "\"gust\": 0.3}");
    const fs::path scene = folder.write("two.json", two);
    const Run run = run_viewer(scene.string() + " --headless --validate --frames 7 --size 64x36 --export " +
                               (folder / "c.pc2").string());
    CAPTURE(run.errors);
    REQUIRE(run.exit_code == 0);
    CHECK(fs::file_size(folder / "c_a.pc2") == 32 + 8 * 8 * 8 * 12);
    CHECK(fs::file_size(folder / "c_b.pc2") == 32 + 8 * 5 * 4 * 12);
}

TEST_CASE("devices are listed with index, name and driver")
{
    const Run run = run_viewer("--list-devices");
    CHECK(run.exit_code == 0);
    CHECK(run.output.find("0: ") == 0);
    CHECK(run.output.find('(') != std::string::npos);
}

TEST_CASE("a scene of meshes, moving pins, tethers and gusts runs, and irregularities of a mesh are reported")
{
    const TestFolder folder;
    // A sheet of two triangles, a vertex without a triangle, and one of a seam that is open.
    std::ofstream(folder / "sheet.obj") << "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 5 5 5\nv 0 0 0\nv 0 0 -1\nv 1 0 -1\n"
                                           "f 1 4 3\nf 1 3 2\nf 6 2 8\nf 6 8 7\n";
    std::ofstream(folder / "scene.json") << R"({
        "wind": {"velocity": [2, 0, 0], "gust": 0.3, "gust_length": 2},
        "cloths": [
          {"name": "mesh", "mesh": "sheet.obj", "transform": {"scale": 0.5}, "material": "silk", "integrator": "verlet",
           "pins": [{"at": "vertex:0", "motion": {"sway": {"amplitude": [0.1, 0, 0], "period": 1}}}],
           "tethers": {"stretch": 0.01}},
          {"name": "grid", "grid": {"vertices": [8, 8], "size": [1, 1]}, "transform": {"translate": [3, 1, 0]},
           "material": {"preset": "cotton", "strain_limit": 0.05, "bending_model": "isometric"},
           "pins": [{"at": "edge:top", "stiffness": 50, "damping": 0.1}, {"at": "corner:3", "max_distance": 0.2}]}],
        "colliders": [{"plane": {"y": -2}}]})";
    const Run run =
        run_viewer((folder / "scene.json").string() + " --headless --frames 8 --size 64x36 --validate --verify " +
                   "--export " + (folder / "end.obj").string());
    CAPTURE(run.errors);
    CHECK(run.exit_code == 0);
    CHECK(
        run.errors.find("note: cloth \"mesh\": 1 vertices without a triangle, which stay where they are, 1 vertices at "
                        "the position of another and not joined to it: open seams") != std::string::npos);
    // The file's order of vertices is kept; the isolated one has not moved.
    const std::string mesh = text_of(folder / "end_mesh.obj");
    CHECK(mesh.find("v 2.5 2.5 2.5\n") != std::string::npos);
    CHECK(std::count(mesh.begin(), mesh.end(), '\n') >= 8);
}

TEST_CASE("a cloth with too few substeps is reported")
{
    const TestFolder folder;
    const auto errors = [&](const char* substeps)
    {
        std::ofstream(folder / "s.json") << R"({"step": {"substeps": )" << substeps
                                         << R"(}, "cloths": [{"name": "stiff", "material": "denim",
                                               "grid": {"vertices": [8, 8], "size": [0.1, 0.1]}}]})";
        const Run run = run_viewer((folder / "s.json").string() + " --headless --frames 1 --size 64x36");
        CHECK(run.exit_code == 0);
        return run.errors;
    };
    const std::string few = errors("2");
    CHECK(few.find("note: cloth \"stiff\" needs ") != std::string::npos);
    CHECK(few.find(" substeps a frame and gets 2: it has ") != std::string::npos);
    CHECK(errors("\"auto\"").find("note:") == std::string::npos);
}

TEST_CASE("an invalid cloth is reported with the line of the scene")
{
    const TestFolder folder;
    std::ofstream(folder / "flat.obj") << "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n";
    std::ofstream(folder / "one.obj") << "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 3 2\n";
    const auto refused = [&](const std::string& cloth, const std::vector<std::string>& parts)
    {
        std::ofstream(folder / "s.json") << "{\"cloths\": [\n" + cloth + "]}";
        check_refused(run_viewer((folder / "s.json").string() + " --headless --frames 1 --size 64x36"), parts);
    };
    refused(R"({"mesh": "one.obj", "pins": ["vertex:3"]})",
            {"s.json:2: cloths[0].pins[0]: ", "pin vertex:3, but it has 3 vertices"});
    refused(R"({"mesh": "one.obj", "tethers": {}})", {"s.json:2: cloths[0]: ", "tethers need a pin, and it has none"});
    refused(R"({"mesh": "one.obj", "material": {"strain_limit": 50}})",
            {"s.json:2: cloths[0].material.strain_limit is 50; it must be within 0.001 to 10, or 0 for none"});
    refused(R"({"mesh": "one.obj", "material": {"vertex_mass": 1}})", {"s.json:2: ", "need the preset \"reference\""});
    const std::string grid = R"({"grid": {"vertices": [4, 4], "size": [1, 1]}, "material": )";
    refused(grid + R"({"areal_density": 0.2, "vertex_mass": 0.01}})",
            {"s.json:2: cloths[0].material: vertex_mass and areal_density both give the mass; leave one out"});
    refused(grid + R"({"stretch_stiffness": 900, "spring_stiffness": 400}})",
            {"s.json:2: cloths[0].material: spring_stiffness gives the stiffness of all springs"});
    refused(grid + R"({"damping_ratio": 0.1, "spring_damping": 10}})", {"spring_damping and damping_ratio both"});
    refused(R"({"mesh": "flat.obj"})", {"flat.obj"});
    refused(
        R"({"grid": {"vertices": [4, 4], "size": [1, 1]}, "pins": [{"box": {"min": [5, 5, 5], "max": [6, 6, 6]}}]})",
        {"s.json:2: ", "no vertex lies in the pin's box"});
}
