// Scene files on disk: finding and reading them, what their places and turns mean, and the scenes that ship.
#include "test_folder.hpp"

#include "samples/viewer/scene_file.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <sstream>

namespace fs = std::filesystem;

TEST_CASE("files: missing ones are named, with what asked for them")
{
    const TestFolder folder;
    const std::string file = (folder / "s.json").string();
    const auto load = [&]
    {
        const auto result = viewer::load_scene(file);
        return result ? "accepted" : result.error().message;
    };
    CHECK(load() == file + ": the file does not exist");
    (void)folder.write("s.json", "");
    CHECK(load() == file + ": the file is empty");
    (void)folder.write("s.json", "{\n\"cloths\": [\n{\"mesh\": \"gone.obj\"}]}");
    CHECK(load() == file + ":3: cloths[0].mesh: " + (folder / "gone.obj").string() + " does not exist");
    (void)folder.write("gone.obj", "v 0 0 0\n");
    CHECK(load() == "accepted");
    (void)folder.write("s.json",
                       "{\"cloths\": [{\"mesh\": \"gone.obj\"}],\n\"colliders\": [{\"frames\": \"f%02d.obj\"}]}");
    CHECK(load() == file + ":2: colliders[0].frames: " + (folder / "f%02d.obj").string() +
                        ": there is no frame 0 and no frame 1");
    (void)folder.write("f01.obj", "");
    (void)folder.write("f02.obj", "");
    (void)folder.write("f04.obj", "");
    CHECK(load() == "accepted");
    const auto frames = viewer::frame_files({folder / "f%02d.obj", 30.f});
    REQUIRE(frames);
    REQUIRE(frames.value().size() == 2);
    CHECK(frames.value()[0].filename() == "f01.obj");

    const auto directory = viewer::load_scene(folder.path());
    REQUIRE_FALSE(directory);
    CHECK(directory.error().message == folder.path().string() + ": this is a folder, not a scene file");
}

TEST_CASE("scenes are found by path, then by name")
{
    const TestFolder folder;
    (void)folder.write("flag.json", "{}");
    (void)folder.write("drape.json", "{}");
    (void)folder.write("heart.obj", "");
    const std::vector<fs::path> folders = {folder / "nowhere", folder.path()};
    CHECK(viewer::find_scene("flag", folders).value() == folder / "flag.json");
    CHECK(viewer::find_scene("flag.json", folders).value() == folder / "flag.json");
    const std::string path = (folder / "drape.json").string();
    CHECK(viewer::find_scene(path, {}).value() == path);
    const auto unknown = viewer::find_scene("curtain", folders);
    REQUIRE_FALSE(unknown);
    CHECK(unknown.error().message == "scene \"curtain\" is unknown; the scenes that ship are drape, flag");
    const auto missing = viewer::find_scene("some/where.json", folders);
    REQUIRE_FALSE(missing);
    CHECK(missing.error().message == "some/where.json: the file does not exist; the scenes that ship are drape, flag");
    CHECK_FALSE(viewer::find_scene("", folders));
    CHECK_FALSE(viewer::find_scene(folder.path().string(), folders));

    REQUIRE(::setenv("VOILE_SCENES", folder.path().c_str(), 1) == 0);
    CHECK(viewer::find_scene("flag").value() == folder / "flag.json");
    REQUIRE(::unsetenv("VOILE_SCENES") == 0);
}

TEST_CASE("a transform scales, then rotates about x, y, z, then translates")
{
    const viewer::TransformEntry transform{{1, 2, 3}, {90, 90, 0}, 2.f};
    // (0, 1, 0) doubled; about x to z; about y from z to x; moved.
    const glm::vec4 p = viewer::matrix(transform) * glm::vec4(0, 1, 0, 1);
    CHECK(glm::length(glm::vec3(p) - glm::vec3(3, 2, 3)) < 1e-5f);
    // A turn about a pivot that moves along.
    const viewer::MotionEntry motion{{1, 0, 0}, {0, 45, 0}, {0, 0, 1}};
    const glm::vec4 q = viewer::matrix(motion, 2.0) * glm::vec4(0, 0, 2, 1);
    CHECK(glm::length(glm::vec3(q) - glm::vec3(3, 0, 1)) < 1e-5f);
}

TEST_CASE("the reference scene is that of the report")
{
    const fs::path path = fs::path(VOILE_SOURCE_DIR) / "samples/scenes/reference.json";
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    const auto result = viewer::parse_scene(text.str(), path);
    REQUIRE_MESSAGE(result, result.error().message);
    const viewer::SceneFile& scene = result.value();
    CHECK(scene.step.substeps == 11u);
    CHECK(1.0 / 60 / 11 <= 0.0016);
    REQUIRE(scene.cloths.size() == 1);
    const auto& grid = std::get<viewer::GridEntry>(scene.cloths[0].form);
    CHECK(grid.columns == 128);
    CHECK(grid.rows == 128);
    CHECK(grid.size.x / 127.f == doctest::Approx(0.08));
    CHECK(scene.cloths[0].transform.translate.y == 4.8f);
    CHECK(scene.cloths[0].transform.translate.x == doctest::Approx(5.08));
    CHECK(scene.cloths[0].material.preset == "reference");
    CHECK(scene.cloths[0].integrator == viewer::Integrator::rk4);
    CHECK(scene.colliders.size() == 2);
}
