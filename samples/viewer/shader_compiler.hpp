// Compiles GLSL by glslang's program, as the build does.
#pragma once

#include "voile/result.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace viewer
{

// The programs that are looked up in PATH, in this order.
inline const std::vector<std::string> k_glslang_programs{"glslangValidator", "glslang"};

struct CompiledShader
{
    std::vector<uint32_t> spirv;     // empty: it has errors
    std::vector<std::string> errors; // "FILE:LINE: REASON"
};

// Compiles several shaders at once, one process each. Includes are searched beside each file, then in `folder`. Error:
// no such program, or it cannot be started.
voile::Result<std::vector<CompiledShader>>
compile_shaders(std::span<const std::filesystem::path> files, const std::filesystem::path& folder,
                const std::vector<std::string>& programs = k_glslang_programs);

} // namespace viewer
