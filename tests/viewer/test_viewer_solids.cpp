// Solids of scene files in a run: their transforms, motions and layers, in the solver, the picture and the exact
// checks.
#include "support/close_to.hpp"
#include "viewer/viewer_scenes.hpp"

#include "voile/engine/assets/obj.hpp"
#include "voile/engine/assets/shapes.hpp"
#include "voile/mesh_checks.hpp"

#include <array>

namespace
{

using tests::check_refused;
using tests::differing;
using tests::Run;
using tests::run_viewer;
using tests::scene;
using tests::SceneCase;
using tests::SceneResult;
using tests::SceneRuns;
using tests::untouched;

} // namespace

TEST_CASE("a pin holds nothing from the time of its release on, unless a later pin holds the vertex")
{
    const auto pinned = [](const std::string& release)
    {
        return R"(, "pins": [{"at": "edge:top", "release_at": )" + release +
               R"(}, "corner:1"], "self_collision": false, "layers": [], "name": "c)";
    };
    tests::SceneRuns runs;
    const auto results = runs.run_named(tests::scene_of(tests::soft_sheet(pinned("0.1") + R"(0")", 0.6f) + ", " +
                                                            tests::soft_sheet(pinned("0") + R"(1")", 0.6f) + ", " +
                                                            tests::soft_sheet(pinned("9") + R"(2")", 0.6f),
                                                        R"({"plane": {"y": -3}})"),
                                        3, 18, "--validate");
    const auto height = [&](size_t cloth, size_t vertex) { return results[cloth].cloth.positions[vertex].y; };
    for (size_t vertex = 0; vertex < 12; ++vertex) // of the row at the top
    {
        CHECK(height(1, vertex) == 0.6f);
        CHECK(height(2, vertex) == 0.6f);
    }
    CHECK(height(0, 0) < 0.6f - 0.15f); // 0.196 m in free fall
    CHECK(height(0, 11) == 0.6f);
}

TEST_CASE("a transform scales and places every shape")
{
    SceneRuns runs;
    // The same solid written in two ways, in numbers that floats hold exactly.
    const std::array<std::array<const char*, 2>, 4> pairs{{
        {R"({"sphere": {"center": [0, 0.25, 0], "radius": 0.25}})",
         R"({"sphere": {"center": [0, 0, 0], "radius": 0.125}, "transform": {"scale": 2, "translate": [0, 0.25, 0]}})"},
        {R"({"capsule": {"from": [-0.25, 0.25, 0], "to": [0.25, 0.25, 0], "radius": 0.25}})",
         R"({"capsule": {"from": [-0.5, 0, 0], "to": [0.5, 0, 0], "radius": 0.5},
             "transform": {"scale": 0.5, "translate": [0, 0.25, 0]}})"},
        {R"({"box": {"min": [-0.25, 0, -0.25], "max": [0.25, 0.5, 0.25]}})",
         R"({"box": {"min": [-0.5, 0, -0.5], "max": [0.5, 1, 0.5]}, "transform": {"scale": 0.5}})"},
        {R"({"plane": {"y": 0.5}})",
         R"({"plane": {"y": 0.125}, "transform": {"scale": 2, "translate": [3, 0.25, 1]}})"},
    }};
    // A tilted plane lets cloth slide down along its slope, a turned box carries it on its edge.
    std::vector<SceneCase> cases{
        {R"({"plane": {"y": 0}, "friction": 0, "transform": {"rotate": [0, 0, -30], "translate": [0, 0.2, 0]}})"},
        {R"({"box": {"min": [-0.2, -0.2, -0.5], "max": [0.2, 0.2, 0.5]},
             "transform": {"rotate": [0, 0, 45], "translate": [0, 0.25, 0]}})"}};
    for (const auto& [plain, transformed] : pairs)
    {
        cases.push_back({plain});
        cases.push_back({transformed});
    }
    const std::vector<SceneResult> early = runs.run_each(cases, 30);
    CHECK(early[0].deepest < 1e-5);
    for (size_t i = 2; i < cases.size(); i += 2)
    {
        CAPTURE(cases[i].collider);
        CHECK(early[i].cloth.positions == early[i + 1].cloth.positions);
        CHECK(bounds(early[i]).max.y > 0.45f); // it lies on it
    }
    CHECK(bounds(early[1]).max.y == tests::close_to(0.25 + 0.2 * std::sqrt(2), 0.02));
    const SceneResult late = runs.run(scene(cases[0].collider), 60);
    CHECK(late.deepest < 1e-5);
    CHECK(bounds(late).min.x > 0.2f);
}

