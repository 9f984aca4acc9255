// Scene files that are refused: every kind of bad input has a message of one line with file, line, path and reason.
#include "support/test_folder.hpp"
#include "viewer/scene_text.hpp"

#include "samples/viewer/scene_reader.hpp"

#include "voile/gpu/printable.hpp"
#include "voile/material_parameters.hpp"

#include <doctest/doctest.h>

#include <sys/stat.h>

#include <filesystem>
#include <string>

namespace
{

namespace fs = std::filesystem;
using namespace scene_text;

} // namespace

TEST_CASE("an unknown key is named with its line, its path and the likely key")
{
    CHECK(message("{\n\"cloths\": [{\n\"grid\": {\"vertices\": [4, 3], \"size\": [1, 2]},\n\"material\": {\n"
                  "\"thicknes\": 0.1\n}}]}") ==
          "dir/s.json:5: unknown key \"thicknes\" in cloths[0].material; did you mean \"thickness\"?");
    CHECK(scene_message("\"zzzzzz\": 1") == "dir/s.json:1: unknown key \"zzzzzz\" in the scene");
    CHECK(cloth_message("\"pins\": [{\"bxo\": 1}]") ==
          "dir/s.json:1: unknown key \"bxo\" in cloths[0].pins[0]; did you mean \"box\"?");
    CHECK(cloth_message("\"material\": \"coton\"") ==
          "dir/s.json:1: cloths[0].material is \"coton\", which is not a material (silk, cotton, wool, denim, leather, "
          "reference); did you mean \"cotton\"?");
    CHECK(scene_message("\"a\\nb\": 1") == "dir/s.json:1: unknown key \"a?b\" in the scene");
}

TEST_CASE("numbers that are not finite, out of range or of the wrong kind are refused")
{
    CHECK(scene_message("\"gravity\": [0, 1e999, 0]") ==
          "dir/s.json:1: number 1e999 is beyond the largest that can be held");
    CHECK(scene_message("\"gravity\": [0, 1e200, 0]") == "dir/s.json:1: gravity[1] is 1e+200, beyond single precision");
    CHECK(scene_message("\"gravity\": [0, 0]") == "dir/s.json:1: gravity has 2 items; expected an array of 3 numbers");
    CHECK(scene_message("\"gravity\": \"down\"") ==
          "dir/s.json:1: gravity is a string; expected an array of 3 numbers");
    CHECK(scene_message("\"step\": {\"rate\": 0}") == "dir/s.json:1: step.rate is 0; it must be within 1 to 1000");
    CHECK(scene_message("\"step\": {\"substeps\": 0}") ==
          "dir/s.json:1: step.substeps is 0; it must be within 1 to 1000");
    CHECK(scene_message("\"step\": {\"substeps\": 1001}") ==
          "dir/s.json:1: step.substeps is 1001; it must be within 1 to 1000");
    CHECK(scene_message("\"step\": {\"substeps\": 2.5}") ==
          "dir/s.json:1: step.substeps is 2.5; expected a whole number");
    CHECK(scene_message("\"step\": {\"substeps\": \"many\"}") ==
          "dir/s.json:1: step.substeps is neither \"auto\" nor a whole number within 1 to 1000");
    CHECK(scene_message("\"wind\": {\"gust\": -1}") == "dir/s.json:1: wind.gust is -1; it must be within 0 to 10");
    CHECK(cloth_message("\"material\": {\"thickness\": 0}") ==
          "dir/s.json:1: cloths[0].material.thickness is 0; it must be within 1e-05 to 10");
    CHECK(cloth_message("\"material\": {\"areal_density\": 1e-300}") ==
          "dir/s.json:1: cloths[0].material.areal_density is 1e-300; it must be within 0.001 to 1000");
    CHECK(cloth_message("\"transform\": {\"scale\": -1}") ==
          "dir/s.json:1: cloths[0].transform.scale is -1; it must be larger than 0 and at most 1000000");
    CHECK(cloth_message("\"sleep_speed\": 11") ==
          "dir/s.json:1: cloths[0].sleep_speed is 11; it must be within 0 to 10");
    CHECK(cloth_message("\"self_collision\": 1") ==
          "dir/s.json:1: cloths[0].self_collision is a number; expected true or false");
}

