// Scene files: what is read, and how every kind of bad input is worded.
#include "samples/viewer/scene_file.hpp"

#include <doctest/doctest.h>

#include <string>

namespace
{

constexpr const char* k_grid = R"("grid": {"vertices": [4, 3], "size": [1, 2]})";

gpu::Result<viewer::SceneFile> parse(const std::string& text)
{
    return viewer::parse_scene(text, "dir/s.json");
}

std::string message(const std::string& text)
{
    const auto result = parse(text);
    return result ? "accepted" : result.error().message;
}

// The message for a scene with one cloth, a grid and `rest`.
std::string cloth_message(const std::string& rest)
{
    return message("{\"cloths\": [{" + std::string(k_grid) + ", " + rest + "}]}");
}

std::string collider_message(const std::string& collider)
{
    return message("{\"cloths\": [{" + std::string(k_grid) + "}], \"colliders\": [" + collider + "]}");
}

std::string scene_message(const std::string& rest)
{
    return message("{\"cloths\": [{" + std::string(k_grid) + "}], " + rest + "}");
}

} // namespace

TEST_CASE("every key of the format is read")
{
    const auto result = parse(R"({
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
    "self_collision": false
  }, {"mesh": "m/shirt.PLY", "material": "silk"}],
  "colliders": [
    {"mesh": "../heart.obj", "transform": {"rotate": [0, 90, 0]}, "friction": {"static": 0.5, "kinetic": 0.4},
     "motion": {"velocity": [0, 1, 0], "spin": [0, 45, 0], "pivot": [1, 1, 1]}},
    {"plane": {"y": -0.4}, "friction": 0.3},
    {"sphere": {"center": [0, 1, 0], "radius": 0.5}, "friction": {"static": 0.6}},
    {"capsule": {"from": [0, 0, 0], "to": [0, 1, 0], "radius": 0.2}},
    {"box": {"min": [0, 0, 0], "max": [1, 2, 3]}},
    {"frames": "walk_%04d.obj", "rate": 30},
    {"mesh": "walk.obj", "motion": {"frames": "w%d.obj", "rate": 24}}
  ],
  "camera": {"position": [0, 2, 5], "target": [0, 1, 0], "fov": 35}
})");
    REQUIRE_MESSAGE(result, result.error().message);
    const viewer::SceneFile& scene = result.value();
    CHECK(scene.name == "s");
    CHECK(scene.gravity == glm::vec3(0.f, -1.6f, 0.5f));
    CHECK(scene.wind.velocity == glm::vec3(2, 0, 1));
    CHECK(scene.wind.gust == 0.3f);
    CHECK(scene.step.rate == 120.f);
    CHECK(scene.step.substeps == 7u);
    REQUIRE(scene.cloths.size() == 2);

    const viewer::ClothEntry& sheet = scene.cloths[0];
    CHECK(sheet.name == "sheet");
    CHECK(sheet.line == 5);
    const auto& grid = std::get<viewer::GridEntry>(sheet.form);
    CHECK(grid.columns == 8);
    CHECK(grid.rows == 5);
    CHECK(grid.size == glm::vec2(2.4f, 1.2f));
    CHECK(sheet.transform.rotate == glm::vec3(10, 20, 30));
    CHECK(sheet.transform.scale == 2.f);
    CHECK(sheet.velocity == glm::vec3(0, 0, -1));
    CHECK(sheet.integrator == viewer::Integrator::verlet);
    CHECK_FALSE(sheet.self_collision);
    const viewer::MaterialEntry& material = sheet.material;
    CHECK(material.preset == "cotton");
    CHECK(material.areal_density == 0.2f);
    CHECK(material.stretch_stiffness == glm::vec2(900, 800));
    CHECK(material.shear_stiffness == 300.f);
    CHECK(material.bending_stiffness == 2e-5f);
    CHECK(material.damping_ratio == 0.1f);
    CHECK(material.thickness == 0.005f);
    CHECK(material.static_friction == 0.5f);
    CHECK(material.kinetic_friction == 0.4f);
    CHECK(material.air_drag_normal == 1.28f);
    CHECK(material.air_drag_tangential == 0.05f);
    CHECK(material.strain_limit == 0.1f);
    CHECK(material.bending_model == viewer::BendingModel::isometric);
    CHECK(material.vertex_mass == 0.15f);
    CHECK(material.spring_stiffness == 400.f);
    CHECK(material.spring_damping == 10.f);
    CHECK(material.linear_drag == 0.1f);
    REQUIRE(sheet.pins.size() == 6);
    CHECK(std::get<viewer::CornerPin>(sheet.pins[0].at).corner == 3);
    CHECK(std::get<viewer::EdgePin>(sheet.pins[1].at).edge == viewer::Edge::left);
    CHECK(std::get<viewer::VertexPin>(sheet.pins[2].at).vertex == 39);
    CHECK(std::get<viewer::BoxPin>(sheet.pins[3].at).max == glm::vec3(1));
    CHECK(std::get<viewer::EdgePin>(sheet.pins[4].at).edge == viewer::Edge::top);
    REQUIRE(sheet.pins[4].motion.has_value());
    CHECK(sheet.pins[4].motion->spin == glm::vec3(0, 45, 0));
    CHECK_FALSE(sheet.pins[5].motion.has_value());

    CHECK(scene.cloths[1].name == "cloth_1");
    CHECK(std::get<std::filesystem::path>(scene.cloths[1].form) == "dir/m/shirt.PLY");
    CHECK(scene.cloths[1].material.preset == "silk");
    CHECK_FALSE(scene.cloths[1].material.thickness.has_value());

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
    CHECK(scene.camera->fov == 35.f);
}

