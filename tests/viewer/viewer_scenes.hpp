// Scenes of one sheet and some colliders, run by the viewer, and what came of them.
#pragma once

#include "support/test_folder.hpp"
#include "viewer/viewer_run.hpp"

#include "samples/viewer/json_tree.hpp"
#include "voile/engine/assets/image_file.hpp"
#include "voile/engine/assets/load_mesh.hpp"
#include "voile/engine/gpu/device.hpp"

namespace tests
{

inline const std::string k_camera = R"("camera": {"position": [0, 1, 4], "target": [0, 0.4, 0]})";

// A sheet of silk at a height, and colliders.
inline std::string scene(const std::string& colliders, const std::string& cloth = "", float height = 0.6f)
{
    return R"({"cloths": [{"grid": {"vertices": [12, 12], "size": [0.6, 0.6]}, "material": "silk",
"transform": {"translate": [0, )" +
           std::to_string(height) + ", 0]}" + cloth + "}],\n\"colliders\": [" + colliders + "],\n" + k_camera + "}";
}

struct SceneResult
{
    std::string hash;
    double deepest = 0; // m
    voile::engine::Mesh cloth;
};

class SceneRuns
{
public:
    // With the exact checks. Without, the depth is that of the solver's own statistics.
    SceneResult run(const std::string& text, uint32_t frames, const std::string& options = "--validate --verify")
    {
        const auto file = folder_.write("s.json", text);
        const Run run =
            run_viewer(file.string() + " --headless --size 64x36 --frames " + std::to_string(frames) + " " + options +
                       " --stats " + (folder_ / "s.stats").string() + " --export " + (folder_ / "s.obj").string());
        CAPTURE(run.errors);
        REQUIRE(run.exit_code == 0);
        const auto statistics = voile::engine::take(viewer::parse_json(text_of(folder_ / "s.stats"), "s.stats"));
        const viewer::JsonNode* summary = statistics.find("summary");
        REQUIRE(summary != nullptr);
        return {summary->find("state_hash")->text, summary->find("deepest_penetration")->number,
                voile::engine::take(voile::engine::load_mesh(folder_ / "s.obj"))};
    }

    voile::engine::Picture picture(const std::string& text, uint32_t frame, const std::string& options = "")
    {
        const auto file = folder_.write("s.json", text);
        const Run run =
            run_viewer(file.string() + " --headless --size 320x180 --frames " + std::to_string(frame + 1) +
                       " --every " + std::to_string(frame) + " --out " + folder_.path().string() + " " + options);
        CAPTURE(run.errors);
        REQUIRE(run.exit_code == 0);
        std::string number = std::to_string(frame);
        number.insert(0, 4 - number.size(), '0');
        return voile::engine::take(voile::engine::load_png(folder_ / ("frame_" + number + ".png")));
    }

    [[nodiscard]] const TestFolder& folder() const { return folder_; }

private:
    TestFolder folder_;
};

inline voile::engine::Bounds bounds(const SceneResult& result)
{
    return voile::engine::bounds(result.cloth);
}

// How many pixels differ plainly: by more than this in red and green together, of 510.
inline int differing(const voile::engine::Picture& a, const voile::engine::Picture& b, int plainly = 40)
{
    int count = 0;
    for (size_t i = 0; i < a.rgba.size(); i += 4)
        count += std::abs(a.rgba[i] - b.rgba[i]) + std::abs(a.rgba[i + 1] - b.rgba[i + 1]) > plainly;
    return count;
}

} // namespace tests
