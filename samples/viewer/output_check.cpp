#include "samples/viewer/output_check.hpp"

#include "samples/viewer/exports.hpp"
#include "samples/viewer/point_cache.hpp"
#include "samples/viewer/text.hpp"

#include <utility>

namespace viewer
{

namespace fs = std::filesystem;

namespace
{

struct UsedFile
{
    std::string what; // "the scene's file"
    fs::path path;
};

bool is_same_file(const fs::path& one, const fs::path& other)
{
    std::error_code problem;
    const fs::path path = fs::weakly_canonical(fs::absolute(one, problem), problem);
    return path == fs::weakly_canonical(fs::absolute(other, problem), problem) &&
           (!fs::exists(path, problem) || fs::is_regular_file(path, problem));
}

struct Output
{
    const char* option;
    fs::path path;
};

// `names`: of what is exported, empty as long as they are not known.
std::vector<Output> outputs_of(const Options& options, const std::vector<std::string>& names)
{
    std::vector<Output> outputs;
    if (options.video)
        outputs.push_back({"--video", *options.video});
    if (options.stats)
        outputs.push_back({"--stats", *options.stats});
    for (const ExportTarget& target : options.exports)
    {
        const bool single = names.empty() || target.format == ExportFormat::usd;
        for (const fs::path& path : single ? std::vector{target.path} : export_paths(target.path, names))
        {
            outputs.push_back({"--export", path});
            if (target.format == ExportFormat::point_cache)
                outputs.push_back({"--export", sidecar_path(path)});
        }
    }
    return outputs;
}

voile::Result<void> check(const std::vector<Output>& outputs, std::vector<UsedFile> used)
{
    for (const auto& [option, path] : outputs)
    {
        const std::string its_file = std::string("the file of ") + option;
        for (const UsedFile& file : used)
            if (is_same_file(path, file.path))
                return voile::Error{std::string(option) + ": " + path_in_quotes(path) +
                                    (file.what == its_file ? " is written twice" : " is also " + file.what)};
        used.push_back({its_file, path});
    }
    return {};
}

} // namespace

voile::Result<void> check_outputs(const Options& options)
{
    std::vector<UsedFile> used{{"the scene's file", options.scene}};
    for (const fs::path& collider : options.colliders)
        used.push_back({"--collider's file", collider});
    return check(outputs_of(options, {}), std::move(used));
}

voile::Result<void> check_outputs(const Options& options, const SceneFile& scene,
                                  const std::vector<std::string>& solids)
{
    std::vector<UsedFile> used{{"the scene's file", scene.path}};
    for (const ClothEntry& cloth : scene.cloths)
        if (const auto* mesh = std::get_if<fs::path>(&cloth.form))
            used.push_back({"the mesh of cloth " + in_quotes(cloth.name), *mesh});
    for (const ColliderEntry& collider : scene.colliders)
    {
        if (const auto* mesh = std::get_if<MeshShape>(&collider.shape); mesh != nullptr && !mesh->file.empty())
            used.push_back({"a collider's mesh", mesh->file});
        if (!collider.frames)
            continue;
        if (const auto frames = frame_files(*collider.frames))
            for (const fs::path& frame : frames.value())
                used.push_back({"a frame of a collider's mesh", frame});
    }
    std::vector<std::string> names;
    for (const ClothEntry& cloth : scene.cloths)
        names.push_back(cloth.name);
    if (options.export_colliders)
        names.insert(names.end(), solids.begin(), solids.end());
    return check(outputs_of(options, names), std::move(used));
}

} // namespace viewer