TEST_CASE("what is not written has the defaults of the format")
{
    const auto result = parse("{\"cloths\": [{" + std::string(k_grid) + "}]}");
    REQUIRE(result);
    CHECK(result.value().gravity == glm::vec3(0.f, -9.81f, 0.f));
    CHECK(result.value().step.rate == 60.f);
    CHECK_FALSE(result.value().step.substeps.has_value());
    CHECK_FALSE(result.value().camera.has_value());
    CHECK(result.value().cloths[0].integrator == viewer::Integrator::rk4);
    CHECK_FALSE(result.value().cloths[0].material.preset.has_value());
    CHECK(parse("{\"step\": {\"substeps\": \"auto\"}, \"cloths\": [{" + std::string(k_grid) + "}]}").ok());
}

TEST_CASE("an unknown key is named, with its line, its place and the key that may be meant")
{
    CHECK(message("{\n\"cloths\": [{\n\"grid\": {\"vertices\": [4, 3], \"size\": [1, 2]},\n\"material\": {\n"
                  "\"thicknes\": 0.1\n}}]}") ==
          "dir/s.json:5: unknown key \"thicknes\" in cloths[0].material; did you mean \"thickness\"?");
    CHECK(scene_message("\"zzzzzz\": 1") == "dir/s.json:1: unknown key \"zzzzzz\" in the scene");
    CHECK(cloth_message("\"pins\": [{\"boxx\": 1}]") ==
          "dir/s.json:1: unknown key \"boxx\" in cloths[0].pins[0]; did you mean \"box\"?");
    CHECK(scene_message("\"a\\nb\": 1") == "dir/s.json:1: unknown key \"a?b\" in the scene");
}

TEST_CASE("a syntax error has its line and column")
{
    CHECK(message("{\n  \"cloths\": [,]\n}").starts_with("dir/s.json:2:14: syntax error"));
    CHECK(message("{\"cloths\": [").starts_with("dir/s.json:1:13: syntax error"));
    CHECK(message("{} x").starts_with("dir/s.json:1:4: syntax error"));
    CHECK(message("{\"a\": nan}").starts_with("dir/s.json:1:"));
    CHECK(message("{\"a\": \"\xff\"}").starts_with("dir/s.json:1:8: syntax error"));
    CHECK(message(std::string(100000, '[')) == "dir/s.json:1: more than 64 levels of nesting");
    for (const char* text : {"{\n", "[", "\"", "{\"a\"", "\x01", "{\"a\": 1,}", "// c\n{}"})
        CHECK(message(text).find('\n') == std::string::npos);
}

TEST_CASE("the line of a number is that of its own, not of the line end behind it")
{
    CHECK(message("{\n\"gravity\":\n3\n\n}") == "dir/s.json:3: gravity is a number; expected an array of 3 numbers");
    CHECK(message("{\n\"gravity\": [0, 0,\n\"x\"\n]}") == "dir/s.json:3: gravity[2] is a string; expected a number");
}