TEST_CASE("values outside the ranges of the cloth module are refused with their line")
{
    const std::string at = "dir/s.json:1: ";
    const std::string world = "; it must be within -1000000 to 1000000";
    CHECK(scene_message("\"gravity\": [0, -1e30, 0]") ==
          at + "gravity[1] is -1e+30; it must be within -10000 to 10000");
    CHECK(scene_message("\"wind\": {\"velocity\": [1e20, 0, 0]}") ==
          at + "wind.velocity[0] is 1e+20; it must be within -1000 to 1000");
    CHECK(scene_message("\"wind\": {\"gust_length\": 1e-38}") ==
          at + "wind.gust_length is 1e-38; it must be within 0.01 to 1000000");
    CHECK(cloth_message("\"velocity\": [0, 1e20, 0]") ==
          at + "cloths[0].velocity[1] is 1e+20; it must be within -10000 to 10000");
    CHECK(cloth_message("\"transform\": {\"scale\": 1e18}") ==
          at + "cloths[0].transform.scale is 1e+18; it must be larger than 0 and at most 1000000");
    CHECK(cloth_message("\"transform\": {\"translate\": [0, 0, -1e7]}") ==
          at + "cloths[0].transform.translate[2] is -10000000" + world);
    CHECK(cloth_message("\"pins\": [{\"at\": \"corner:0\", \"stiffness\": 1e30}]") ==
          at + "cloths[0].pins[0].stiffness is 1e+30; it must be within 0 to 1000000000");
    CHECK(collider_message(R"({"sphere": {"center": [1e9, 0, 0], "radius": 1}})") ==
          at + "colliders[0].sphere.center[0] is 1000000000" + world);
    CHECK(collider_message(R"({"capsule": {"from": [0, 0, 0], "to": [0, 1, 0], "radius": 1e18}})") ==
          at + "colliders[0].capsule.radius is 1e+18; it must be within 0.0001 to 2000000");
    CHECK(collider_message(R"({"plane": {"y": -1e20}})") == at + "colliders[0].plane.y is -1e+20" + world);
    CHECK(collider_message(R"({"box": {"min": [-1e8, 0, 0], "max": [1, 1, 1]}})") ==
          at + "colliders[0].box.min[0] is -100000000" + world);
    CHECK(collider_message(R"({"plane": {"y": 0}, "friction": 1e30})") ==
          at + "colliders[0].friction is 1e+30; it must be within 0 to 100");
    CHECK(collider_message(R"({"plane": {"y": 0}, "motion": {"velocity": [0, 1e20, 0]}})") ==
          at + "colliders[0].motion.velocity[1] is 1e+20; it must be within -10000 to 10000");
}

TEST_CASE("every parameter of a material is refused beyond its range, at its own line and key")
{
    const auto check = [](const auto& parameters)
    {
        for (const auto& parameter : parameters)
        {
            const std::string key = parameter.name;
            const std::string at = "dir/s.json:2: cloths[0].material." + key + " is ";
            const std::string none = parameter.rule.or_zero ? ", or 0 for none" : "";
            const viewer::Range decimals = viewer::between(parameter.min, parameter.max);
            const std::string range = "; it must be within " + viewer::number_text(decimals.min) + " to " +
                                      viewer::number_text(decimals.max) + none;
            CHECK(cloth_message("\"material\": {\n\"" + key + "\": -1e9}") == at + "-1000000000" + range);
            CHECK(cloth_message("\"material\": {\n\"" + key + "\": 1e9}") == at + "1000000000" + range);
        }
    };
    check(voile::k_fabric_parameters);
    check(voile::k_material_parameters);
    CHECK(cloth_message("\"material\": {\"strain_limit\": 0}") == "accepted");
}

