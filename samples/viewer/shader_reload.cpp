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

ShaderReload::ShaderReload(voile::engine::Renderer& renderer, fs::path folder)
    : renderer_(renderer), folder_(std::move(folder))
{
    for (const std::string_view name : voile::engine::shader_names())
        if (!fs::exists(folder_ / name))
            throw voile::engine::StartupError("--shaders: " + path_in_quotes(folder_) + " has no " + std::string(name));
    update();
}

ShaderReload::FolderState ShaderReload::look() const
{
    FolderState state;
    std::error_code problem;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_, problem))
    {
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
    const auto names = voile::engine::shader_names();
    std::vector<fs::path> files;
    for (const std::string_view name : names)
        files.push_back(folder_ / name);
    auto compiled = compile_shaders(files);
    if (!compiled)
        return report(compiled.error().message);
    std::vector<std::string> errors;
    std::vector<voile::engine::ShaderCode> changed;
    for (size_t i = 0; i < names.size(); ++i)
    {
        CompiledShader& shader = compiled.value()[i];
        add_errors(shader.errors, errors);
        const std::string name(names[i]);
        if (shader.errors.empty() && shown_[name] != shader.spirv)
            changed.push_back({name, std::move(shader.spirv)});
    }
    // All or none: the stages of a pipeline belong together.
    if (errors.empty() && !changed.empty())
    {
        if (const auto replaced = renderer_.replace_shaders(changed); !replaced)
            errors.push_back(replaced.error().message);
        else
            for (voile::engine::ShaderCode& shader : changed)
                shown_[shader.name] = std::move(shader.spirv);
    }
    report(joined(errors));
}

void ShaderReload::report(const std::string& errors)
{
    if (errors != errors_ && !errors.empty())
        std::fprintf(stderr, "viewer: shaders: %s\n", errors.c_str());
    if (errors.empty() && !errors_.empty())
        note("the shaders are compiled again");
    errors_ = errors;
}

} // namespace viewer
