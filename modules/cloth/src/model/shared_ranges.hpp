// SharedRanges: where the arrays of shared objects lie in the solver's buffers. Instances of one mesh use one
// placement.
#pragma once

#include "model/range_allocator.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <memory>

namespace voile
{

// Owner: the object that holds the arrays; k_arrays: how many of them are placed.
template <typename Owner, size_t k_arrays>
class SharedRanges
{
public:
    using Counts = std::array<uint64_t, k_arrays>; // one entry per array

    struct Placement
    {
        std::shared_ptr<const Owner> owner;
        Counts first{};
        Counts counts{};
        uint32_t users = 0;
        bool uploaded = false;
    };

    // The placement of `owner`, with one more user.
    const Placement& acquire(const std::shared_ptr<const Owner>& owner, const Counts& counts)
    {
        Placement& placement = placements_[owner.get()];
        if (placement.users++ > 0)
            return placement;
        placement.owner = owner;
        placement.counts = counts;
        for (size_t i = 0; i < k_arrays; ++i)
            placement.first[i] = ranges_[i].allocate(counts[i]);
        return placement;
    }

    // One user less. The last one frees the ranges. Null: nothing.
    void release(const Owner* owner)
    {
        const auto found = placements_.find(owner);
        if (found == placements_.end() || --found->second.users > 0)
            return;
        for (size_t i = 0; i < k_arrays; ++i)
            ranges_[i].release(found->second.first[i], found->second.counts[i]);
        placements_.erase(found);
    }

    // Null: the object has none.
    [[nodiscard]] const Placement* find(const Owner* owner) const
    {
        const auto found = placements_.find(owner);
        return found != placements_.end() ? &found->second : nullptr;
    }

    // Entries that an array needs; and that it would need with `count` more for a new owner.
    [[nodiscard]] uint64_t end(size_t array) const { return ranges_[array].end(); }
    [[nodiscard]] uint64_t end_with(size_t array, uint64_t count) const { return ranges_[array].end_with(count); }

    template <typename Use>
    void for_each_new(const Use& use) const
    {
        for (const auto& [owner, placement] : placements_)
            if (!placement.uploaded)
                use(placement);
    }
    void mark_uploaded()
    {
        for (auto& [owner, placement] : placements_)
            placement.uploaded = true;
    }

private:
    std::array<RangeAllocator, k_arrays> ranges_;
    std::map<const Owner*, Placement> placements_;
};

} // namespace voile
