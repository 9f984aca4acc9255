// Meshes that deform in scene files: they carry cloth, are placed and drawn as they are at each frame's end, and what
// cannot be used is refused.
#include "viewer/viewer_scenes.hpp"

#include "samples/scenes/figure.hpp"
#include "samples/scenes/garments.hpp"
#include "voile/engine/assets/obj.hpp"

namespace
{

namespace fs = std::filesystem;
using tests::check_refused;
using tests::differing;
using tests::Run;
using tests::run_viewer;
using tests::scene;
using tests::SceneCase;
using tests::SceneResult;
using tests::SceneRuns;
using tests::untouched;

// A square sheet of 1 m, flat at a height of 0.3 m and raised to a dome by `amount`: 0.3 m in its middle, none at its
// corners.
voile::engine::Mesh dome(float amount)
{
    constexpr uint32_t k_side = 17; // vertices
    voile::engine::Mesh mesh;
    for (uint32_t row = 0; row < k_side; ++row)
        for (uint32_t column = 0; column < k_side; ++column)
        {
            const glm::vec2 p = glm::vec2(column, row) / float{k_side - 1} - 0.5f;
            mesh.positions.emplace_back(p.x, 0.3f + amount * (0.3f - 0.6f * glm::dot(p, p)), p.y);
        }
    for (uint32_t row = 0; row + 1 < k_side; ++row)
        for (uint32_t column = 0; column + 1 < k_side; ++column)
        {
            const uint32_t i = row * k_side + column;
            mesh.triangles.emplace_back(i, i + k_side, i + 1);
            mesh.triangles.emplace_back(i + 1, i + k_side, i + k_side + 1);
        }
    return mesh;
}

voile::engine::Mesh moved(voile::engine::Mesh mesh, float scale, const glm::vec3& by)
{
    for (glm::vec3& p : mesh.positions)
        p = scale * p + by;
    return mesh;
}

void save(const SceneRuns& runs, const std::string& name, const voile::engine::Mesh& mesh)
{
    voile::engine::take(voile::engine::save_obj(runs.folder() / name, mesh));
}

} // namespace

TEST_CASE("a rising sheet lifts the cloth on it, and the exact checks use its current position")
{
    SceneRuns runs;
    save(runs, "dome_0.obj", dome(0));
    save(runs, "dome_1.obj", dome(1));
    // Up in half a second, then at rest. The cloth starts 5 cm above the sheet, below what becomes of its middle. Where
    // no collider has its layer, a cloth falls through the sheet: the checks can fail.
    const std::vector<SceneCase> cases{{R"({"mesh": "dome_0.obj", "friction": 0.8})", 0.35f},
                                       {R"({"frames": "dome_%d.obj", "rate": 2, "friction": 0.8})", 0.35f},
                                       {"", 0.35f}};
    const std::vector<SceneResult> results = runs.run_each(cases, 40);
    const SceneResult& lifted = results[1];
    CHECK(bounds(results[0]).max.y < 0.32f);
    CHECK(bounds(lifted).max.y > 0.58f);
    CHECK(bounds(lifted).min.y > 0.45f);
    CHECK(lifted.deepest < 1e-5);
    CHECK(bounds(results[2]).max.y < 0.1f);
    // The solver's statistics count it, too, and the run is the same to the bit.
    const std::vector<SceneResult> again = runs.run_each(cases, 40, "--validate");
    CHECK(again[1].deepest < 1e-5);
    CHECK(again[1].cloth.positions == lifted.cloth.positions);
}

