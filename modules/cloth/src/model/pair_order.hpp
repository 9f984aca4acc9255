// The order of a cloth's vertices in the hierarchy of pairs.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace voile
{

// All indices of the positions, ordered by halving them along the longest side of their box, and each half again.
// Deterministic.
std::vector<uint32_t> make_pair_order(std::span<const glm::vec4> positions);

} // namespace voile
