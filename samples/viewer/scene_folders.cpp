// Scenes by name.
#include "samples/viewer/scene_file.hpp"

#include "samples/viewer/text.hpp"

#include "voile/engine/assets/words.hpp"

#include <algorithm>
#include <cstdlib>
#include <set>

namespace viewer
{
namespace
{

namespace fs = std::filesystem;

// "the scenes that ship are drape, flag", and the one that may be meant.
std::string scene_list(const std::string& name, const std::vector<std::string>& known)
{
    std::string list;
    for (const std::string& each : known)
        list += (list.empty() ? "" : ", ") + voile::gpu::printable(each);
    if (list.empty())
        return "no scenes were found to choose from";
    return "the scenes that ship are " + list + suggestion(fs::path(name).stem().string(), known);
}

} // namespace

std::vector<std::string> scene_names(const std::vector<fs::path>& folders)
{
    std::set<std::string> names;
    for (const fs::path& folder : folders)
    {
        std::error_code problem;
        for (fs::directory_iterator it(folder, problem), end; !problem && it != end; it.increment(problem))
        {
            if (it->path().extension() == ".json")
                names.insert(it->path().stem().string());
        }
    }
    return {names.begin(), names.end()};
}

std::vector<fs::path> scene_folders()
{
    std::vector<fs::path> folders;
    if (const char* variable = std::getenv("VOILE_SCENES"))
    {
        std::string rest = variable;
        while (!rest.empty())
        {
            const size_t colon = rest.find(':');
            if (colon != 0)
                folders.emplace_back(rest.substr(0, colon));
            rest = colon == std::string::npos ? "" : rest.substr(colon + 1);
        }
    }
    std::error_code problem;
    const fs::path program = fs::read_symlink("/proc/self/exe", problem);
    if (!problem)
    {
        const fs::path beside = program.parent_path();
        folders.push_back(beside.parent_path() / "scenes");
        folders.push_back(beside / "scenes");
        folders.push_back(beside.parent_path() / "share" / "voile" / "scenes");
    }
    return folders;
}

voile::Result<fs::path> find_scene(const std::string& name, const std::vector<fs::path>& folders)
{
    std::error_code problem;
    // A folder may happen to have a scene's name: it does not hide the scene.
    if (fs::exists(name, problem) && !fs::is_directory(name, problem))
        return fs::path(name);
    const bool plain = !name.empty() && name.find('/') == std::string::npos;
    if (plain)
    {
        for (const fs::path& folder : folders)
        {
            for (const std::string& file : {name, name + ".json"})
            {
                if (fs::is_regular_file(folder / file, problem))
                    return folder / file;
            }
        }
    }
    if (fs::is_directory(name, problem))
        return voile::Error{voile::engine::path_text(name) + ": this is a folder, not a scene file"};
    const bool looks_like_path = !plain || fs::path(name).extension() == ".json";
    const std::string known = scene_list(name, scene_names(folders));
    if (!fs::exists(name, problem) && problem)
        return voile::Error{voile::engine::path_text(name) + ": " + problem.message()};
    if (looks_like_path)
        return voile::Error{voile::engine::path_text(name) + ": the file does not exist; " + known};
    return voile::Error{"scene " + in_quotes(name) + " is unknown; " + known};
}

} // namespace viewer
