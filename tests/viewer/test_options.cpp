// The viewer's command line.
#include "samples/viewer/options.hpp"
#include "samples/viewer/output_check.hpp"

#include "support/test_folder.hpp"
#include "voile/gpu/printable.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <iterator>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

namespace
{

namespace fs = std::filesystem;

voile::Result<viewer::Options> parse(std::vector<const char*> arguments)
{
    arguments.insert(arguments.begin(), "viewer");
    return viewer::parse_options(static_cast<int>(arguments.size()), arguments.data());
}

// Words between spaces.
voile::Result<viewer::Options> parse_line(const std::string& line)
{
    std::istringstream stream(line);
    const std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
    std::vector<const char*> arguments;
    for (const std::string& word : words)
        arguments.push_back(word.c_str());
    return parse(arguments);
}

std::string message(const std::vector<const char*>& arguments)
{
    const auto result = parse(arguments);
    return result ? "accepted" : result.error().message;
}

} // namespace

TEST_CASE("no options give the defaults")
{
    const auto result = parse({});
    REQUIRE(result);
    const viewer::Options& options = result.value();
    CHECK(options.scene == "reference");
    CHECK_FALSE(options.headless);
    CHECK_FALSE(options.frames.has_value());
    CHECK(options.width == 1280);
    CHECK(options.height == 720);
    CHECK(options.every == 1);
    CHECK(options.colliders.empty());
    CHECK(options.message.empty());
    CHECK(viewer::headless_frames(options).value() == 300);
}

TEST_CASE("every option is read")
{
    const TestFolder folder;
    folder.write("ball.obj", "v 0 0 0\n");
    const std::string file = (folder / "ball.obj").string();
    const auto result =
        parse_line("drape --headless --frames 90 --size 64x48 --out frames --every 10 --video a.mp4 --stats=s.json "
                   "--export e.PC2 --export e.usda --export-colliders --cloth-resolution 2 --device 1 --list-devices "
                   "--validate --capture 89 --verify "
                   "--collider " +
                   file + " --collider " + file);
    REQUIRE_MESSAGE(result, result.error().message);
    const viewer::Options& options = result.value();
    CHECK(options.scene == "drape");
    CHECK(options.headless);
    CHECK(options.frames == 90u);
    CHECK(options.width == 64);
    CHECK(options.height == 48);
    CHECK(options.out == "frames");
    CHECK(options.every == 10);
    CHECK(options.video == "a.mp4");
    CHECK(options.stats == "s.json");
    REQUIRE(options.exports.size() == 2);
    CHECK(options.exports[0].path == "e.PC2");
    CHECK(options.exports[0].format == viewer::ExportFormat::point_cache);
    CHECK(options.exports[1].path == "e.usda");
    CHECK(options.exports[1].format == viewer::ExportFormat::usd);
    CHECK(options.export_colliders);
    CHECK(options.cloth_resolution == 2u);
    CHECK(options.colliders.size() == 2);
    CHECK(options.device == "1");
    CHECK(options.list_devices);
    CHECK(options.validate);
    CHECK(options.capture == 89u);
    CHECK(options.verify);
}

TEST_CASE("a value is not mistaken for the scene, nor the scene for a value")
{
    const auto result = parse({"--out", "frames", "drape"});
    REQUIRE(result);
    CHECK(result.value().scene == "drape");
    CHECK(result.value().out == "frames");
}

TEST_CASE("zero frames are a valid run")
{
    const auto result = parse({"--frames", "0"});
    REQUIRE(result);
    CHECK(viewer::headless_frames(result.value()).value() == 0);
}

