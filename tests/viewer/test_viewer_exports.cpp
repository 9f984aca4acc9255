// Exports of runs: the start and every frame, cloths and colliders, grids and meshes with texture coordinates.
#include "viewer/viewer_scenes.hpp"

#include <cstring>

namespace
{

using tests::Run;
using tests::run_viewer;

using Sample = std::vector<glm::vec3>;

std::vector<Sample> samples_of(const std::string& bytes)
{
    int32_t counts[5]; // version, points, start, rate, samples
    REQUIRE(bytes.size() >= 32);
    std::memcpy(counts, bytes.data() + 12, sizeof(counts));
    std::vector<Sample> samples(static_cast<size_t>(counts[4]), Sample(static_cast<size_t>(counts[1])));
    REQUIRE(bytes.size() == 32 + samples.size() * samples[0].size() * sizeof(glm::vec3));
    for (size_t i = 0; i < samples.size(); ++i)
        std::memcpy(samples[i].data(), bytes.data() + 32 + i * samples[0].size() * sizeof(glm::vec3),
                    samples[0].size() * sizeof(glm::vec3));
    return samples;
}

Sample positions_of(const std::filesystem::path& file)
{
    return voile::engine::take(voile::engine::load_mesh(file, nullptr, voile::engine::MeshVertices::positions))
        .positions;
}

// A grid, a mesh whose texture has a seam, a box that moves, a deforming mesh and a plane.
std::string write_scene(const TestFolder& folder)
{
    folder.write("patch.obj",
                 "v 0 0 0\nv 0.5 0 0\nv 0.5 0 0.5\nv 0 0 0.5\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.25\n"
                 "f 1/1 4/4 3/3\nf 1/5 3/3 2/2\n");
    folder.write("rise_0.obj", "v 5 0 0\nv 6 0 0\nv 5 0 -1\nf 1 2 3\n");
    folder.write("rise_1.obj", "v 5 1 0\nv 6 1 0\nv 5 1 -1\nf 1 2 3\n");
    return folder
        .write("s.json", R"({"step": {"rate": 30}, "cloths": [
{"name": "grid", "grid": {"vertices": [5, 4], "size": [1, 1]}, "transform": {"translate": [0, 1, 0], "rotate": [10, 20, 30]},
 "material": "silk"},
{"name": "patch", "mesh": "patch.obj", "transform": {"translate": [0.1, 2, 0.1]}, "material": "silk"}],
"colliders": [{"plane": {"y": 0}},
{"box": {"min": [0, 0, 0], "max": [1, 0.5, 1]}, "motion": {"velocity": [3, 0, 0]}},
{"frames": "rise_%d.obj", "rate": 3}]})")
        .string();
}

} // namespace

TEST_CASE("exports hold the start, every frame and the end, of cloths and colliders")
{
    const TestFolder folder;
    const std::string scene = write_scene(folder) + " --headless --size 64x36 --validate --export-colliders ";
    const auto to = [&](const std::string& name) { return " --export " + (folder / name).string(); };
    const Run start = run_viewer(scene + "--frames 0" + to("start.obj") + to("start.pc2") + to("start.usda"));
    CAPTURE(start.errors);
    REQUIRE(start.exit_code == 0);
    const Run end = run_viewer(scene + "--frames 7" + to("end.obj") + to("run.pc2") + to("end.ply") + to("run.usda"));
    CAPTURE(end.errors);
    REQUIRE(end.exit_code == 0);
    for (const std::string name : {"grid", "patch", "box", "rise"})
    {
        CAPTURE(name);
        const std::string file = "_" + name;
        const std::vector<Sample> samples = samples_of(folder.read("run" + file + ".pc2"));
        REQUIRE(samples.size() == 8);
        CHECK(samples.front() == positions_of(folder / ("start" + file + ".obj")));
        CHECK(samples.back() == positions_of(folder / ("end" + file + ".obj")));
        CHECK(samples.back() == positions_of(folder / ("end" + file + ".ply")));
        CHECK(samples.front() != samples.back());
        CHECK(samples_of(folder.read("start" + file + ".pc2")) == std::vector<Sample>{samples.front()});
        CHECK(folder.read("run" + file + ".pc2.json")
                  .starts_with("{\"frames_per_second\": 30, \"start_frame\": 0, "
                               "\"samples\": 8, "));
    }
    // Where they are after 7 frames of 1/30 s.
    CHECK(positions_of(folder / "end_box.obj")[0].x - positions_of(folder / "start_box.obj")[0].x ==
          doctest::Approx(0.7f));
    CHECK(positions_of(folder / "end_rise.obj")[0].y == doctest::Approx(0.7f));
    CHECK(std::filesystem::exists(folder / "end_plane.obj"));
    CHECK_FALSE(std::filesystem::exists(folder / "run_plane.pc2")); // it stays
    // One prim per cloth and collider, with a sample per frame where something moves.
    const std::string usd = folder.read("run.usda");
    for (const std::string prim : {"grid", "patch", "plane", "box", "rise"})
        CHECK(usd.find("\n    def Mesh \"" + prim + "\"") != std::string::npos);
    const auto count = [&](const std::string& word)
    {
        size_t found = 0;
        for (size_t at = usd.find(word); at != std::string::npos; at = usd.find(word, at + 1))
            ++found;
        return found;
    };
    CHECK(count("\n            7: ") == 10); // points, extents and normals of three meshes, and a pose
    CHECK(count("\n            8: ") == 0);
    CHECK(usd.find("timeCodesPerSecond = 30\n") != std::string::npos);
    CHECK(usd.find("endTimeCode = 7\n") != std::string::npos);
}

TEST_CASE("quads, normals and the texture coordinates of a mesh come out as they went in")
{
    const TestFolder folder;
    const Run run =
        run_viewer(write_scene(folder) + " --headless --size 64x36 --frames 1 --export " + (folder / "c.obj").string());
    CAPTURE(run.errors);
    REQUIRE(run.exit_code == 0);
    const std::string grid = folder.read("c_grid.obj");
    CHECK(grid.find("vt 0 1\nvt 0.25 1\n") != std::string::npos);
    CHECK(grid.find("f 1/1/1 6/6/6 7/7/7 2/2/2\n") != std::string::npos);
    CHECK(std::count(grid.begin(), grid.end(), 'f') == 12);
    CHECK(std::filesystem::exists(folder / "c_patch.obj"));
    CHECK_FALSE(std::filesystem::exists(folder / "c_plane.obj")); // only with --export-colliders
    const auto mesh = voile::engine::take(
        voile::engine::load_mesh(folder / "c_patch.obj", nullptr, voile::engine::MeshVertices::positions));
    const auto file = voile::engine::take(
        voile::engine::load_mesh(folder / "patch.obj", nullptr, voile::engine::MeshVertices::positions));
    CHECK(mesh.texture_map.coordinates == file.texture_map.coordinates);
    CHECK(mesh.texture_map.triangles == file.texture_map.triangles);
    CHECK(mesh.triangles == file.triangles);
}
