// Other solvers on the drape scene: their times, and how these were taken.
#pragma once

#include <span>
#include <string>

namespace bench
{

constexpr size_t k_peer_sizes = 3;
constexpr int k_peer_sides[k_peer_sizes] = {128, 256, 512}; // vertices along each side of the sheet

struct Peer
{
    const char* name = nullptr;
    double frames[k_peer_sizes]{}; // ms per frame of 1/60 s; 0: it failed the scene's conditions
    bool self_collision = false;
};

std::span<const Peer> peers();

// What --peers prints: the table and the conditions of the measurement.
std::string peer_report();

} // namespace bench
