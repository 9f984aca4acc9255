// Outcome: what a run has written, for people, and the first file that it could not write.
#pragma once

#include "voile/result.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace viewer
{

struct Outcome
{
    std::vector<std::string> written;
    std::optional<voile::Error> failure;

    void add(const voile::Result<void>& result, std::string what);
};

// A path as `written` has it.
std::string written_name(const std::filesystem::path& path);

} // namespace viewer