TEST_CASE("solids move, and the exact checks use their current positions")
{
    SceneRuns runs;
    voile::engine::take(
        voile::engine::save_obj(runs.folder() / "ball.obj", voile::engine::make_sphere({0, 0.25f, 0}, 0.25f, 16)));
    std::vector<SceneCase> cases;
    for (const std::string shape :
         {R"({"plane": {"y": 0.5}, )", R"({"box": {"min": [-1, 0, -1], "max": [1, 0.5, 1]}, )",
          R"({"capsule": {"from": [-0.3, 0.25, 0], "to": [0.3, 0.25, 0], "radius": 0.25}, )",
          R"({"sphere": {"center": [0, 0.25, 0], "radius": 0.25}, )", R"({"mesh": "ball.obj", )"})
        cases.push_back({shape + R"("motion": {"velocity": [0, -0.45, 0], "spin": [0, 20, 0]}})"});
    const std::vector<SceneResult> results = runs.run_each(cases, 40);
    CHECK(results[0].deepest < 1e-5);
    for (size_t i = 0; i < cases.size(); ++i)
    {
        CAPTURE(cases[i].collider);
        // It has sunk 0.3 m: at its pose of time 0 nearly all of the cloth would be inside.
        CHECK(bounds(results[i]).max.y ==
              tests::close_to(0.202, 0.03)); // the fabric's thickness above; measured: 0.2037
    }
    CHECK(runs.run_each(cases, 20, "")[0].deepest < 1e-5); // by the solver's own statistics
    check_refused(
        run_viewer(
            runs.folder().write("s.json", scene(R"({"plane": {"y": 0}, "motion": {"spin": [0, 10800, 0]}})")).string() +
            " --headless --frames 1"),
        {"s.json:3: ", "half a turn per frame"});
}

TEST_CASE("a solid is drawn at its position at the frame's end")
{
    SceneRuns runs;
    // The cloth hangs out of the way.
    const auto with = [](const std::string& ball, const std::string& capsule)
    { return scene(untouched(ball) + ", " + untouched(capsule), R"(, "pins": ["edge:top", "edge:bottom"])", 1.2f); };
    // After 31 frames at 1.2 m/s the ball has gone 0.62 m, and the capsule has made half a turn about a pivot aside.
    const std::string ball = R"({"sphere": {"center": [-0.3, 0.3, 0], "radius": 0.2})";
    const std::string capsule = R"({"capsule": {"from": [-0.5, 0.1, -0.6], "to": [-0.5, 0.5, -0.6], "radius": 0.1})";
    const auto moved = runs.picture(with(ball + R"(, "motion": {"velocity": [1.2, 0, 0]}})",
                                         capsule + R"(, "motion": {"spin": [0, 0, 348.3871], "pivot": [0, 0.5, 0]}})"),
                                    30);
    const auto there =
        runs.picture(with(R"({"sphere": {"center": [0.32, 0.3, 0], "radius": 0.2}})",
                          R"({"capsule": {"from": [0.5, 0.9, -0.6], "to": [0.5, 0.5, -0.6], "radius": 0.1}})"),
                     30);
    CHECK(differing(moved, there) < 60);
    CHECK(differing(moved, runs.picture(with(ball + "}", capsule + "}"), 30)) > 500);
}

TEST_CASE("cloth touches only the solids of its layers, and a mesh pushes it to the chosen side")
{
    SceneRuns runs;
    voile::engine::take(
        voile::engine::save_obj(runs.folder() / "ball.obj", voile::engine::make_sphere({0, 0.6f, 0}, 0.5f, 16)));
    const std::string solids = R"({"plane": {"y": 0.5}, "layers": [1]}, {"plane": {"y": 0}, "layers": [2, 7]},
{"mesh": "ball.obj", "sides": "two", "layers": [3]}, {"mesh": "ball.obj", "layers": [4]})";
    std::string cloths;
    for (const char* members :
         {R"("layers": [1, 2], "name": "c0")", R"("layers": [7], "name": "c1")", R"("layers": [], "name": "c2")",
          R"("layers": [3], "name": "c3")", R"("layers": [4], "name": "c4")"})
        cloths += (cloths.empty() ? "" : ",\n") + tests::soft_sheet(std::string(", ") + members, 0.6f);
    const std::vector<SceneResult> results = runs.run_named(tests::scene_of(cloths, solids), 5, 60);
    CHECK(results[0].deepest < 1e-5); // the plane above is not of those that fall on the lower one
    CHECK(bounds(results[0]).min.y > 0.5f);
    CHECK(bounds(results[1]).max.y < 0.01f);
    CHECK(bounds(results[2]).min.y < -0.1f);
    // A mesh that pushes outwards does not keep the cloth: it comes out at the top.
    CHECK(bounds(results[3]).min.y > 0.1f);
    CHECK(bounds(results[3]).min.y < 0.15f);
    CHECK(bounds(results[4]).min.y > 0.6f);
}

