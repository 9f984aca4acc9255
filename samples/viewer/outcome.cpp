// Outcome.
#include "samples/viewer/outcome.hpp"

#include "voile/engine/assets/words.hpp"

#include <utility>

namespace viewer
{

void Outcome::add(const voile::Result<void>& result, std::string what)
{
    if (result)
        written.push_back(std::move(what));
    else if (!failure)
        failure = result.error();
}

std::string written_name(const std::filesystem::path& path)
{
    constexpr size_t k_longest = 4096; // bytes: scripts may read it, and no path is longer
    return voile::engine::path_text(path, k_longest);
}

} // namespace viewer