TEST_CASE("a bad option is named with its value and the reason, in one line")
{
    CHECK(message({"--size", "1280"}) == "--size: \"1280\" is not WIDTHxHEIGHT");
    CHECK(message({"--size", "12x8x3"}) == "--size: \"12x8x3\" is not WIDTHxHEIGHT");
    CHECK(message({"--size", "x720"}) == "--size: \"x720\" is not WIDTHxHEIGHT");
    CHECK(message({"--size", "0x720"}) == "--size: \"0x720\" is not within 1x1 to 16384x16384");
    CHECK(message({"--size", "16385x1"}) == "--size: \"16385x1\" is not within 1x1 to 16384x16384");
    CHECK(message({"--size", "1x99999999999"}) == "--size: \"1x99999999999\" is not within 1x1 to 16384x16384");
    CHECK(message({"--size", "1x1", "--size", "2x2"}) == "--size: given 2 times; once at most");
    CHECK(message({"--paused", "--headless"}) == "--paused: has no effect with --headless");
    CHECK(message({"--capture", "key", "--headless"}) == "--capture key: has no effect with --headless");
    CHECK(message({"s.json", "--stats", "./s.json"}) == "--stats: \"./s.json\" is also the scene's file");
    CHECK(message({"--export", "a.obj", "--stats", "a.obj"}) == "--export: \"a.obj\" is also the file of --stats");
    CHECK(message({"--export", "a.obj", "--export", "./a.obj"}) == "--export: \"./a.obj\" is written twice");
    CHECK(message({"--export", "a.pc2", "--stats", "a.pc2.json"}) ==
          "--export: \"a.pc2.json\" is also the file of --stats");
    CHECK(message({"--export-colliders"}) == "--export-colliders: has no effect without --export");
    CHECK(message({"--video", "a.mp4", "--stats", "b/../a.mp4"}) ==
          "--stats: \"b/../a.mp4\" is also the file of --video");
    CHECK(message({"--export", "a.obj", "--stats", "a.json"}) == "accepted");
    CHECK(message({"--frames", "-1"}) == "--frames: \"-1\" is not within 0 to 100000000");
    CHECK(message({"--frames", "1.5"}) == "--frames: \"1.5\" is not a whole number");
    CHECK(message({"--frames", "99999999999999999999"}) ==
          "--frames: \"99999999999999999999\" is not within 0 to 100000000");
    CHECK(message({"--frames", ""}) == "--frames: the value is empty");
    CHECK(message({"--frames"}) == "--frames: a value is missing");
    CHECK(message({"--out", "--headless"}) == "--out: a value is missing before \"--headless\"");
    CHECK(message({"--cloth-resolution", "0"}) == "--cloth-resolution: \"0\" is not within 2 to 8192");
    CHECK(message({"--cloth-resolution", "1"}) == "--cloth-resolution: \"1\" is not within 2 to 8192");
    CHECK(message({"--cloth-resolution", "8193"}) == "--cloth-resolution: \"8193\" is not within 2 to 8192");
    CHECK(message({"--every", "0", "--out", "d"}) == "--every: \"0\" is not within 1 to 100000000");
    CHECK(message({"--every", "2"}) == "--every: has no effect without --out");
    CHECK(message({"--export", "cloth.stl"}) == "--export: \"cloth.stl\" does not end in .obj, .ply, .pc2 or .usda");
    CHECK(message({"--video", "a.avi"}) == "--video: \"a.avi\" does not end in .mp4");
    CHECK(message({"--collider", "gone.obj"}) == "--collider: \"gone.obj\" does not exist");
    const TestFolder folder;
    const std::string inside = (folder / "folder.obj").string();
    std::filesystem::create_directory(inside);
    CHECK(message({"--collider", inside.c_str()}) == "--collider: \"" + inside + "\" is a folder");
    CHECK(message({"--collider", "a.stl"}) == "--collider: \"a.stl\" does not end in .obj or .ply");
    CHECK(message({"-x"}) == "-x: unknown option");
    CHECK(message({"--no-headless"}) == "--no-headless: unknown option");
    CHECK(message({"--headless=3"}) == "--headless: takes no value");
    CHECK(message({"one", "two"}) == "\"two\": one scene at most, and \"one\" was given before it");
    CHECK(message({""}) == "the scene's name is empty");
    CHECK(message({"--fraems", "3"}) == "--fraems: unknown option; did you mean \"--frames\"?");
    CHECK(message({"--zzzzzzz"}) == "--zzzzzzz: unknown option");
    const std::string odd = "\x1b[2J" + std::string(100000, 'o');
    for (const char* option :
         {"--frames", "--size", "--every", "--export", "--video", "--collider", "--debug", "--capture"})
    {
        const std::string refused = message({option, odd.c_str(), "--out", "a"});
        CHECK(refused.size() < 400);
        CHECK(refused == voile::gpu::printable(refused, 400));
    }
    CHECK(message({odd.c_str(), odd.c_str()}).size() < 400);
    CHECK(message({("--" + odd).c_str()}).size() < 400);
    CHECK(message({"--out", "a", "--every", "two\nlines"}) == "--every: \"two?lines\" is not a whole number");
}

TEST_CASE("a capture lies within the run")
{
    CHECK(message({"--frames", "10", "--capture", "10"}) ==
          "--capture: \"10\" is beyond the last of 10 frames, counted from 0");
    CHECK(message({"--headless", "--capture", "300"}) ==
          "--capture: \"300\" is beyond the last of 300 frames, counted from 0");
    CHECK(message({"--capture", "-1"}) == "--capture: \"-1\" is not within 0 to 100000000");
    // With a window there is no end to be beyond; it turns out later if there is none.
    const auto open = parse({"--capture", "300"});
    REQUIRE(open);
    CHECK_FALSE(viewer::headless_frames(open.value()));
}

TEST_CASE("help and version are printed, not errors")
{
    const auto help = parse({"--help"});
    REQUIRE(help);
    for (const char* word : {"--headless", "--frames", "--size", "--out", "--every", "--video", "--stats", "--export",
                             "--export-colliders", "--cloth-resolution", "--collider", "--device", "--list-devices",
                             "--validate", "--capture", "--verify", "Examples:", "1280x720"})
        CHECK_MESSAGE(help.value().message.find(word) != std::string::npos, word);
    const auto version = parse({"--version"});
    REQUIRE(version);
    CHECK(version.value().message.starts_with("viewer "));
}

