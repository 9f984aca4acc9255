// Scene files: reading them and finding them. test_scene_errors.cpp and test_scene_syntax.cpp have those that are
// refused.
#include "support/close_to.hpp"
#include "support/test_folder.hpp"
#include "support/test_paths.hpp"
#include "viewer/scene_text.hpp"

#include "samples/viewer/materials.hpp"
#include "samples/viewer/text.hpp"

#include "voile/material_parameters.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace
{

namespace fs = std::filesystem;
using namespace scene_text;

constexpr const char* k_full_scene = R"({
  "gravity": [0, -1.6, 0.5],
  "wind": {"velocity": [2, 0, 1], "gust": 0.3},
  "step": {"rate": 120, "substeps": 7},
  "cloths": [{
    "name": "sheet",
    "grid": {"vertices": [8, 5], "size": [2.4, 1.2]},
    "transform": {"translate": [1, 2, 3], "rotate": [10, 20, 30], "scale": 2},
    "material": {"preset": "cotton", "areal_density": 0.2, "stretch_stiffness": [900, 800], "shear_stiffness": 300,
                 "bending_stiffness": 2e-5, "damping_ratio": 0.1, "thickness": 0.005, "static_friction": 0.5,
                 "kinetic_friction": 0.4, "air_drag_normal": 1.28, "air_drag_tangential": 0.05, "strain_limit": 0.1,
                 "bending_model": "isometric", "vertex_mass": 0.15, "spring_stiffness": 400, "spring_damping": 10,
                 "linear_drag": 0.1},
    "pins": ["corner:3", "edge:left", "vertex:39", {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}},
             {"at": "edge:top", "motion": {"velocity": [1, 0, 0], "spin": [0, 45, 0], "pivot": [0, 1, 0]}},
             {"at": {"box": {"min": [0, 0, 0], "max": [0, 1, 1]}}}],
    "velocity": [0, 0, -1],
    "integrator": "verlet",
    "self_collision": true,
    "sleep_speed": 0.05,
    "layers": [0, 3]
  }, {"mesh": "m/shirt.PLY", "material": "silk"}],
  "colliders": [
    {"mesh": "../heart.obj", "transform": {"rotate": [0, 90, 0]}, "friction": {"static": 0.5, "kinetic": 0.4},
     "motion": {"velocity": [0, 1, 0], "spin": [0, 45, 0], "pivot": [1, 1, 1]}},
    {"plane": {"y": -0.4}, "friction": 0.3},
    {"sphere": {"center": [0, 1, 0], "radius": 0.5}, "friction": 0.6},
    {"capsule": {"from": [0, 0, 0], "to": [0, 1, 0], "radius": 0.2}},
    {"box": {"min": [0, 0, 0], "max": [1, 2, 3]}},
    {"frames": "walk_%04d.obj", "rate": 30},
    {"mesh": "walk.obj", "motion": {"frames": "w%d.obj", "rate": 24}, "sides": "two", "layers": [31]}
  ],
  "camera": {"position": [0, 2, 5], "target": [0, 1, 0], "fov": 35}
})";

viewer::SceneFile full_scene()
{
    const auto result = parse(k_full_scene);
    REQUIRE_MESSAGE(result, result.error().message);
    return result.value();
}

} // namespace

TEST_CASE("the keys of the scene itself are read")
{
    const viewer::SceneFile scene = full_scene();
    CHECK(scene.name == "s");
    CHECK(scene.gravity == glm::vec3(0.f, -1.6f, 0.5f));
    CHECK(scene.wind.velocity == glm::vec3(2, 0, 1));
    CHECK(scene.wind.gust == 0.3f);
    CHECK(scene.step.rate == 120.f);
    CHECK(scene.step.substeps == 7u);
    REQUIRE(scene.camera.has_value());
    CHECK(scene.camera->position == glm::vec3(0, 2, 5));
    CHECK(scene.camera->target == glm::vec3(0, 1, 0));
    CHECK(scene.camera->fov == 35.f);
}