TEST_CASE("a transform and a rigid motion place all frames")
{
    SceneRuns runs;
    for (const int i : {0, 1})
    {
        const std::string number = std::to_string(i) + ".obj";
        const voile::engine::Mesh mesh = dome(static_cast<float>(i));
        save(runs, "dome_" + number, mesh);
        save(runs, "half_" + number, moved(mesh, 0.5f, glm::vec3(0)));
        save(runs, "fall_" + number, moved(mesh, 1, glm::vec3(0.05f, -0.1f, 0) * static_cast<float>(i)));
    }
    const std::vector<SceneResult> results =
        runs.run_each({{R"({"frames": "dome_%d.obj", "rate": 2})", 0.35f},
                       {R"({"frames": "half_%d.obj", "rate": 2, "transform": {"scale": 2}})", 0.35f},
                       // Within `motion` too; a mesh of its faces may stand beside it and changes nothing.
                       {R"({"mesh": "half_1.obj", "motion": {"frames": "dome_%d.obj", "rate": 2}})", 0.35f},
                       {R"({"frames": "dome_%d.obj", "rate": 2, "motion": {"velocity": [0.1, -0.2, 0]}})", 0.35f},
                       {R"({"frames": "fall_%d.obj", "rate": 2})", 0.35f}},
                      15);
    const SceneResult& plain = results[0];
    CHECK(plain.deepest < 1e-5);
    CHECK(results[1].cloth.positions == plain.cloth.positions);
    CHECK(results[2].cloth.positions == plain.cloth.positions);
    const SceneResult& both = results[3];
    const SceneResult& baked = results[4];
    CHECK(bounds(both).max.y < bounds(plain).max.y - 0.03f);
    double apart = 0;
    for (size_t i = 0; i < both.cloth.positions.size(); ++i)
        apart = std::max(apart, double{glm::distance(both.cloth.positions[i], baked.cloth.positions[i])});
    CHECK(apart < 1e-3); // roundings grow from contact to contact
}

TEST_CASE("a deforming mesh is drawn with its vertices and normals at the frame's end")
{
    SceneRuns runs;
    save(runs, "dome_0.obj", dome(0));
    save(runs, "dome_1.obj", dome(1));
    save(runs, "end.obj", moved(dome(1), 1, {0.5f, 0, 0}));
    // The cloth hangs out of the way, and touches nothing: kernels of contact take seconds to make.
    const auto hung = [](const std::string& collider) {
        return scene(untouched(collider) + R"(, {"plane": {"y": 0}})", R"(, "pins": ["edge:top", "edge:bottom"])",
                     1.2f);
    };
    // Of both frames in flight.
    const auto now = runs.pictures(hung(R"({"frames": "dome_%d.obj", "rate": 2})"), 20, 21, "--validate");
    const auto start = runs.pictures(hung(R"({"mesh": "dome_0.obj"})"), 20, 21);
    const auto check = [&](uint32_t frame, const voile::engine::Picture& seen, const voile::engine::Picture& before)
    {
        CAPTURE(frame);
        save(runs, "there.obj", dome(static_cast<float>(frame + 1) / 30));
        CHECK(differing(seen, runs.picture(hung(R"({"mesh": "there.obj"})"), frame), 3) < 20); // so that shading counts
        CHECK(differing(seen, before) > 300);
    };
    check(20, now.first, start.first);
    check(21, now.second, start.second);
    // At rest since frame 9, and moved 0.5 m.
    const auto end = runs.pictures(hung(R"({"mesh": "end.obj"})"), 39, 40);
    for (const uint32_t frame : {39u, 40u})
    {
        CAPTURE(frame);
        const std::string velocity = std::to_string(30. / (frame + 1));
        const voile::engine::Picture rest = runs.picture(
            hung(R"({"frames": "dome_%d.obj", "rate": 6, "motion": {"velocity": [)" + velocity + ", 0, 0]}}"), frame);
        CHECK(differing(rest, frame == 39 ? end.first : end.second) < 60); // the shadow map covers more
    }
}