TEST_CASE("--debug accepts every mode")
{
    CHECK_FALSE(parse({}).value().debug.any());
    const auto all = parse_line("--debug boxes --debug contacts --debug=normals --debug intersections");
    REQUIRE(all);
    CHECK(all.value().debug.boxes == 4u);
    CHECK(all.value().debug.contacts);
    CHECK(all.value().debug.normals);
    CHECK(all.value().debug.intersections);
    const auto level = parse_line("--debug boxes:0 drape");
    REQUIRE(level);
    CHECK(level.value().debug.boxes == 0u);
    CHECK_FALSE(level.value().debug.contacts);
    CHECK(level.value().scene == "drape");
    CHECK(message({"--debug", "boxen"}) ==
          "--debug: \"boxen\" is not boxes, boxes:LEVEL, contacts, normals, intersections, strain or strain:PERCENT; "
          "did you mean \"boxes\"?");
    CHECK(parse_line("--debug strain").value().debug.strain == 5u);
    CHECK(parse_line("--debug strain:12").value().debug.strain == 12u);
    CHECK(message({"--debug", "strain:0"}) == "--debug strain: \"0\" is not within 1 to 100");
    CHECK(message({"--export", "a.objj"}) ==
          "--export: \"a.objj\" does not end in .obj, .ply, .pc2 or .usda; did you mean \".obj\"?");
    CHECK(message({"--debug", "boxes:49"}) == "--debug boxes: \"49\" is not within 0 to 48");
    CHECK(message({"--debug", "boxes:"}) == "--debug boxes: the value is empty");
    CHECK(message({"--debug", "boxes:deep"}) == "--debug boxes: \"deep\" is not a whole number");
}

TEST_CASE("an output cannot replace a mesh of the scene")
{
    const TestFolder folder;
    folder.write("cape.obj", "");
    folder.write("ground.ply", "");
    folder.write("walk1.obj", "");
    const auto scene = viewer::load_scene(folder.write("s.json", R"({"cloths": [{"name": "cape", "mesh": "cape.obj"}],
        "colliders": [{"mesh": "ground.ply"}, {"frames": "walk%d.obj", "rate": 30}]})"));
    REQUIRE_MESSAGE(scene, scene.error().message);
    const auto check = [&](viewer::Options options)
    {
        const auto result = viewer::check_outputs(options, scene.value(), {"ground", "walk1"});
        return result ? "accepted" : result.error().message;
    };
    const std::string cape = (folder / "cape.obj").string();
    CHECK(check({.exports = {{cape}}}) == "--export: \"" + cape + "\" is also the mesh of cloth \"cape\"");
    const std::string ground = (folder / "." / "ground.ply").string();
    CHECK(check({.exports = {{ground}}}) == "--export: \"" + ground + "\" is also a collider's mesh");
    const std::string frame = (folder / "walk1.obj").string();
    CHECK(check({.exports = {{frame}}}) == "--export: \"" + frame + "\" is also a frame of a collider's mesh");
    const std::string scene_file = (folder / "s.json").string();
    CHECK(check({.stats = scene_file}) == "--stats: \"" + scene_file + "\" is also the scene's file");
    CHECK(check({.stats = folder / "stats.json", .exports = {{folder / "cape.ply"}}}) == "accepted");
    // With several files per export.
    viewer::Options options{.exports = {{folder / "x.obj"}}, .export_colliders = true};
    CHECK(check(options) == "accepted");
    folder.write("x_walk1.obj", "");
    options.stats = folder / "x_walk1.obj";
    CHECK(check(options) == "--export: \"" + (folder / "x_walk1.obj").string() + "\" is also the file of --stats");
    options = {.exports = {{folder / "x.obj"}, {folder / "x.obj"}}, .export_colliders = true};
    CHECK(check(options) == "--export: \"" + (folder / "x_cape.obj").string() + "\" is written twice");
}

TEST_CASE("an export of several files cannot replace a mesh of the scene")
{
    const TestFolder folder;
    folder.write("x_b.obj", "");
    const auto scene = viewer::load_scene(folder.write("s.json", R"({"cloths": [{"name": "a", "mesh": "x_b.obj"},
            {"name": "b", "grid": {"vertices": [4, 4], "size": [1, 1]}}]})"));
    REQUIRE_MESSAGE(scene, scene.error().message);
    const auto result = viewer::check_outputs({.exports = {{folder / "x.obj"}}}, scene.value(), {});
    REQUIRE(!result);
    CHECK(result.error().message ==
          "--export: \"" + (folder / "x_b.obj").string() + "\" is also the mesh of cloth \"a\"");
}

TEST_CASE("a link to itself is distinguished from a missing file")
{
    const TestFolder folder;
    const std::string loop = (folder / "loop.obj").string();
    fs::create_symlink("loop.obj", loop);
    CHECK(message({"--collider", loop.c_str()}) ==
          "--collider: \"" + loop + "\": " + std::make_error_code(std::errc::too_many_symbolic_link_levels).message());
}