TEST_CASE("every key of a cloth is read")
{
    const viewer::SceneFile scene = full_scene();
    REQUIRE(scene.cloths.size() == 2);
    const viewer::ClothEntry& sheet = scene.cloths[0];
    CHECK(sheet.name == "sheet");
    CHECK(sheet.location.line == 5);
    CHECK(sheet.location.path == "cloths[0]");
    const auto& grid = std::get<viewer::GridEntry>(sheet.form);
    CHECK(grid.columns == 8);
    CHECK(grid.rows == 5);
    CHECK(grid.size == glm::vec2(2.4f, 1.2f));
    CHECK(sheet.transform.rotate == glm::vec3(10, 20, 30));
    CHECK(sheet.transform.scale == 2.f);
    CHECK(sheet.velocity == glm::vec3(0, 0, -1));
    CHECK(sheet.integrator == voile::Integrator::verlet);
    CHECK(sheet.self_collision);
    CHECK(sheet.sleep_speed == 0.05f);
    CHECK(sheet.layers == 9u);
    CHECK(scene.cloths[1].layers == 1u);

    CHECK(scene.cloths[1].name == "cloth_1");
    CHECK(std::get<fs::path>(scene.cloths[1].form) == "dir/m/shirt.PLY");
    CHECK(scene.cloths[1].material.preset == "silk");
    CHECK(scene.cloths[1].material.find("thickness") == nullptr);
}

TEST_CASE("every key of a material is read")
{
    const viewer::SceneFile scene = full_scene();
    const viewer::MaterialEntry& material = scene.cloths[0].material;
    CHECK(material.preset == "cotton");
    CHECK(material.bending_model == voile::BendingModel::isometric);
    CHECK(material.values.size() == 15);
    const auto numbers = [&](const char* name)
    {
        const viewer::MaterialValue* value = material.find(name);
        return value != nullptr ? value->numbers : std::vector<float>();
    };
    CHECK(numbers("areal_density") == std::vector{0.2f});
    CHECK(numbers("stretch_stiffness") == std::vector{900.f, 800.f});
    CHECK(numbers("air_drag_normal") == std::vector{1.28f});
    CHECK(numbers("linear_drag") == std::vector{0.1f});
    CHECK(numbers("border_scale").empty());
}

namespace
{

// A value for each component of a parameter, within its range.
template <typename M>
std::vector<float> values_within(const voile::MaterialParameter<M>& parameter)
{
    std::vector<float> values;
    for (size_t i = 0; i < parameter.components().size(); ++i)
        values.push_back(parameter.min + (parameter.max - parameter.min) * 0.125f / static_cast<float>(1 + i));
    return values;
}

template <typename M, size_t N>
void check_every_parameter(const std::string& preset, const std::array<voile::MaterialParameter<M>, N>& parameters)
{
    for (const voile::MaterialParameter<M>& parameter : parameters)
    {
        CAPTURE(parameter.name);
        const std::vector<float> values = values_within(parameter);
        std::string list;
        for (const float value : values)
            list += (list.empty() ? "" : ", ") + viewer::number_text(static_cast<double>(value));
        const auto scene =
            parse(R"({"cloths": [{"grid": {"vertices": [4, 4], "size": [1, 1]}, "material": {"preset": ")" + preset +
                  "\", \"" + parameter.name + "\": " + (values.size() > 1 ? "[" + list + "]" : list) + "}}]}");
        REQUIRE_MESSAGE(scene, scene.error().message);
        const auto made =
            viewer::make_cloth_material(scene.value(), scene.value().cloths[0].material, glm::vec2(1.f / 3));
        REQUIRE_MESSAGE(made, made.error().message);
        const M& material = std::get<M>(made.value());
        for (size_t i = 0; i < values.size(); ++i)
            CHECK(parameter.components()[i].member.get(material) == values[i]);
    }
}

} // namespace

TEST_CASE("every parameter of a fabric and of a material can be written in a scene")
{
    check_every_parameter("silk", voile::k_fabric_parameters);
    check_every_parameter("reference", voile::k_material_parameters);
    check_every_parameter("silk", std::array{*voile::find_parameter(voile::k_material_parameters, "border_scale"),
                                             *voile::find_parameter(voile::k_material_parameters, "spring_damping")});
}