TEST_CASE("bad grids are refused")
{
    const auto grid = [](const std::string& text) { return message("{\"cloths\": [{\"grid\": " + text + "}]}"); };
    CHECK(grid(R"({"vertices": [0, 4], "size": [1, 1]})") ==
          "dir/s.json:1: cloths[0].grid.vertices[0] is 0; it must be within 2 to 8192");
    CHECK(grid(R"({"vertices": [4, 1], "size": [1, 1]})") ==
          "dir/s.json:1: cloths[0].grid.vertices[1] is 1; it must be within 2 to 8192");
    CHECK(grid(R"({"vertices": [1, 0], "size": [1, 1]})") ==
          "dir/s.json:1: cloths[0].grid.vertices[0] is 1; it must be within 2 to 8192");
    CHECK(grid(R"({"vertices": [8193, 2], "size": [1, 1]})") ==
          "dir/s.json:1: cloths[0].grid.vertices[0] is 8193; it must be within 2 to 8192");
    CHECK(grid(R"({"vertices": [2, 8192], "size": [1, 1]})") == "accepted");
    CHECK(grid(R"({"vertices": [4, 4.5], "size": [1, 1]})") ==
          "dir/s.json:1: cloths[0].grid.vertices[1] is 4.5; expected a whole number");
    CHECK(grid(R"({"vertices": 128, "size": [1, 1]})") ==
          "dir/s.json:1: cloths[0].grid.vertices is a number; expected an array of 2 numbers");
    CHECK(grid(R"({"vertices": [4, -3], "size": [1, 1]})") ==
          "dir/s.json:1: cloths[0].grid.vertices[1] is -3; it must be within 2 to 8192");
    CHECK(grid(R"({"vertices": [4, 9999999999999], "size": [1, 1]})") ==
          "dir/s.json:1: cloths[0].grid.vertices[1] is 9999999999999; it must be within 2 to 8192");
    CHECK(grid(R"({"vertices": [4, 4], "size": [-1, 1]})") ==
          "dir/s.json:1: cloths[0].grid.size[0] is -1; it must be within 0.0001 to 100000");
    CHECK(grid(R"({"vertices": [4], "size": [1, 1]})") ==
          "dir/s.json:1: cloths[0].grid.vertices has 1 item; expected an array of 2 numbers");
    CHECK(grid(R"({"vertices": [4, 4]})") == "dir/s.json:1: cloths[0].grid has no \"size\"");
    CHECK(message("{\"cloths\": [{}]}") == "dir/s.json:1: cloths[0] has neither \"grid\" nor \"mesh\"");
    CHECK(cloth_message("\"mesh\": \"a.obj\"") == "dir/s.json:1: cloths[0] has both \"grid\" and \"mesh\"");
}

TEST_CASE("bad words, names and pins of a cloth are refused")
{
    CHECK(cloth_message("\"material\": \"velvet\"") ==
          "dir/s.json:1: cloths[0].material is \"velvet\", which is not a material (silk, cotton, wool, denim, "
          "leather, reference)");
    CHECK(cloth_message("\"material\": {\"preset\": \"velvet\"}")
              .starts_with("dir/s.json:1: cloths[0].material.preset is \"velvet\", which is not a material"));
    CHECK(cloth_message("\"material\": {\"static_friction\": 0.2, \"kinetic_friction\": 0.3}") ==
          "dir/s.json:1: cloths[0].material.kinetic_friction is 0.3, above static_friction, 0.2");
    CHECK(cloth_message("\"material\": {\"stretch_stiffness\": [1, 2, 3]}") ==
          "dir/s.json:1: cloths[0].material.stretch_stiffness has 3 items; expected an array of 2 numbers");
    CHECK(cloth_message("\"material\": {\"stretch_stiffness\": 1000}") == "accepted");
    CHECK(cloth_message("\"material\": 3") ==
          "dir/s.json:1: cloths[0].material is a number; expected a preset's name or an object");
    CHECK(cloth_message("\"integrator\": \"euler\"") ==
          "dir/s.json:1: cloths[0].integrator is \"euler\", which is not an integrator (rk4, verlet)");
    CHECK(cloth_message("\"name\": \"a/b\"") ==
          "dir/s.json:1: cloths[0].name is \"a/b\"; a name holds no slash and no control character");
    CHECK(cloth_message("\"name\": \"\"") == "dir/s.json:1: cloths[0].name is empty");
    CHECK(message("{\"cloths\": [{\"mesh\": \"a.obj\", \"name\": \"x\"},\n{\"mesh\": \"b.obj\", \"name\": \"x\"}]}") ==
          "dir/s.json:2: cloths[1] has the name \"x\" of another cloth");

    const std::string at = "dir/s.json:1: cloths[0].pins[0] is ";
    CHECK(cloth_message("\"pins\": [\"corner:4\"]") == at + "\"corner:4\"; a corner is 0, 1, 2 or 3");
    CHECK(cloth_message("\"pins\": [\"corner:\"]") == at + "\"corner:\"; a corner is 0, 1, 2 or 3");
    CHECK(cloth_message("\"pins\": [\"edge:up\"]") == at + "\"edge:up\"; an edge is top, bottom, left or right");
    CHECK(cloth_message("\"pins\": [\"vertex:-1\"]") == at + "\"vertex:-1\"; a vertex is a whole number from 0");
    CHECK(cloth_message("\"pins\": [\"vertex:12\"]") ==
          at + "\"vertex:12\", but the grid has 12 vertices, counted from 0");
    CHECK(cloth_message("\"pins\": [\"vertex:11\"]") == "accepted");
    CHECK(cloth_message("\"pins\": [\"nail:1\"]") ==
          at + "\"nail:1\"; a pin is corner:N, edge:NAME, vertex:N or a box");
    CHECK(cloth_message("\"pins\": [7]") == at + "a number; expected corner:N, edge:NAME, vertex:N or a box");
    CHECK(cloth_message("\"pins\": [{\"motion\": {}}]") == "dir/s.json:1: cloths[0].pins[0] has no \"at\"");
    CHECK(cloth_message("\"pins\": [{\"box\": {\"min\": [2, 0, 0], \"max\": [1, 1, 1]}}]") ==
          "dir/s.json:1: cloths[0].pins[0].box has a min above its max");
    CHECK(
        cloth_message("\"pins\": [{\"box\": {\"min\": [0, 0, 0], \"max\": [1, 1, 1]}, \"stiffness\": 5}]") ==
        "dir/s.json:1: cloths[0].pins[0] has \"box\" beside other keys; put it under \"at\": {\"at\": {\"box\": ...}, "
        "...}");
    CHECK(cloth_message("\"pins\": [{\"at\": \"corner:0\", \"damping\": 5}]") ==
          "dir/s.json:1: cloths[0].pins[0].damping is a spring's; it needs a \"stiffness\"");
    CHECK(cloth_message("\"pins\": [{\"at\": \"corner:0\", \"follow\": 0, \"motion\": {}}]") ==
          "dir/s.json:1: cloths[0].pins[0] has both \"motion\" and \"follow\"");
    CHECK(cloth_message("\"pins\": [{\"at\": \"corner:0\", \"stiffness\": 9, \"damping\": 5}]") == "accepted");
    CHECK(message("{\"cloths\": [{\"mesh\": \"a.obj\", \"pins\": [\"edge:top\"]}]}") ==
          at + "\"edge:top\", but only a grid has corners and edges");
}