TEST_CASE("a mesh of the command line takes over the motion of the scene's mesh")
{
    SceneRuns runs;
    voile::engine::take(
        voile::engine::save_obj(runs.folder() / "ball.obj", voile::engine::make_sphere({0, 0.25f, 0}, 0.25f, 16)));
    voile::engine::take(
        voile::engine::save_obj(runs.folder() / "box.obj", voile::engine::make_box({-3, 0, -3}, {3, 6, 3})));
    const std::string text =
        scene(R"({"mesh": "ball.obj", "motion": {"velocity": [0, -0.45, 0]}, "layers": [4]})", R"(, "layers": [4])");
    const SceneResult result = runs.run(text, 40, "--verify --collider " + (runs.folder() / "box.obj").string());
    CHECK(bounds(result).max.y == tests::close_to(0.202, 0.05)); // measured: 0.2067
    CHECK(result.deepest < 1e-5);
}

TEST_CASE("--debug shows boxes that move with their mesh, contacts where cloth touches, and normals")
{
    SceneRuns runs;
    voile::engine::take(
        voile::engine::save_obj(runs.folder() / "ball.obj", voile::engine::make_sphere({-0.3f, 0.3f, 0}, 0.2f, 16)));
    const auto is_like = [](const voile::engine::Picture& picture, size_t pixel, const glm::ivec3& color)
    {
        const uint8_t* p = &picture.rgba[4 * pixel];
        return std::abs(p[0] - color.r) + std::abs(p[1] - color.g) + std::abs(p[2] - color.b) < 60;
    };
    // The pixels of a color: how many, and the mean of their columns.
    const auto find = [&](const voile::engine::Picture& picture, const glm::ivec3& color)
    {
        glm::vec2 found(0);
        for (size_t i = 0; i < picture.rgba.size() / 4; ++i)
            if (is_like(picture, i, color))
                found += glm::vec2(1, i % picture.width);
        return glm::vec2(found.x, found.y / std::max(found.x, 1.f));
    };
    const glm::ivec3 boxes(38, 137, 243);
    const glm::ivec3 contacts(255, 225, 38);
    const glm::ivec3 normals(89, 231, 137);
    const std::string ball = R"({"mesh": "ball.obj", "motion": {"velocity": [1.2, 0, 0]}})";
    const auto with = [](const std::string& solid)
    { return scene(solid + R"(, {"plane": {"y": 0}})", R"(, "velocity": [0, -4, 0])", 0.9f); };
    const std::string text = with(ball);

    const voile::engine::Picture bare = runs.picture(text, 18);
    CHECK(find(bare, boxes).x < 5);
    CHECK(find(bare, contacts).x < 5);
    CHECK(find(bare, normals).x < 5);
    const auto [start, later] = runs.pictures(text, 0, 18, "--debug boxes:0 --debug contacts --validate");
    CHECK(find(start, boxes).x > 100);
    CHECK(find(start, contacts).x == 0); // it has not fallen far enough
    CHECK(find(later, contacts).x > 8);
    // 18 frames at 1.2 m/s are 0.36 m: at 4.1 m and 40 degrees, 61 pixels a meter or a little more.
    CHECK(find(later, boxes).y - find(start, boxes).y == tests::close_to(0.36 * 62, 0.15));
    const voile::engine::Picture others =
        runs.picture(with(untouched(ball)), 1, "--debug boxes:5 --debug normals --validate");
    CHECK(find(others, boxes).x > find(later, boxes).x);
    CHECK(find(others, normals).x > 30);
}

TEST_CASE("--debug intersections paints and counts the vertices around a mesh through the cloth, --verify counts them")
{
    SceneRuns runs;
    voile::engine::take(
        voile::engine::save_obj(runs.folder() / "ball.obj", voile::engine::make_sphere({0, 0.3f, 0}, 0.2f, 16)));
    const std::string text = scene(R"({"mesh": "ball.obj"})", "", 0.3f);
    const auto painted = [](const voile::engine::Picture& picture)
    {
        int count = 0;
        for (size_t i = 0; i < picture.rgba.size(); i += 4)
            count += std::abs(picture.rgba[i] - 249) + std::abs(picture.rgba[i + 1] - 38) +
                                 std::abs(picture.rgba[i + 2] - 89) <
                             60
                         ? 1
                         : 0;
        return count;
    };
    const auto counted = [](const std::string& output)
    {
        CAPTURE(output);
        CHECK(output.find("intersections: 0 pairs of cloth, ") != std::string::npos);
        CHECK(output.find(" 0 of cloth and collider") == std::string::npos);
    };
    CHECK(painted(runs.picture(text, 1)) == 0);
    CHECK(runs.output().find("intersections") == std::string::npos);
    CHECK(painted(runs.picture(text, 1, "--debug intersections --validate")) > 20);
    counted(runs.output());
    CHECK(painted(runs.picture(text, 1, "--verify --validate")) == 0);
    counted(runs.output());
}