TEST_CASE("one number stands for all components of a parameter")
{
    const auto scene = parse(R"({"cloths": [{"grid": {"vertices": [4, 4], "size": [1, 1]},
        "material": {"preset": "reference", "spring_stiffness": 7}}]})");
    REQUIRE(scene);
    const auto made = viewer::make_cloth_material(scene.value(), scene.value().cloths[0].material, std::nullopt);
    REQUIRE(made);
    CHECK(std::get<voile::Material>(made.value()).springs.structural_warp.stiffness == 7);
    CHECK(std::get<voile::Material>(made.value()).springs.diagonal_bend.stiffness == 7);
}

TEST_CASE("every kind of pin is read")
{
    const viewer::SceneFile scene = full_scene();
    const viewer::ClothEntry& sheet = scene.cloths[0];
    REQUIRE(sheet.pins.size() == 6);
    CHECK(std::get<viewer::CornerPin>(sheet.pins[0].at).corner == 3);
    CHECK(std::get<viewer::EdgePin>(sheet.pins[1].at).edge == viewer::Edge::left);
    CHECK(std::get<viewer::VertexPin>(sheet.pins[2].at).vertex == 39);
    CHECK(std::get<viewer::BoxPin>(sheet.pins[3].at).max == glm::vec3(1));
    CHECK(std::get<viewer::EdgePin>(sheet.pins[4].at).edge == viewer::Edge::top);
    REQUIRE(sheet.pins[4].motion.has_value());
    CHECK(sheet.pins[4].motion->spin == glm::vec3(0, 45, 0));
    CHECK_FALSE(sheet.pins[5].motion.has_value());
}

TEST_CASE("every kind of collider is read")
{
    const viewer::SceneFile scene = full_scene();
    REQUIRE(scene.colliders.size() == 7);
    CHECK(std::get<viewer::MeshShape>(scene.colliders[0].shape).file == "heart.obj");
    CHECK(scene.colliders[0].placed);
    CHECK(scene.colliders[0].friction->static_friction == 0.5f);
    CHECK(scene.colliders[0].friction->kinetic_friction == 0.4f);
    CHECK(scene.colliders[0].motion->pivot == glm::vec3(1));
    CHECK(std::get<viewer::PlaneShape>(scene.colliders[1].shape).y == -0.4f);
    CHECK(scene.colliders[1].friction->kinetic_friction == 0.3f);
    CHECK_FALSE(scene.colliders[1].placed);
    CHECK(std::get<viewer::SphereShape>(scene.colliders[2].shape).radius == 0.5f);
    CHECK(scene.colliders[2].friction->kinetic_friction == 0.6f);
    CHECK(std::get<viewer::CapsuleShape>(scene.colliders[3].shape).to == glm::vec3(0, 1, 0));
    CHECK(std::get<viewer::BoxShape>(scene.colliders[4].shape).max == glm::vec3(1, 2, 3));
    CHECK(scene.colliders[5].frames->pattern == "dir/walk_%04d.obj");
    CHECK(scene.colliders[5].frames->rate == 30.f);
    CHECK(std::get<viewer::MeshShape>(scene.colliders[5].shape).file.empty());
    CHECK(scene.colliders[6].frames->rate == 24.f);
    CHECK(scene.colliders[6].sides == viewer::MeshSides::two);
    CHECK(scene.colliders[6].layers == 1u << 31);
    CHECK_FALSE(scene.colliders[0].sides.has_value());
    CHECK(scene.colliders[0].layers == 1u);
}