TEST_CASE("frames that no file gets are not drawn, and change no pixel of the others")
{
    SceneRuns runs;
    const TestFolder& folder = runs.folder();
    save(runs, "dome_0.obj", dome(0));
    save(runs, "dome_1.obj", dome(1));
    const fs::path file = folder.write("s.json", scene(untouched(R"({"sphere": {"center": [0.5, 0.3, 0], "radius": 0.2},
"motion": {"velocity": [-1.2, 0, 0]}})") + ", " + untouched(R"({"frames": "dome_%d.obj", "rate": 4})") +
                                                           R"(, {"plane": {"y": 0}})",
                                                       R"(, "pins": ["edge:top"])", 0.9f));
    const auto frames = [&](const std::string& name, const std::string& options)
    {
        const std::string out = (folder / name).string();
        const Run run =
            run_viewer(file.string() + " --headless --size 160x90 --frames 8 --validate --out " + out + " " + options);
        CAPTURE(run.errors);
        REQUIRE(run.exit_code == 0);
        return out;
    };
    const std::string all = frames("all", "");
    const std::string some = frames("some", "--every 7"); // of both frames in flight
    const std::string drawn = frames("drawn", "--every 7 --stats " + (folder / "stats.json").string());
    for (const char* picture : {"/frame_0000.png", "/frame_0007.png"})
    {
        CHECK(tests::text_of(all + picture) == tests::text_of(some + picture));
        CHECK(tests::text_of(all + picture) == tests::text_of(drawn + picture));
    }
    const std::string passes = tests::text_of(folder / "stats.json");
    CHECK(passes.find("\"shadow") != std::string::npos); // times of every pass
}

TEST_CASE("--debug, --export and --collider work with deforming meshes")
{
    SceneRuns runs;
    save(runs, "dome_0.obj", dome(0));
    save(runs, "dome_1.obj", dome(1));
    save(runs, "plate.obj", dome(0));
    const std::string text = scene(R"({"frames": "dome_%d.obj", "rate": 4})", "", 0.35f);
    const fs::path file = runs.folder().write("d.json", text);
    const std::string base = file.string() + " --headless --size 64x36 --frames 12 --validate --verify ";
    const Run boxes = run_viewer(base + "--debug boxes --debug contacts --debug normals --export " +
                                 (runs.folder() / "c.pc2").string());
    CAPTURE(boxes.errors);
    CHECK(boxes.exit_code == 0);
    CHECK(boxes.errors.find("note: collider \"dome\" deforms: its boxes are on the GPU alone") != std::string::npos);
    CHECK(boxes.output.find("verified: 0 penetrating vertices") != std::string::npos);
    CHECK(fs::file_size(runs.folder() / "c.pc2") == 32 + 13 * 12 * 12 * 12);
    // With a mesh that keeps its shape instead: no note.
    const Run replaced = run_viewer(base + "--debug boxes --collider " + (runs.folder() / "plate.obj").string());
    CHECK(replaced.exit_code == 0);
    CHECK(replaced.errors.find("note:") == std::string::npos);
}

TEST_CASE("the jelly scene runs at a coarse resolution, and its cloth stays outside")
{
    const Run run = run_viewer("jelly --headless --size 64x36 --cloth-resolution 16 --frames 25 --validate --verify");
    CAPTURE(run.errors);
    CHECK(run.exit_code == 0);
    CHECK(run.output.find("verified: 0 penetrating vertices") != std::string::npos);
}

TEST_CASE("a sequence that cannot be used is named with the scene's line and the file")
{
    const TestFolder folder;
    const std::string quad = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\n";
    const std::string faces = "f 1 3 2\nf 1 4 3\n";
    const auto refused = [&](const std::string& collider, const std::vector<std::string>& parts)
    {
        const fs::path file = folder.write("s.json", scene(collider));
        check_refused(run_viewer(file.string() + " --headless --frames 1 --size 64x36"), parts);
    };
    const std::string frames = R"({"frames": "w%d.obj", "rate": 30})";
    refused(R"({"frames": "walk.obj"})", {"s.json:3: colliders[0].frames", "walk.obj", "%d"});
    refused(frames, {"s.json:3: colliders[0].frames: ", "w%d.obj: there is no frame 0 and no frame 1"});
    folder.write("w0.obj", quad + faces);
    folder.write("w2.obj", quad + faces);
    refused(frames, {"s.json:3: colliders[0].frames: ", "w1.obj is missing, but w2.obj is there"});
    folder.write("w1.obj", quad + "v 2 0 0\n" + faces);
    refused(frames, {"s.json:3: colliders[0].frames: ", "w1.obj: has 5 vertices, but the first has 4 (w0.obj)"});
    folder.write("w1.obj", quad + "f 1 3 2\nf 1 4 2\n");
    refused(frames, {"s.json:3: colliders[0].frames: ", "w1.obj: joins vertices 0 3 1", "the first joins 0 3 2"});
    folder.write("w1.obj", quad + "f 1 3 2\nf 1 4 9\n");
    refused(R"({"plane": {"y": 0}}, )" + frames, {"s.json:3: colliders[1].frames: ", "w1.obj:6"});
    folder.write("w1.obj", quad + faces);
    folder.write("rest.obj", quad + "v 2 0 0\n" + faces);
    refused(R"({"mesh": "rest.obj", "frames": "w%d.obj"})",
            {"s.json:3: colliders[0].frames: ", "rest.obj: has 5 vertices, but the first has 4 (w0.obj)"});
    refused(R"({"mesh": "gone.obj", "frames": "w%d.obj"})", {"s.json:3: colliders[0].mesh: ", "gone.obj"});
}

