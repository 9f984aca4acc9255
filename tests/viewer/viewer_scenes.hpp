// Scenes of one sheet and some colliders, run by the viewer, and what came of them.
#pragma once

#include "support/test_folder.hpp"
#include "viewer/viewer_run.hpp"

#include "samples/viewer/json_tree.hpp"
#include "voile/engine/assets/image_file.hpp"
#include "voile/engine/assets/load_mesh.hpp"
#include "voile/engine/gpu/device.hpp"

#include <utility>

namespace tests
{

inline const std::string k_camera = R"("camera": {"position": [0, 1, 4], "target": [0, 0.4, 0]})";

// A sheet at a height, m, with more members of its object: silk that stretches more, so that it needs few substeps.
inline std::string soft_sheet(const std::string& members, float height)
{
    return R"({"grid": {"vertices": [12, 12], "size": [0.6, 0.6]},
"material": {"preset": "silk", "stretch_stiffness": 100, "shear_stiffness": 10}, "transform": {"translate": [0, )" +
           std::to_string(height) + ", 0]}" + members + "}";
}

inline std::string scene_of(const std::string& cloths, const std::string& colliders)
{
    return R"({"cloths": [)" + cloths + "],\n\"colliders\": [" + colliders + "],\n" + k_camera + "}";
}

// A sheet and colliders.
inline std::string scene(const std::string& colliders, const std::string& cloth = "", float height = 0.6f)
{
    return scene_of(soft_sheet(cloth, height), colliders);
}

// A collider that is drawn, and that no cloth touches.
inline std::string untouched(const std::string& collider)
{
    return collider.substr(0, collider.rfind('}')) + R"(, "layers": []})";
}

// A sheet and its collider among others in one scene. Their layers keep them apart.
struct SceneCase
{
    std::string collider; // an object without `layers`, or empty: none
    float height = 0.6f;  // m
};

struct SceneResult
{
    double deepest = 0; // m, of all cloths of the run
    voile::engine::Mesh cloth;
};

class SceneRuns
{
public:
    // With the exact checks. Without, the depth is that of the solver's own statistics.
    SceneResult run(const std::string& text, uint32_t frames, const std::string& options = "--validate --verify")
    {
        const double deepest = run_scene(text, frames, options);
        return {deepest, voile::engine::take(voile::engine::load_mesh(folder_ / "s.obj"))};
    }

    // All cases in one run.
    std::vector<SceneResult> run_each(const std::vector<SceneCase>& cases, uint32_t frames,
                                      const std::string& options = "--validate --verify")
    {
        std::string cloths;
        std::string colliders;
        for (size_t i = 0; i < cases.size(); ++i)
        {
            const std::string layers = R"(, "layers": [)" + std::to_string(i) + "]";
            const std::string separator = i == 0 ? "" : ",\n";
            cloths += separator + soft_sheet(layers + R"(, "name": "c)" + std::to_string(i) + '"', cases[i].height);
            const std::string& collider = cases[i].collider;
            if (!collider.empty())
                colliders += (colliders.empty() ? "" : ",\n") + collider.substr(0, collider.rfind('}')) + layers + "}";
        }
        return run_named(scene_of(cloths, colliders), cases.size(), frames, options);
    }

    // A scene with as many cloths, which are called c0, c1 and so on.
    std::vector<SceneResult> run_named(const std::string& text, size_t cloths, uint32_t frames,
                                       const std::string& options = "--validate --verify")
    {
        const double deepest = run_scene(text, frames, options);
        std::vector<SceneResult> results;
        for (size_t i = 0; i < cloths; ++i)
            results.push_back({deepest, voile::engine::take(
                                            voile::engine::load_mesh(folder_ / ("s_c" + std::to_string(i) + ".obj")))});
        return results;
    }

    voile::engine::Picture picture(const std::string& text, uint32_t frame, const std::string& options = "")
    {
        return pictures(text, frame, frame, options).second;
    }

    // The frame `last`, and an earlier one: the first, or one in the second half.
    std::pair<voile::engine::Picture, voile::engine::Picture> pictures(const std::string& text, uint32_t earlier,
                                                                       uint32_t last, const std::string& options = "")
    {
        const auto file = folder_.write("s.json", text);
        const uint32_t every = earlier == 0 ? last : earlier;
        const Run run =
            run_viewer(file.string() + " --headless --size 320x180 --frames " + std::to_string(last + 1) + " --every " +
                       std::to_string(every) + " --out " + folder_.path().string() + " " + options);
        CAPTURE(run.errors);
        REQUIRE(run.exit_code == 0);
        output_ = run.output;
        const auto load = [&](uint32_t frame)
        {
            std::string number = std::to_string(frame);
            number.insert(0, 4 - number.size(), '0');
            return voile::engine::take(voile::engine::load_png(folder_ / ("frame_" + number + ".png")));
        };
        return {load(earlier), load(last)};
    }

    [[nodiscard]] const TestFolder& folder() const { return folder_; }

    // Of the last run that drew pictures.
    [[nodiscard]] const std::string& output() const { return output_; }

private:
    // m: the deepest penetration. The exact checks print it; statistics take longer, because they measure every pass of
    // every frame.
    double run_scene(const std::string& text, uint32_t frames, const std::string& options)
    {
        const bool verifies = options.find("--verify") != std::string::npos;
        const auto file = folder_.write("s.json", text);
        const Run run = run_viewer(file.string() + " --headless --size 64x36 --frames " + std::to_string(frames) + " " +
                                   options + (verifies ? "" : " --stats " + (folder_ / "s.stats").string()) +
                                   " --export " + (folder_ / "s.obj").string());
        CAPTURE(run.errors);
        REQUIRE(run.exit_code == 0);
        if (verifies)
        {
            const std::string before = "penetrating vertices, deepest ";
            const size_t found = run.output.find(before);
            REQUIRE(found != std::string::npos);
            return std::stod(run.output.substr(found + before.size())) / 1000; // of mm
        }
        const auto statistics = voile::engine::take(viewer::parse_json(text_of(folder_ / "s.stats"), "s.stats"));
        const viewer::JsonNode* summary = statistics.find("summary");
        REQUIRE(summary != nullptr);
        return summary->find("last")->find("deepest_penetration")->number;
    }

    TestFolder folder_;
    std::string output_;
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
