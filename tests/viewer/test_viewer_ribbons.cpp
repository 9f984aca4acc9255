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

} // namespace

TEST_CASE("the ribbon of the scene twist, coarse, does not intersect itself after three turns")
{
    // Six times as fast: 1440 degrees/s at each end, for 0.37 s in 26 frames.
    const std::string twist =
        changed("twist", {{"[71, 11]", "[36, 6]"},
                          {"230, 0, 0", "1440, 0, 0"},
                          {"0.06, 0, 0", "0.377, 0, 0"},
                          {R"("ramp": 0.5, "reverse_at": 3)", R"("ramp": 0.125, "reverse_at": 0.5)"}});
    CHECK(intersections(twist, 26) == 0);
    CHECK(intersections(without_self_collision(twist), 24) > 0);
}

TEST_CASE("the ribbon of the scene heap, coarse, falls into a heap and does not intersect itself")
{
    const std::string heap = changed("heap", {{"[5, 129]", "[3, 61]"}});
    CHECK(intersections(heap, 60) == 0);
    CHECK(intersections(without_self_collision(heap), 40) > 0);
}
