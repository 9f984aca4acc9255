#include "samples/viewer/shader_reload.hpp"

#include "samples/viewer/shader_compiler.hpp"
#include "samples/viewer/text.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace viewer
{
namespace
{

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds k_interval{250};
constexpr size_t k_most_errors = 5; // that are shown

// Each once, although several shaders may include the file that has it.
void add_errors(const std::vector<std::string>& errors, std::vector<std::string>& all)
{
    for (const std::string& error : errors)
        if (std::ranges::find(all, error) == all.end())
            all.push_back(error);
}

std::string joined(const std::vector<std::string>& lines)
{
    std::string text;
    for (size_t i = 0; i < std::min(lines.size(), k_most_errors); ++i)
        text += (i > 0 ? "\n" : "") + lines[i];
    if (lines.size() > k_most_errors)
        text += "\n" + std::to_string(lines.size() - k_most_errors) + " more errors";
    return text;
}

} // namespace

ShaderReload::ShaderReload(fs::path folder, std::vector<fs::path> files, Take taker)
    : take(std::move(taker)), folder_(std::move(folder)), files_(std::move(files))
{
    for (const fs::path& file : files_)
        if (!fs::exists(folder_ / file))
            throw voile::engine::StartupError("--shaders: " + path_in_quotes(folder_) + " has no " + file.string());
    update();
}

ShaderReload::FolderState ShaderReload::look() const
{
    FolderState state;
    std::error_code problem;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_, problem))
    {
        if (!entry.is_regular_file(problem))
            continue;
        FileState file{entry.last_write_time(problem), 0};
        file.size = entry.file_size(problem);
        if (!problem)
            state.emplace(entry.path(), file);
    }
    return state;
}

void ShaderReload::update()
{
    if (Clock::now() < next_)
        return;
    next_ = Clock::now() + k_interval;
    FolderState state = look();
    if (state == state_)
        return;
    state_ = std::move(state);
    compile();
}

void ShaderReload::compile()
{
    std::vector<fs::path> files;
    for (const fs::path& file : files_)
        files.push_back(folder_ / file);
    auto compiled = compile_shaders(files, folder_);
    if (!compiled)
        return report(compiled.error().message);
    const bool again = !taken_.empty();
    std::vector<std::string> errors;
    std::vector<voile::engine::ShaderCode> changed;
    for (size_t i = 0; i < files.size(); ++i)
    {
        CompiledShader& shader = compiled.value()[i];
        add_errors(shader.errors, errors);
        const std::string name = files[i].filename().string();
        if (shader.errors.empty() && taken_[name] != shader.spirv)
            changed.push_back({name, std::move(shader.spirv)});
    }
    // All or none: the stages of a pipeline belong together.
    if (errors.empty() && !changed.empty())
    {
        if (const auto done = take(changed); !done)
            errors.push_back(done.error().message);
        else
            for (voile::engine::ShaderCode& shader : changed)
                taken_[shader.name] = std::move(shader.spirv);
    }
    if (again && errors.empty() && (!changed.empty() || !errors_.empty()))
        note("the changed shaders are in use");
    report(joined(errors));
}

void ShaderReload::report(const std::string& errors)
{
    if (errors != errors_ && !errors.empty())
        std::fprintf(stderr, "viewer: shaders: %s\n", errors.c_str());
    errors_ = errors;
}

} // namespace viewer
