#include "samples/viewer/shader_compiler.hpp"

#include "samples/viewer/child_process.hpp"
#include "samples/viewer/text.hpp"

#include "voile/engine/assets/atomic_file.hpp"
#include "voile/gpu/printable.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <string_view>

namespace viewer
{
namespace
{

namespace fs = std::filesystem;

struct CloseFile
{
    void operator()(std::FILE* file) const { (void)std::fclose(file); }
};

// One compiler that runs. Its words go to an unnamed file, its result to a temporary one.
struct Compilation
{
    std::string file; // the shader's
    std::unique_ptr<std::FILE, CloseFile> words{std::tmpfile()};
    voile::engine::TemporaryFile result{fs::temp_directory_path() / "voile_shader"};
    pid_t process = -1;

    explicit Compilation(const fs::path& shader) : file(shader.string()) {}
};

// An errno, 0 for none.
int start(Compilation& compilation, const fs::path& folder, const std::string& program)
{
    if (!compilation.words)
        return errno;
    const int words = ::fileno(compilation.words.get());
    (void)::fcntl(words, F_SETFD, FD_CLOEXEC);
    return start_program({program, "--quiet", "-V", "--target-env", "vulkan1.2", "-I" + folder.string(), "-o",
                          compilation.result.path().string(), compilation.file},
                         {.output = words, .errors = words}, compilation.process);
}

std::vector<std::string> lines_of(std::FILE* file)
{
    std::vector<std::string> lines;
    std::array<char, 1024> line{};
    std::rewind(file);
    while (std::fgets(line.data(), static_cast<int>(line.size()), file) != nullptr)
        lines.emplace_back(line.data());
    return lines;
}

// "ERROR: FILE:LINE: REASON" of glslang, without what follows from an error before it. Linking names no file.
std::vector<std::string> errors_of(const std::vector<std::string>& lines, const std::string& file)
{
    constexpr std::string_view k_start = "ERROR: ";
    std::vector<std::string> errors;
    for (const std::string& line : lines)
    {
        const bool links = line.find("Linking") != std::string::npos;
        const bool follows = links || line.find("compilation terminated") != std::string::npos ||
                             line.find("compilation errors.") != std::string::npos;
        if (!line.starts_with(k_start) || (follows && !errors.empty()))
            continue;
        std::string error = (links ? file + ": " : "") + line.substr(k_start.size());
        error.resize(error.find_last_not_of(" \r\n") + 1);
        errors.push_back(voile::gpu::printable(error, 400));
    }
    return errors;
}

std::vector<uint32_t> words_of(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    const auto bytes = static_cast<std::streamoff>(file.tellg());
    if (!file || bytes <= 0)
        return {};
    std::vector<uint32_t> words(static_cast<size_t>(bytes) / sizeof(uint32_t));
    file.seekg(0);
    file.read(reinterpret_cast<char*>(words.data()), static_cast<std::streamsize>(words.size() * sizeof(uint32_t)));
    return file ? words : std::vector<uint32_t>{};
}

CompiledShader finish(Compilation& compilation)
{
    const int status = wait_for_program(compilation.process);
    CompiledShader shader;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
        shader.spirv = words_of(compilation.result.path());
    if (shader.spirv.empty())
    {
        shader.errors = errors_of(lines_of(compilation.words.get()), compilation.file);
        if (shader.errors.empty())
            shader.errors.push_back(
                voile::gpu::printable(compilation.file) +
                (fs::exists(compilation.file) ? ": the compiler ended without a result" : ": there is no such file"));
    }
    return shader;
}

} // namespace

voile::Result<std::vector<CompiledShader>> compile_shaders(std::span<const fs::path> files, const fs::path& folder,
                                                           const std::vector<std::string>& programs)
{
    std::vector<std::unique_ptr<Compilation>> running;
    size_t program = 0;
    int problem = 0;
    for (const fs::path& file : files)
    {
        running.push_back(std::make_unique<Compilation>(file));
        while (program < programs.size())
        {
            problem = start(*running.back(), folder, programs[program]);
            if (!is_missing(problem, programs[program]))
                break;
            ++program;
        }
        if (problem != 0)
            break;
    }
    std::vector<CompiledShader> shaders;
    for (const auto& compilation : running)
        shaders.push_back(finish(*compilation));
    if (program == programs.size())
        return voile::Error{programs.front() + " is not installed (or not in PATH)"};
    if (problem != 0)
        return voile::Error{programs[program] + " cannot be started: " + std::strerror(problem)};
    return shaders;
}

} // namespace viewer
