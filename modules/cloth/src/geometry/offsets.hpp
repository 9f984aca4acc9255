// Offsets of consecutive lists.
#pragma once

#include <numeric>
#include <vector>

namespace voile
{

// List i is offsets[i] .. offsets[i + 1]. `counts`: the length of each list, then a 0.
template <typename Count>
void counts_to_offsets(std::vector<Count>& counts)
{
    std::exclusive_scan(counts.begin(), counts.end(), counts.begin(), Count{0});
}

} // namespace voile