TEST_CASE("bad colliders and cameras are refused")
{
    const std::string at = "dir/s.json:1: colliders[0]";
    CHECK(collider_message("{}") == at + " has no shape: mesh, plane, sphere, capsule, box or frames");
    CHECK(collider_message(R"({"mesh": "a.obj", "plane": {"y": 0}})") ==
          at + " has both \"mesh\" and \"plane\"; it needs one of them");
    CHECK(collider_message(R"({"mesh": "a.stl"})") ==
          at + ".mesh is \"a.stl\"; expected a file that ends in .obj or .ply");
    CHECK(collider_message(R"({"sphere": {"center": [0, 0, 0], "radius": -1}})") ==
          at + ".sphere.radius is -1; it must be within 0.0001 to 2000000");
    CHECK(collider_message(R"({"sphere": {"radius": 1}})") == at + ".sphere has no \"center\"");
    CHECK(collider_message(R"({"box": {"min": [0, 0, 0], "max": [1, 0, 1]}})") ==
          at + ".box is empty: each number of min must be below that of max");
    CHECK(collider_message(R"({"plane": {"y": 0}, "friction": {"static": 0.1, "kinetic": 0.2}})") ==
          at + ".friction has a kinetic coefficient above the static one");
    CHECK(collider_message(R"({"plane": {"y": 0}, "friction": {}})") == at + ".friction has no \"static\"");
    CHECK(collider_message(R"({"plane": {"y": 0}, "friction": {"static": 0.2}})") ==
          at + ".friction has no \"kinetic\"");
    CHECK(collider_message(R"({"plane": {"y": 0}, "friction": "ice"})") ==
          at + ".friction is a string; expected a number or an object");
    CHECK(collider_message(R"({"plane": {"y": 0}, "frames": "w%d.obj"})") ==
          at + " has \"frames\", which deform a mesh, and a plane");
    for (const char* pattern :
         {"walk.obj", "w%s.obj", "w%d_%d.obj", "w%9999d.obj", "w%n.obj", "w%.obj", "w%0999999d.obj"})
        CHECK(collider_message("{\"frames\": \"" + std::string(pattern) + "\"}") ==
              at + ".frames is \"" + pattern + "\"; a file name with one %d or %04d is expected");
    CHECK(collider_message(R"({"mesh": "a.obj", "rate": 30})") == at + ".rate needs \"frames\" beside it");
    CHECK(collider_message(R"({"mesh": "a.obj", "loop": true})") == at + ".loop needs \"frames\" beside it");
    CHECK(collider_message(R"({"frames": "a%d.obj", "motion": {"frames": "a%d.obj"}})") ==
          at + ".motion.frames is given twice: in the collider and in its motion");
    CHECK(collider_message(R"({"mesh": "a.obj", "sides": "three"})") ==
          at + ".sides is \"three\", which is not a choice of sides (one, two)");
    CHECK(collider_message(R"({"plane": {"y": 0}, "sides": "one"})") ==
          at + ".sides is a mesh's; every other shape pushes outwards");
    CHECK(collider_message(R"({"plane": {"y": 0}, "layers": [0, 32]})") ==
          at + ".layers[1] is 32; it must be within 0 to 31");
    CHECK(collider_message(R"({"plane": {"y": 0}, "layers": 2})") == at + ".layers is a number; expected an array");
    CHECK(scene_message(R"("camera": {"position": [0, 0, 0], "target": [0, 0, 0]})") ==
          "dir/s.json:1: camera has its target where its position is");
    CHECK(scene_message(R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "fov": 180})") ==
          "dir/s.json:1: camera.fov is 180; it must be within 1 to 170");
    CHECK(scene_message(R"("camera": {"position": [0, 0, 1]})") == "dir/s.json:1: camera has no \"target\"");
}

