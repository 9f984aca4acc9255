// RangeAllocator: first fit over a sorted map of the free ranges.
#include "model/range_allocator.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>

namespace voile
{

uint64_t RangeAllocator::find(uint64_t count) const
{
    const auto fits = [count](const auto& range) { return range.second >= count; };
    const auto range = std::find_if(free_.begin(), free_.end(), fits);
    return range == free_.end() ? end_ : range->first;
}

uint64_t RangeAllocator::end_with(uint64_t count) const
{
    return std::max(end_, find(count) + count);
}

uint64_t RangeAllocator::allocate(uint64_t count)
{
    const uint64_t first = find(count);
    if (count == 0)
        return first;
    if (first == end_)
    {
        end_ += count;
        return first;
    }
    const auto range = free_.find(first);
    const uint64_t left = range->second - count;
    free_.erase(range);
    if (left > 0)
        free_.emplace(first + count, left);
    gaps_ -= count;
    return first;
}

void RangeAllocator::release(uint64_t first, uint64_t count)
{
    if (count == 0)
        return;
    assert(first + count <= end_);
    gaps_ += count;
    auto next = free_.lower_bound(first);
    if (next != free_.end() && first + count == next->first)
    {
        count += next->second;
        next = free_.erase(next);
    }
    if (next != free_.begin())
    {
        const auto before = std::prev(next);
        assert(before->first + before->second <= first);
        if (before->first + before->second == first)
        {
            first = before->first;
            count += before->second;
            free_.erase(before);
        }
    }
    if (first + count == end_)
    {
        end_ = first;
        gaps_ -= count;
        return;
    }
    free_.emplace(first, count);
}

uint64_t grown_capacity(uint64_t capacity, uint64_t needed, uint64_t most)
{
    assert(needed <= most);
    return needed <= capacity ? capacity : std::min(most, std::max(needed, capacity + capacity / 2));
}

} // namespace voile
