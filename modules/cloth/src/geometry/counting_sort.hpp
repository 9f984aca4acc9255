// Sorting by vertices: in linear time, whatever the mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

namespace voile
{

// Offsets of consecutive lists: list i is offsets[i] .. offsets[i + 1]. `counts`: the length of each list, then a 0.
inline void counts_to_offsets(std::vector<uint32_t>& counts)
{
    std::exclusive_scan(counts.begin(), counts.end(), counts.begin(), 0u);
}

// Writes `from` to `to` by key(item), which is below `keys`. Items of one key keep their order.
template <typename T, typename Key>
void counting_sort(std::span<const T> from, std::span<T> to, size_t keys, const Key& key)
{
    std::vector<uint32_t> next(keys + 1);
    for (const T& item : from)
        ++next[key(item)];
    counts_to_offsets(next);
    for (const T& item : from)
        to[next[key(item)]++] = item;
}

// Sorts by first(item), then by second(item), which are below `keys`. Items with the same keys keep their order.
template <typename T, typename First, typename Second>
void sort_by_two_keys(std::vector<T>& items, size_t keys, const First& first, const Second& second)
{
    const auto scratch = std::make_unique_for_overwrite<T[]>(items.size());
    const std::span<T> between(scratch.get(), items.size());
    counting_sort<T>(items, between, keys, second);
    counting_sort<T>(between, items, keys, first);
}

} // namespace voile
