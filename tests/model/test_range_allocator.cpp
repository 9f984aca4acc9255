// RangeAllocator and Slots: who owns which entries of shared arrays, and which ids are stale.
#include "model/range_allocator.hpp"
#include "model/slots.hpp"
#include "voile/ids.hpp"

#include <doctest/doctest.h>

#include <random>
#include <utility>
#include <vector>

TEST_CASE("ranges that are in use never overlap, and gaps are used again")
{
    std::mt19937 random(7);
    voile::RangeAllocator allocator;
    std::vector<std::pair<uint64_t, uint64_t>> used; // first, count
    std::vector<int> owners;                         // per entry: who uses it, or -1
    int next_owner = 0;
    uint64_t most_in_use = 0;
    uint64_t in_use = 0;
    for (int round = 0; round < 4000; ++round)
    {
        if (used.empty() || random() % 2 == 0)
        {
            const uint64_t count = random() % 20;
            const uint64_t end = allocator.end_with(count);
            const uint64_t first = allocator.allocate(count);
            REQUIRE(allocator.end() == end);
            owners.resize(std::max<size_t>(owners.size(), first + count), -1);
            for (uint64_t i = first; i < first + count; ++i)
            {
                REQUIRE(owners[i] == -1);
                owners[i] = next_owner;
            }
            ++next_owner;
            in_use += count;
            used.emplace_back(first, count);
        }
        else
        {
            std::swap(used[random() % used.size()], used.back());
            const auto [first, count] = used.back();
            used.pop_back();
            allocator.release(first, count);
            std::fill_n(owners.begin() + static_cast<std::ptrdiff_t>(first), count, -1);
            in_use -= count;
        }
        most_in_use = std::max(most_in_use, in_use);
        uint64_t last = owners.size();
        while (last > 0 && owners[last - 1] == -1)
            --last;
        REQUIRE(allocator.end() == last);
        REQUIRE(allocator.gaps() == last - in_use);
    }
    CHECK(owners.size() < 2 * most_in_use);
    for (const auto& [first, count] : used)
        allocator.release(first, count);
    CHECK(allocator.end() == 0);
    CHECK(allocator.gaps() == 0);
}

TEST_CASE("the lowest gap that fits is taken, and free neighbors become one range")
{
    voile::RangeAllocator allocator;
    for (uint64_t i = 0; i < 6; ++i)
        CHECK(allocator.allocate(10) == 10 * i);
    allocator.release(10, 10);
    allocator.release(30, 10);
    CHECK(allocator.end_with(15) == 75);
    allocator.release(20, 10); // joins both
    CHECK(allocator.end_with(15) == 60);
    CHECK(allocator.end_with(30) == 60);
    CHECK(allocator.end_with(31) == 91);
    CHECK(allocator.allocate(5) == 10);
    CHECK(allocator.allocate(25) == 15);
    CHECK(allocator.allocate(1) == 60);
}

TEST_CASE("capacities grow by half, and no further than they may")
{
    CHECK(voile::grown_capacity(100, 100, 1000) == 100);
    CHECK(voile::grown_capacity(100, 101, 1000) == 150);
    CHECK(voile::grown_capacity(100, 400, 1000) == 400);
    CHECK(voile::grown_capacity(800, 801, 1000) == 1000);
}

TEST_CASE("the id of a removed value is stale even after its slot is used again")
{
    voile::Slots<voile::ClothId, int> slots;
    const voile::ClothId first = slots.add(1);
    const voile::ClothId second = slots.add(2);
    CHECK(*slots.find(second) == 2);
    slots.remove(first);
    CHECK(slots.find(first) == nullptr);
    CHECK(slots.check("cloth", first).error().message == "cloth 0 was removed");
    const voile::ClothId third = slots.add(3);
    CHECK(third.index == first.index);
    CHECK(third != first);
    CHECK_FALSE(slots.has(first));
    CHECK(*slots.find(third) == 3);
    CHECK(slots.check("cloth", voile::ClothId{}).error().message == "cloth: the id is a default-constructed one");
    CHECK(slots.check("cloth", {7, 0}).error().message == "cloth 7 does not exist");
    CHECK(slots.check("cloth", {third.index, third.generation + 1}).error().message == "cloth 0 does not exist");
    CHECK(slots.check("cloth", third));
}