TEST_CASE("a pin follows a mesh that deforms and moves")
{
    SceneRuns runs;
    save(runs, "up_0.obj", dome(0));
    save(runs, "up_1.obj", moved(dome(0), 1, {0, 0.5f, 0}));
    // The plate rises by half a meter in half a second and turns by a right angle.
    const std::string collider = R"({"frames": "up_%d.obj", "rate": 2, "layers": [], "motion": {"spin": [0, 180, 0]}})";
    const std::string cloths = tests::soft_sheet(R"(, "name": "c0", "pins": ["corner:0"])", 0.35f) + ",\n" +
                               tests::soft_sheet(R"(, "name": "c1", "pins": [{"at": "corner:0", "follow": 0}])", 0.35f);
    const std::vector<SceneResult> results = runs.run_named(tests::scene_of(cloths, collider), 2, 30);
    CHECK(glm::distance(results[0].cloth.positions[0], glm::vec3(-0.3f, 0.35f, -0.3f)) < 1e-4f);
    CHECK(glm::distance(results[1].cloth.positions[0], glm::vec3(-0.3f, 0.85f, 0.3f)) < 1e-4f);
    const fs::path file = runs.folder().write(
        "s.json", scene(R"({"plane": {"y": 0}})", R"(, "pins": [{"at": "corner:0", "follow": 0}])"));
    check_refused(run_viewer(file.string() + " --headless --frames 1"),
                  {"s.json:", "cloths[0].pins[0]: follows colliders[0], which is no mesh of this run"});
}

TEST_CASE("the dressed figure starts to walk, and no cloth intersects cloth or figure")
{
    const Run run = run_viewer("dressed --headless --size 64x36 --frames 4 --validate --verify");
    CAPTURE(run.errors);
    CAPTURE(run.output);
    CHECK(run.exit_code == 0);
    CHECK(run.output.find("verified: 0 penetrating vertices, deepest 0 mm, 0 self-intersections") != std::string::npos);
    CHECK(run.output.find("intersections: 0 pairs of cloth, 0 of cloth and collider") != std::string::npos);
}

TEST_CASE("the dressed figure has walked for a cycle in coarse clothes, and no cloth intersects cloth")
{
    const TestFolder folder;
    const fs::path built = tests::program("../scenes");
    fs::copy(built / "dressed.json", folder / "dressed.json");
    for (uint32_t i = 0; i < scenes::k_walk_frames; ++i)
    {
        const std::string file = "figure_" + std::to_string(i) + ".obj";
        fs::create_symlink(fs::absolute(built / file), folder / file);
    }
    constexpr uint32_t k_coarseness = 4; // a sixteenth of the vertices, a quarter of the substeps
    voile::engine::take(voile::engine::save_obj(folder / "skirt.obj", scenes::make_skirt(k_coarseness)));
    voile::engine::take(
        voile::engine::save_obj(folder / "cape.obj", scenes::make_cape(scenes::Figure().at(0), k_coarseness)));
    const Run run = run_viewer((folder / "dressed.json").string() + " --headless --size 16x16 --frames " +
                               std::to_string(scenes::k_walk_frames) + " --verify");
    CAPTURE(run.errors);
    CAPTURE(run.output);
    CHECK(run.exit_code == 0); // and so all vertices are finite
    CHECK(run.output.find("verified: 0 penetrating vertices, deepest 0 mm, 0 self-intersections") != std::string::npos);
    CHECK(run.output.find("intersections: 0 pairs of cloth, ") != std::string::npos);
}