TEST_CASE("missing keys have the defaults of the format")
{
    const auto result = parse("{\"cloths\": [{" + k_grid + "}]}");
    REQUIRE(result);
    CHECK(result.value().gravity == glm::vec3(0.f, -9.81f, 0.f));
    CHECK(result.value().step.rate == 60.f);
    CHECK_FALSE(result.value().step.substeps.has_value());
    CHECK_FALSE(result.value().camera.has_value());
    CHECK(result.value().cloths[0].integrator == voile::Integrator::rk4);
    CHECK_FALSE(result.value().cloths[0].self_collision);
    CHECK(result.value().cloths[0].sleep_speed == 0.f);
    CHECK_FALSE(result.value().cloths[0].material.preset.has_value());
    CHECK(parse("{\"step\": {\"substeps\": \"auto\"}, \"cloths\": [{" + k_grid + "}]}").has_value());
}

TEST_CASE("scenes are found by path, then by name")
{
    const TestFolder folder;
    folder.write("flag.json", "{}");
    folder.write("drape.json", "{}");
    folder.write("heart.obj", "");
    const std::vector<fs::path> folders = {folder / "nowhere", folder.path()};
    CHECK(viewer::find_scene("flag", folders).value() == folder / "flag.json");
    CHECK(viewer::find_scene("flag.json", folders).value() == folder / "flag.json");
    const std::string path = (folder / "drape.json").string();
    CHECK(viewer::find_scene(path, {}).value() == path);
    const auto unknown = viewer::find_scene("curtain", folders);
    REQUIRE_FALSE(unknown);
    CHECK(unknown.error().message == "scene \"curtain\" is unknown; the scenes that ship are drape, flag");
    CHECK(viewer::find_scene("drap", folders).error().message ==
          "scene \"drap\" is unknown; the scenes that ship are drape, flag; did you mean \"drape\"?");
    CHECK(viewer::find_scene("fl", folders).error().message ==
          "scene \"fl\" is unknown; the scenes that ship are drape, flag; did you mean \"flag\"?");
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
    // What moves starts where it was placed, exactly.
    const viewer::MotionEntry odd{{1, 2, 3}, {70, 80, -90}, {0.1f, 0.7f, -1.3f}, viewer::SwayEntry{{1, 1, 1}, 0.3f}};
    CHECK(viewer::matrix(odd, 0) == glm::mat4(1));
}

TEST_CASE("a motion with a ramp starts at rest and has its speed after that time")
{
    const viewer::MotionEntry motion{.velocity = {3, 0, 0}, .ramp = 0.5f};
    const auto x = [&](double seconds) { return viewer::matrix(motion, seconds)[3].x; };
    CHECK(x(0.25) == tests::close_to(3 * 0.25 * 0.25 / (2 * 0.5), 1e-6)); // a t^2 / 2
    CHECK(x(0.5) == tests::close_to(3 * 0.25, 1e-6));
    CHECK(x(2) - x(1) == tests::close_to(3, 1e-6));
}

TEST_CASE("a motion that is reversed runs back to its start and stays there")
{
    const viewer::MotionEntry motion{.velocity = {3, 0, 0},
                                     .spin = {90, 0, 0},
                                     .sway = viewer::SwayEntry{{0, 1, 0}, 1.7f},
                                     .ramp = 0.5f,
                                     .reverse_at = 2};
    viewer::MotionEntry forward = motion;
    forward.reverse_at = 0;
    for (const double seconds : {0.25, 1.5, 2.0})
    {
        CHECK(viewer::matrix(motion, seconds) == viewer::matrix(forward, seconds));
        CHECK(viewer::matrix(motion, 4 - seconds) == viewer::matrix(forward, seconds));
    }
    CHECK(viewer::matrix(motion, 4) == glm::mat4(1));
    CHECK(viewer::matrix(motion, 9) == glm::mat4(1));
}

TEST_CASE("the reference scene is that of the report")
{
    const fs::path path = tests::source("samples/scenes/reference.json");
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
    CHECK(grid.size.x / 127.f == tests::close_to(0.08, 8e-8));
    CHECK(scene.cloths[0].transform.translate.y == 4.8f);
    CHECK(scene.cloths[0].transform.translate.x == tests::close_to(5.08, 7e-8));
    CHECK(scene.cloths[0].material.preset == "reference");
    CHECK(scene.cloths[0].integrator == voile::Integrator::rk4);
    CHECK(scene.colliders.size() == 2);
}
