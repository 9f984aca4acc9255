// Scenes written as JSON.
#include "support/test_folder.hpp"
#include "support/test_paths.hpp"

#include "samples/viewer/materials.hpp"
#include "samples/viewer/scene_writer.hpp"

#include "voile/fabrics.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace
{

// Every key of a scene, with another value than its default, as the writer writes it.
constexpr const char* k_all = R"({
  "gravity": [0.1, -1.6, 0.5],
  "wind": {"velocity": [2, 0, 1], "gust": 0.3, "gust_length": 2.5, "air_density": 1},
  "step": {"rate": 120, "substeps": 7, "max_substeps": 300},
  "cloths": [{
    "name": "sheet",
    "grid": {"vertices": [8, 5], "size": [2.4, 1.2]},
    "transform": {"translate": [1, 2, 3], "rotate": [10, 20, 30], "scale": 2},
    "material": {"preset": "wool", "areal_density": 0.2, "stretch_stiffness": [900, 800], "bending_model": "springs"},
    "pins": ["corner:3", "edge:left", "vertex:39", {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}},
             {"at": "edge:bottom", "motion": {"velocity": [1, 0, 0], "spin": [0, 45, 0], "pivot": [0, 1, 0],
                                              "sway": {"amplitude": [0.5, 0, 0], "period": 3}},
              "stiffness": 50, "damping": 0.2, "max_distance": 0.1},
             {"at": {"box": {"min": [0, 0, 0], "max": [0, 1, 1]}}, "max_distance": 0.3},
             {"at": "edge:left", "release_at": 2.5},
             {"at": "corner:0", "follow": 6}],
    "tethers": {"stretch": 0.02},
    "velocity": [0, 0, -1],
    "integrator": "verlet",
    "self_collision": true,
    "sleep_speed": 0.05,
    "layers": [0, 3],
    "look": {"color": [0.5, 0.25, 0.125], "back_color": [0, 0, 1], "weave": "twill", "pattern": "stripes", "threads": 250,
             "roughness": 0.5, "sheen": 0.25, "translucency": 0.75}
  }, {"name": "shirt", "mesh": "m/shirt.PLY", "material": "silk"}, {"name": "towel", "mesh": "towel.obj"}],
  "colliders": [
    {"mesh": "../heart.obj", "transform": {"rotate": [0, 90, 0]}, "friction": {"static": 0.5, "kinetic": 0.4},
     "motion": {"velocity": [0, 1, 0], "spin": [0, 45, 0], "pivot": [1, 1, 1]}, "sides": "one"},
    {"plane": {"y": -0.4}, "friction": {"static": 0.3, "kinetic": 0.3}},
    {"sphere": {"center": [0, 1, 0], "radius": 0.5}, "transform": {},
     "look": {"color": [0.5, 0.25, 0], "roughness": 0.25, "metallic": 1}},
    {"capsule": {"from": [0, 0, 0], "to": [0, 1, 0], "radius": 0.2}},
    {"box": {"min": [0, 0, 0], "max": [1, 2, 3]}},
    {"frames": "walk_%04d.obj", "rate": 30},
    {"mesh": "walk.obj", "motion": {"spin": [0, 9, 0], "pivot": [1, 0, 0], "ramp": 0.5, "reverse_at": 3}, "frames": "w%d.obj", "rate": 24,
     "loop": true, "sides": "two", "layers": [31]}
  ],
  "camera": {"position": [0, 2, 5], "target": [0, 1, 0], "fov": 35}
})";

viewer::SceneFile parsed(const std::string& text, const std::filesystem::path& path)
{
    auto scene = viewer::parse_scene(text, path);
    if (!scene)
        FAIL(scene.error().message);
    return scene.value();
}

std::string read(const std::filesystem::path& path)
{
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

} // namespace

TEST_CASE("a scene is written with every key that it has")
{
    const viewer::SceneFile scene = parsed(k_all, "/dir/s.json");
    CHECK(nlohmann::json::parse(viewer::scene_text(scene, "/dir")) == nlohmann::json::parse(k_all));
    // Elsewhere its paths lead to the same files.
    const viewer::SceneFile moved = parsed(viewer::scene_text(scene, "/other/deep"), "/other/deep/t.json");
    CHECK(std::get<std::filesystem::path>(moved.cloths[1].form) == "/dir/m/shirt.PLY");
    CHECK(moved.colliders[5].frames->pattern == "/dir/walk_%04d.obj");
    CHECK(viewer::scene_text(moved, "/dir") == viewer::scene_text(scene, "/dir"));
}

TEST_CASE("every scene that ships is the same after it was written")
{
    const TestFolder folder;
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(tests::source("samples/scenes")))
    {
        if (entry.path().extension() != ".json")
            continue;
        CAPTURE(entry.path().string());
        const viewer::SceneFile scene = parsed(read(entry.path()), entry.path());
        const std::filesystem::path copy = folder / entry.path().filename().string();
        REQUIRE(viewer::save_scene(scene, copy));
        const viewer::SceneFile again = parsed(read(copy), copy);
        CHECK(viewer::scene_text(again, "/") == viewer::scene_text(scene, "/"));
        // What the parser reads, but for the words of a pin and the order of keys, is what was there.
        const auto before = nlohmann::json::parse(read(entry.path()));
        const auto after = nlohmann::json::parse(viewer::scene_text(scene, entry.path().parent_path()));
        CHECK(after.at("cloths").size() == before.at("cloths").size());
        for (const char* key : {"camera", "wind"})
            if (before.contains(key))
                CHECK(after.at(key) == before.at(key));
        ++count;
    }
    CHECK(count >= 8);
}

TEST_CASE("the entry of a material makes that material")
{
    viewer::SceneFile scene;
    voile::Fabric fabric = voile::denim();
    fabric.areal_density = 0.123f;
    fabric.bending_model = voile::BendingModel::springs;
    const auto made = viewer::make_cloth_material(scene, viewer::entry_of(fabric), std::nullopt);
    REQUIRE(made);
    CHECK(voile::to_string(std::get<voile::Fabric>(made.value())) == voile::to_string(fabric));

    voile::Material material = voile::reference_material();
    material.vertex_mass = 0.5f;
    material.springs.shear.stiffness = 77;
    material.bending_stiffness = 0.25f;
    const auto raw = viewer::make_cloth_material(scene, viewer::entry_of(material), std::nullopt);
    REQUIRE(raw);
    CHECK(voile::to_string(std::get<voile::Material>(raw.value())) == voile::to_string(material));
}
