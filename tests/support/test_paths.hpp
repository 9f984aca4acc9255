// Paths of the programs and files of a test, also in a pack of the tests on another machine (scripts/pack_tests.sh).
#pragma once

#include <cstdlib>
#include <filesystem>

namespace tests
{

// A program of the build, beside this one.
inline std::filesystem::path program(const char* name)
{
    return std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
}

// A file of the repository. In a pack VOILE_TEST_SOURCES is the folder of the files that tests read.
inline std::filesystem::path source(const char* path)
{
    const char* sources = std::getenv("VOILE_TEST_SOURCES");
    return std::filesystem::path(sources != nullptr ? sources : VOILE_SOURCE_DIR) / path;
}

} // namespace tests