TEST_CASE("a step that the solver refuses is reported with the key of the scene")
{
    const auto scene = parse("{\"gravity\": [0, 1, 0],\n\"wind\": {\"velocity\": [1, 0, 0],\n"
                             "\"gust_length\": 1},\n\"step\": {\"rate\": 60}, \"cloths\": [{" +
                             k_grid + "}]}");
    REQUIRE(scene);
    const auto refused = [&](const std::string& reason) { return viewer::step_error(scene.value(), reason).message; };
    CHECK(refused("step: gravity is (0, 1e+30, 0)") == "dir/s.json:1: gravity: step: gravity is (0, 1e+30, 0)");
    CHECK(refused("step: wind is 2") == "dir/s.json:2: wind.velocity: step: wind is 2");
    CHECK(refused("step: gust_length is 1e-30") == "dir/s.json:3: wind.gust_length: step: gust_length is 1e-30");
    CHECK(refused("step: duration is 0") == "dir/s.json:4: step.rate: step: duration is 0");
    CHECK(refused("step: gust is 11") == "dir/s.json: step: gust is 11"); // not written there
}

TEST_CASE("missing files are named with the key that refers to them")
{
    const TestFolder folder;
    const std::string file = (folder / "s.json").string();
    const auto load = [&]
    {
        const auto result = viewer::load_scene(file);
        return result ? "accepted" : result.error().message;
    };
    CHECK(load() == file + ": the file does not exist");
    folder.write("s.json", "");
    CHECK(load() == file + ": the file is empty");
    folder.write("s.json", "{\n\"cloths\": [\n{\"mesh\": \"gone.obj\"}]}");
    CHECK(load() == file + ":3: cloths[0].mesh: " + (folder / "gone.obj").string() + " does not exist");
    folder.write("gone.obj", "v 0 0 0\n");
    CHECK(load() == "accepted");
    folder.write("s.json", "{\"cloths\": [{\"mesh\": \"gone.obj\"}],\n\"colliders\": [{\"frames\": \"f%02d.obj\"}]}");
    CHECK(load() == file + ":2: colliders[0].frames: " + (folder / "f%02d.obj").string() +
                        ": there is no frame 0 and no frame 1");
    folder.write("f01.obj", "");
    folder.write("f02.obj", "");
    CHECK(load() == "accepted");
    for (const char* other : {"f1.obj", "f003.obj", "f04.ply", "fxx.obj", "f-5.obj"})
        folder.write(other, ""); // no frames of this sequence
    CHECK(load() == "accepted");
    folder.write("f05.obj", "");
    CHECK(load() ==
          file + ":2: colliders[0].frames: " + (folder / "f03.obj").string() + " is missing, but f05.obj is there");
    fs::remove(folder / "f05.obj");
    const auto frames = viewer::frame_files({folder / "f%02d.obj", 30.f});
    REQUIRE(frames);
    REQUIRE(frames.value().size() == 2);
    CHECK(frames.value()[0].filename() == "f01.obj");

    const auto directory = viewer::load_scene(folder.path());
    REQUIRE_FALSE(directory);
    CHECK(directory.error().message == folder.path().string() + ": this is a folder, not a scene file");
}

