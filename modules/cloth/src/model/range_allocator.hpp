// RangeAllocator: the used and the free entries of an array that grows, such as a buffer that several cloths share.
#pragma once

#include <cstdint>
#include <map>

namespace voile
{

class RangeAllocator
{
public:
    // The first entry of the lowest free range of `count` entries. Never fails: the array grows where no gap fits.
    // A count of 0 takes no entries.
    uint64_t allocate(uint64_t count);

    // Frees a range that allocate returned, with the same count.
    void release(uint64_t first, uint64_t count);

    // Entries that the array needs: one past the last used entry.
    [[nodiscard]] uint64_t end() const { return end_; }

    // Free entries below end().
    [[nodiscard]] uint64_t gaps() const { return gaps_; }

    // What end() would be with `count` entries more.
    [[nodiscard]] uint64_t end_with(uint64_t count) const;

private:
    // Where allocate puts `count` entries.
    [[nodiscard]] uint64_t find(uint64_t count) const;

    std::map<uint64_t, uint64_t> free_; // entries by first entry; ranges neither touch each other nor end_
    uint64_t end_ = 0;
    uint64_t gaps_ = 0;
};

// The capacity of an array of `capacity` entries that must hold `needed`: unchanged if they fit, else larger by at
// least half, so that n additions copy O(n) entries in all. Never above `most`, which must be at least `needed`.
uint64_t grown_capacity(uint64_t capacity, uint64_t needed, uint64_t most);

} // namespace voile