TEST_CASE("an empty text and another root are refused")
{
    CHECK(message("") == "dir/s.json: the file is empty");
    CHECK(message(" \n\t") == "dir/s.json: the file is empty");
    CHECK(message("[]") == "dir/s.json:1: the scene is an array; expected an object");
    CHECK(message("{}") == "dir/s.json:1: the scene has no \"cloths\"");
    CHECK(message("{\"cloths\": []}") == "dir/s.json:1: cloths is empty; a scene needs a cloth");
    CHECK(message("{\"cloths\": {}}") == "dir/s.json:1: cloths is an object; expected an array");
    CHECK(message("{\"cloths\": [null]}") == "dir/s.json:1: cloths[0] is null; expected an object");
}

TEST_CASE("a key that appears twice is refused")
{
    CHECK(message("{\"gravity\": [0, 0, 0],\n\"gravity\": [0, 1, 0]}") ==
          "dir/s.json:2: key \"gravity\" appears twice in the scene");
    CHECK(cloth_message("\"name\": \"a\",\n\"name\": \"b\"") ==
          "dir/s.json:2: key \"name\" appears twice in cloths[0]");
}

TEST_CASE("numbers that are not finite, out of range or of the wrong kind")
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
    CHECK(scene_message("\"wind\": {\"gust\": -1}") == "dir/s.json:1: wind.gust is -1; it must be at least 0");
    CHECK(cloth_message("\"material\": {\"thickness\": 0}") ==
          "dir/s.json:1: cloths[0].material.thickness is 0; it must be larger than 0");
    CHECK(cloth_message("\"material\": {\"areal_density\": 1e-300}") ==
          "dir/s.json:1: cloths[0].material.areal_density is 1e-300; it must be larger than 0");
    CHECK(cloth_message("\"transform\": {\"scale\": -1}") ==
          "dir/s.json:1: cloths[0].transform.scale is -1; it must be larger than 0");
    CHECK(cloth_message("\"self_collision\": 1") ==
          "dir/s.json:1: cloths[0].self_collision is a number; expected true or false");
}

TEST_CASE("grids")
{
    const auto grid = [](const std::string& text) { return message("{\"cloths\": [{\"grid\": " + text + "}]}"); };
    CHECK(grid(R"({"vertices": [0, 4], "size": [1, 1]})") ==
          "dir/s.json:1: cloths[0].grid.vertices[0] is 0; it must be within 2 to 8192");
    CHECK(grid(R"({"vertices": [4, 1], "size": [1, 1]})") ==
          "dir/s.json:1: cloths[0].grid.vertices[1] is 1; it must be within 2 to 8192");
    CHECK(grid(R"({"vertices": [4, -3], "size": [1, 1]})") ==
          "dir/s.json:1: cloths[0].grid.vertices[1] is -3; it must be within 2 to 8192");
    CHECK(grid(R"({"vertices": [4, 99999], "size": [1, 1]})") ==
          "dir/s.json:1: cloths[0].grid.vertices[1] is 99999; it must be within 2 to 8192");
    CHECK(grid(R"({"vertices": [4, 4], "size": [-1, 1]})") ==
          "dir/s.json:1: cloths[0].grid.size[0] is -1; it must be larger than 0");
    CHECK(grid(R"({"vertices": [4], "size": [1, 1]})") ==
          "dir/s.json:1: cloths[0].grid.vertices has 1 item; expected an array of 2 numbers");
    CHECK(grid(R"({"vertices": [4, 4]})") == "dir/s.json:1: cloths[0].grid has no \"size\"");
    CHECK(message("{\"cloths\": [{}]}") == "dir/s.json:1: cloths[0] has neither \"grid\" nor \"mesh\"");
    CHECK(cloth_message("\"mesh\": \"a.obj\"") == "dir/s.json:1: cloths[0] has both \"grid\" and \"mesh\"");
}

