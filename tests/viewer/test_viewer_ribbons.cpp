// The scenes of ribbons, coarse: they are twisted and poured without intersections, and not by chance.
#include "viewer/viewer_scenes.hpp"

#include <utility>
#include <vector>

namespace
{

namespace fs = std::filesystem;
using tests::Run;
using tests::run_viewer;

using Replacements = std::vector<std::pair<std::string, std::string>>;

// The text with other values, each of which it has.
std::string replaced(std::string text, const Replacements& replacements)
{
    for (const auto& [from, to] : replacements)
    {
        REQUIRE(text.find(from) != std::string::npos);
        for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
            text.replace(at, from.size(), to);
    }
    return text;
}

std::string changed(const std::string& scene, const Replacements& replacements)
{
    return replaced(tests::text_of((fs::path(tests::source("samples/scenes")) / (scene + ".json")).string()),
                    replacements);
}

std::string without_self_collision(const std::string& text)
{
    return replaced(text, {{R"("self_collision": true)", R"("self_collision": false)"}});
}

// Self-intersections of the last of these frames.
int intersections(const std::string& text, int frames)
{
    const TestFolder folder;
    const fs::path file = folder.write("s.json", text);
    const Run run = run_viewer(file.string() + " --headless --size 16x16 --verify --frames " + std::to_string(frames));
    CAPTURE(run.errors);
    CAPTURE(run.output);
    REQUIRE(run.exit_code == 0);
    const std::string before = "verified: 0 penetrating vertices, deepest 0 mm, ";
    const size_t found = run.output.find(before);
    REQUIRE(found != std::string::npos);
    return std::stoi(run.output.substr(found + before.size()));
}

// The most self-intersections after any of these frames.
int most_intersections(const std::string& text, int frames)
{
    const TestFolder folder;
    const fs::path file = folder.write("s.json", text);
    const fs::path statistics = folder / "statistics.json";
    const Run run = run_viewer(file.string() + " --headless --size 16x16 --debug intersections --stats " +
                               statistics.string() + " --frames " + std::to_string(frames));
    CAPTURE(run.errors);
    REQUIRE(run.exit_code == 0);
    const std::string written = tests::text_of(statistics.string());
    const std::string key = R"("intersecting_cloth_pairs": )";
    const size_t found = written.find(key, written.find(R"("maxima")"));
    REQUIRE(found != std::string::npos);
    return std::stoi(written.substr(found + key.size()));
}

} // namespace

TEST_CASE("the ribbon of the scene twist, twisted faster, does not intersect itself, also after it is let go")
{
    // Three times as fast: 1,350 degrees/s at each end, let go after 90 frames.
    const std::string twist = changed("twist", {{"450, 0, 0", "1350, 0, 0"},
                                                {"0.07, 0, 0", "0.21, 0, 0"},
                                                {R"("ramp": 1)", R"("ramp": 0.33333333)"},
                                                {R"("release_at": 4.5)", R"("release_at": 1.5)"}});
    CHECK(most_intersections(twist, 100) == 0);
    CHECK(most_intersections(without_self_collision(twist), 60) > 0);
}

TEST_CASE("the ribbon of the scene heap, coarse, falls into a heap and does not intersect itself")
{
    const std::string heap = changed("heap", {{"[5, 129]", "[3, 61]"}});
    CHECK(intersections(heap, 60) == 0);
    CHECK(intersections(without_self_collision(heap), 40) > 0);
}
