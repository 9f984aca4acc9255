// A hash of bytes, at the speed of memory. Not made to withstand who chooses the bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace voile
{

// Two independent hashes of 64 bits. Any change within 8 bytes at a multiple of 8 changes the first one.
struct ContentHash
{
    uint64_t low = 0x243f6a8885a308d3u;
    uint64_t high = 0x13198a2e03707344u;

    bool operator==(const ContentHash&) const = default;
};

// Of the bytes after those that gave `before`.
ContentHash hash_bytes(std::span<const std::byte> bytes, const ContentHash& before = {});

} // namespace voile