TEST_CASE("words, names and pins of a cloth")
{
    CHECK(cloth_message("\"material\": \"velvet\"") ==
          "dir/s.json:1: cloths[0].material is \"velvet\", which is not a material (silk, cotton, wool, denim, "
          "leather, reference)");
    CHECK(cloth_message("\"material\": {\"preset\": \"velvet\"}")
              .starts_with("dir/s.json:1: cloths[0].material.preset is \"velvet\", which is not a material"));
    CHECK(cloth_message("\"material\": {\"static_friction\": 0.2, \"kinetic_friction\": 0.3}") ==
          "dir/s.json:1: cloths[0].material.kinetic_friction is above static_friction, 0.200000003");
    CHECK(cloth_message("\"material\": {\"stretch_stiffness\": [1, 2, 3]}") ==
          "dir/s.json:1: cloths[0].material.stretch_stiffness has 3 items; expected an array of 2 numbers");
    CHECK(cloth_message("\"material\": {\"stretch_stiffness\": 1000}") == "accepted");
    CHECK(cloth_message("\"material\": 3") == "dir/s.json:1: cloths[0].material is a number; expected an object");
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
    CHECK(cloth_message("\"pins\": [\"vertex:12\"]") == at + "\"vertex:12\", but the grid has 12 vertices");
    CHECK(cloth_message("\"pins\": [\"vertex:11\"]") == "accepted");
    CHECK(cloth_message("\"pins\": [\"nail:1\"]") ==
          at + "\"nail:1\"; a pin is corner:N, edge:NAME, vertex:N or a box");
    CHECK(cloth_message("\"pins\": [7]") == at + "a number; expected corner:N, edge:NAME, vertex:N or a box");
    CHECK(cloth_message("\"pins\": [{\"motion\": {}}]") == "dir/s.json:1: cloths[0].pins[0] has no \"at\"");
    CHECK(cloth_message("\"pins\": [{\"box\": {\"min\": [2, 0, 0], \"max\": [1, 1, 1]}}]") ==
          "dir/s.json:1: cloths[0].pins[0].box has a min above its max");
    CHECK(message("{\"cloths\": [{\"mesh\": \"a.obj\", \"pins\": [\"edge:top\"]}]}") ==
          at + "\"edge:top\", but only a grid has corners and edges");
}

TEST_CASE("colliders and camera")
{
    const std::string at = "dir/s.json:1: colliders[0]";
    CHECK(collider_message("{}") == at + " has no shape: mesh, plane, sphere, capsule, box or frames");
    CHECK(collider_message(R"({"mesh": "a.obj", "plane": {"y": 0}})") ==
          at + " has both \"mesh\" and \"plane\"; it needs one of them");
    CHECK(collider_message(R"({"mesh": "a.stl"})") ==
          at + ".mesh is \"a.stl\"; expected a file that ends in .obj or .ply");
    CHECK(collider_message(R"({"sphere": {"center": [0, 0, 0], "radius": -1}})") ==
          at + ".sphere.radius is -1; it must be larger than 0");
    CHECK(collider_message(R"({"sphere": {"radius": 1}})") == at + ".sphere has no \"center\"");
    CHECK(collider_message(R"({"box": {"min": [0, 0, 0], "max": [1, 0, 1]}})") ==
          at + ".box is empty: each number of min must be below that of max");
    CHECK(collider_message(R"({"plane": {"y": 0}, "friction": {"static": 0.1, "kinetic": 0.2}})") ==
          at + ".friction has a kinetic coefficient above the static one");
    CHECK(collider_message(R"({"plane": {"y": 0}, "friction": {}})") ==
          at + ".friction has neither \"static\" nor \"kinetic\"");
    CHECK(collider_message(R"({"plane": {"y": 0}, "friction": "ice"})") ==
          at + ".friction is a string; expected an object");
    CHECK(collider_message(R"({"plane": {"y": 0}, "frames": "w%d.obj"})") ==
          at + " has \"frames\", which deform a mesh, and a plane");
    for (const char* pattern :
         {"walk.obj", "w%s.obj", "w%d_%d.obj", "w%9999d.obj", "w%n.obj", "w%.obj", "w%0999999d.obj"})
        CHECK(collider_message("{\"frames\": \"" + std::string(pattern) + "\"}") ==
              at + ".frames is \"" + pattern + "\"; a file name with one %d or %04d is expected");
    CHECK(collider_message(R"({"mesh": "a.obj", "rate": 30})") == at + ".rate needs \"frames\" beside it");
    CHECK(collider_message(R"({"frames": "a%d.obj", "motion": {"frames": "a%d.obj"}})") ==
          at + ".motion.frames is given twice: in the collider and in its motion");
    CHECK(scene_message(R"("camera": {"position": [0, 0, 0], "target": [0, 0, 0]})") ==
          "dir/s.json:1: camera has its target where its position is");
    CHECK(scene_message(R"("camera": {"position": [0, 0, 1], "target": [0, 0, 0], "fov": 180})") ==
          "dir/s.json:1: camera.fov is 180; it must be within 1 to 170");
    CHECK(scene_message(R"("camera": {"position": [0, 0, 1]})") == "dir/s.json:1: camera has no \"target\"");
}