TEST_CASE("messages about a scene show no raw bytes of it")
{
    const std::string odd = "\\u001b[2J\\n" + std::string(300000, 'o');
    const auto check = [](const std::string& refused)
    {
        CHECK(refused != "accepted");
        CHECK(refused.size() < 400);
        CHECK(refused == voile::gpu::printable(refused, 400));
    };
    check(scene_message("\"" + odd + "\": 0"));
    check(message("{\"" + odd + "\": {\"a\": 0, \"a\": 0}}"));
    check(message("{\"" + odd + "\": 0, \"" + odd + "\": 0}"));
    check(message("{\"cloths\": " + std::string(1000, '\x1b') + "}"));
    check(cloth_message("\"name\": \"" + odd + "\""));
    check(cloth_message("\"name\": \"\\u009b31m\""));
    check(cloth_message("\"material\": \"" + odd + "\""));
    check(cloth_message("\"pins\": [\"corner:" + odd + "\"]"));
    check(cloth_message("\"pins\": [\"" + odd + "\"]"));
    check(message("{\"cloths\": [{\"mesh\": \"" + odd + "\"}]}"));
    check(collider_message("{\"mesh\": \"" + odd + "\"}"));
    check(collider_message("{\"frames\": \"" + odd + ".obj\"}"));
    check(collider_message("{\"mesh\": \"a.obj\", \"sides\": \"" + odd + "\"}"));
    const auto unnamed = viewer::parse_scene("{", "dir/\x1b[2J" + std::string(4000, 'd') + "/s.json");
    check(unnamed.error().message);
    check(viewer::find_scene('\x1b' + std::string(300000, 's'), {}).error().message);
    check(viewer::find_scene('\x1b' + std::string(300000, 's') + ".json", {}).error().message);
    CHECK(cloth_message("\"name\": \"" + std::string(100, 'n') + "\"") == "accepted");
    CHECK(cloth_message("\"name\": \"" + std::string(101, 'n') + "\"") ==
          "dir/s.json:1: cloths[0].name is \"" + std::string(80, 'n') + "...\"; a name has at most 100 bytes");
}

TEST_CASE("a pipe is refused as a scene and as a mesh")
{
    const TestFolder folder;
    const fs::path fifo = folder / "pipe.json";
    REQUIRE(::mkfifo(fifo.c_str(), 0600) == 0);
    CHECK(viewer::load_scene(fifo).error().message == fifo.string() + ": cannot read: not a regular file");
    REQUIRE(::mkfifo((folder / "pipe.obj").c_str(), 0600) == 0);
    const fs::path scene = folder.write("s.json", "{\"cloths\": [{\"mesh\": \"pipe.obj\"}]}");
    CHECK(viewer::load_scene(scene).error().message ==
          scene.string() + ":1: cloths[0].mesh: " + (folder / "pipe.obj").string() + " is not a regular file");
}

TEST_CASE("a file that cannot hold a scene is refused")
{
    const TestFolder folder;
    const std::string file = (folder / "s.json").string();
    folder.write("s.json", "{\"cloths\": [{\"mesh\": \"sub\"}]}");
    const auto no_mesh = viewer::load_scene(file);
    REQUIRE_FALSE(no_mesh);
    CHECK(no_mesh.error().message == file + ":1: cloths[0].mesh is \"sub\"; expected a file that ends in .obj or .ply");
    fs::create_directory(folder / "sub.obj");
    folder.write("s.json", "{\"cloths\": [{" + k_grid + "}],\n\"colliders\": [{\"mesh\": \"sub.obj\"}]}");
    const auto a_folder = viewer::load_scene(file);
    REQUIRE_FALSE(a_folder);
    CHECK(a_folder.error().message ==
          file + ":2: colliders[0].mesh: " + (folder / "sub.obj").string() + " is a folder");
    folder.write("s.json", std::string((size_t{16} << 20) + 1, ' '));
    const auto large = viewer::load_scene(file);
    REQUIRE_FALSE(large);
    CHECK(large.error().message == file + ": cannot read: larger than 16 MiB");
    // Not a pattern: it would otherwise be the same file without end.
    folder.write("a.obj", "");
    CHECK_FALSE(viewer::frame_files({folder / "a.obj", 60.f}));
}