TEST_CASE("a cloth with self_collision does not pass through itself, and statistics count what does")
{
    SceneRuns runs;
    const auto fallen = [&](const std::string& self_collision)
    {
        // It lands on its edge.
        const std::string cloth = R"({"grid": {"vertices": [16, 16], "size": [0.6, 0.6]},
"material": {"preset": "silk", "stretch_stiffness": 100, "shear_stiffness": 10},
"transform": {"translate": [0, 0.35, 0], "rotate": [87, 0, 0]})" +
                                  self_collision + "}";
        const auto file = runs.folder().write("s.json", tests::scene_of(cloth, R"({"plane": {"y": 0}})"));
        const auto path = [&](const char* name) { return (runs.folder() / name).string(); };
        const Run run =
            run_viewer(file.string() + " --headless --size 64x36 --frames 30 --validate --verify --export " +
                       path("s.obj") + " --stats " + path("s.stats"));
        CAPTURE(run.errors);
        REQUIRE(run.exit_code == 0);
        const auto statistics = voile::engine::take(viewer::parse_json(runs.folder().read("s.stats"), "s.stats"));
        const viewer::JsonNode* last = statistics.find("summary")->find("last");
        const std::vector<glm::vec3> positions =
            voile::engine::take(
                voile::engine::load_mesh(path("s.obj"), nullptr, voile::engine::MeshVertices::positions))
                .positions;
        std::vector<glm::uvec3> triangles; // of the solver: the file has quads
        for (uint32_t row = 0; row < 15; ++row)
            for (uint32_t i = 16 * row; i < 16 * row + 15; ++i)
                triangles.insert(triangles.end(), {{i, i + 16, i + 1}, {i + 1, i + 16, i + 17}});
        CHECK(last->find("self_intersections")->number ==
              static_cast<double>(voile::count_self_intersections(positions, triangles)));
        return glm::dvec2(last->find("self_intersections")->number, last->find("intersecting_cloth_pairs")->number);
    };
    CHECK(fallen(R"(, "self_collision": true)") == glm::dvec2(0));
    CHECK(glm::all(glm::greaterThan(fallen(""), glm::dvec2(100)))); // only cloth that asks for it
}

TEST_CASE("the moving scene runs at a coarse resolution, and its cloths stay outside")
{
    const Run run = run_viewer("moving --headless --size 64x36 --cloth-resolution 16 --frames 25 --validate --verify");
    CAPTURE(run.errors);
    CHECK(run.exit_code == 0);
    CHECK(run.output.find("verified: 0 penetrating vertices") != std::string::npos);
}

TEST_CASE("without a camera the picture shows the whole scene, and the scene fills most of it")
{
    SceneRuns runs;
    for (const char* size : {"[4, 0.5]", "[0.5, 4]"})
    {
        CAPTURE(size);
        const voile::engine::Picture picture = runs.picture(
            R"({"gravity": [0, 0, 0], "cloths": [{"grid": {"vertices": [4, 4], "size": )" + std::string(size) +
                R"(}, "transform": {"rotate": [90, 0, 0]}, "look": {"color": "#ff0000", "pattern": "none"}}]})",
            1);
        glm::uvec2 low(picture.width, picture.height);
        glm::uvec2 high(0);
        for (uint32_t y = 0; y < picture.height; ++y)
            for (uint32_t x = 0; x < picture.width; ++x)
            {
                const uint8_t* p = &picture.rgba[size_t{4} * (size_t{y} * picture.width + x)];
                if (p[0] < 2 * p[1])
                    continue;
                low = glm::min(low, glm::uvec2(x, y));
                high = glm::max(high, glm::uvec2(x, y));
            }
        CHECK(low.x > 0);
        CHECK(low.y > 0);
        CHECK(high.x < picture.width - 1);
        CHECK(high.y < picture.height - 1);
        CHECK((high.x - low.x > picture.width * 2 / 3 || high.y - low.y > picture.height * 2 / 3));
    }
}
