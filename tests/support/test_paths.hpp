// Where a test program finds what it works with, also in a pack of the tests on another machine
// (scripts/pack_tests.sh).
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

// A file of the repository. VOILE_TEST_SOURCES is where a pack keeps those that tests read.
inline std::filesystem::path source(const char* path)
{
    const char* sources = std::getenv("VOILE_TEST_SOURCES");
    return std::filesystem::path(sources != nullptr ? sources : VOILE_SOURCE_DIR) / path;
}

} // namespace tests
