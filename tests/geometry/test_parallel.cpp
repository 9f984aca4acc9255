// Dividing work among threads.
#include "geometry/parallel.hpp"
#include "support/backward_jobs.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

TEST_CASE("every piece of a range is processed once, by any number of threads")
{
    for (const size_t count : {0u, 1u, 99u, 100u, 101u, 12345u})
        for (const uint32_t threads : {0u, 1u, 2u, 7u})
        {
            CAPTURE(count);
            CAPTURE(threads);
            std::vector<int> done(count); // one writer per entry
            std::atomic<bool> aligned = true;
            voile::parallel_for(
                count, 100,
                [&](size_t first, size_t last)
                {
                    if (first % 100 != 0 || last <= first || last > first + 100)
                        aligned = false;
                    for (size_t i = first; i < last; ++i)
                        ++done[i];
                },
                threads);
            CHECK(aligned);
            CHECK(done == std::vector<int>(count, 1));
        }
}

TEST_CASE("there are no more threads than requested, nor than parts of the work")
{
    CHECK(voile::thread_count(5, 100) == 5);
    CHECK(voile::thread_count(5, 3) == 3);
    CHECK(voile::thread_count(5, 0) == 1);
    CHECK(voile::thread_count(0, 1000) >= 1);
    std::atomic<uint32_t> calls = 0;
    voile::run_together(3, [&] { ++calls; });
    CHECK(calls == 3);
}

TEST_CASE("an exception of any thread is rethrown after all have ended")
{
    std::atomic<uint32_t> calls = 0;
    const auto work = [&]
    {
        if (++calls == 2)
            throw std::runtime_error("second");
    };
    CHECK_THROWS_WITH(voile::run_together(4, work), "second");
    CHECK(calls == 4);
}

TEST_CASE("the host's jobs do the work, in any order, as long as the scope lasts")
{
    uint32_t tasks = 0;
    constexpr size_t k_count = 1000;
    std::vector<int> done(k_count);
    const auto body = [&](size_t first, size_t last)
    {
        for (size_t i = first; i < last; ++i)
            ++done[i];
    };
    {
        const voile::JobScope scope({.run = tests::run_backwards, .user = &tasks, .workers = 5});
        CHECK(voile::thread_count(0, 100) == 5);
        voile::parallel_for(k_count, 10, body);
        CHECK(tasks == 5);
        CHECK(done == std::vector<int>(k_count, 1));
        CHECK_THROWS_WITH(voile::run_together(3, [] { throw std::runtime_error("a task"); }), "a task");
        CHECK(tasks == 8);
        {
            const voile::JobScope inner{voile::Jobs{}};
            voile::parallel_for(k_count, 10, body, 2);
        }
        CHECK(tasks == 8);
    }
    voile::parallel_for(k_count, 10, body, 2);
    CHECK(tasks == 8);
    CHECK(done == std::vector<int>(k_count, 3));
}
