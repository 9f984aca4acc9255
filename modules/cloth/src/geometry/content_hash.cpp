// Hashing in lanes, which do not wait for each other's multiplications.
#include "geometry/content_hash.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace voile
{

namespace
{

constexpr size_t k_lanes = 4;

struct Lane
{
    uint64_t low;
    uint64_t high;

    // For a given state each word gives another low, and for a given word each low gives another one.
    void add(uint64_t word)
    {
        low = (low ^ word) * 0x9e3779b97f4a7c15u;
        low ^= low >> 32;
        high = std::rotl(high + word, 29) * 0xbf58476d1ce4e5b9u;
    }
};

} // namespace

ContentHash hash_bytes(std::span<const std::byte> bytes, const ContentHash& before)
{
    constexpr size_t k_stride = k_lanes * sizeof(uint64_t);
    std::array<Lane, k_lanes> lanes{};
    for (size_t i = 0; i < k_lanes; ++i)
        lanes[i] = {before.low + i, before.high + i};
    const auto add_stride = [&](const std::byte* from)
    {
        for (size_t i = 0; i < k_lanes; ++i)
        {
            uint64_t word = 0;
            std::memcpy(&word, from + i * sizeof(word), sizeof(word));
            lanes[i].add(word);
        }
    };
    size_t done = 0;
    for (; done + k_stride <= bytes.size(); done += k_stride)
        add_stride(bytes.data() + done);
    if (done < bytes.size())
    {
        std::array<std::byte, k_stride> rest{};
        std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(done), bytes.end(), rest.begin());
        add_stride(rest.data());
    }
    Lane all{before.low, before.high};
    all.add(bytes.size());
    for (const Lane& lane : lanes)
    {
        all.add(lane.low);
        all.high = std::rotl(all.high ^ lane.high, 31) * 0x94d049bb133111ebu;
    }
    return {all.low, all.high};
}

} // namespace voile
