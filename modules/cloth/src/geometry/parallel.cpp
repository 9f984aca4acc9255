// Work on all cores of the host.
#include "geometry/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace voile
{

namespace
{

thread_local Jobs t_jobs; // of the innermost JobScope

void run_on_threads(uint32_t threads, const std::function<void()>& work)
{
    std::vector<std::jthread> others;
    try
    {
        others.reserve(threads);
        while (others.size() + 1 < threads)
            others.emplace_back(work);
    }
    catch (const std::system_error&)
    {
        // The system gives no more threads; those that there are do the work.
    }
    work();
} // joins

} // namespace

JobScope::JobScope(const Jobs& jobs) : before_(std::exchange(t_jobs, jobs)) {}

JobScope::~JobScope()
{
    t_jobs = before_;
}

uint32_t thread_count(uint32_t wanted, size_t parts)
{
    const size_t all = t_jobs.run && t_jobs.workers > 0 ? t_jobs.workers : std::thread::hardware_concurrency();
    const size_t threads = wanted > 0 ? wanted : all; // 0 where that is not known
    return static_cast<uint32_t>(std::max<size_t>(std::min(threads, parts), 1));
}

void run_together(uint32_t threads, const std::function<void()>& work)
{
    std::mutex mutex;
    std::exception_ptr failure;
    std::function<void()> guarded = [&]
    {
        try
        {
            work();
        }
        catch (...)
        {
            const std::lock_guard lock(mutex);
            if (!failure)
                failure = std::current_exception();
        }
    };
    if (threads <= 1)
        guarded();
    else if (t_jobs.run)
        t_jobs.run(
            t_jobs.user, threads, [](void* data, uint32_t) { (*static_cast<std::function<void()>*>(data))(); },
            &guarded);
    else
        run_on_threads(threads, guarded);
    if (failure)
        std::rethrow_exception(failure);
}

void parallel_for(size_t count, size_t piece, const std::function<void(size_t, size_t)>& body, uint32_t threads)
{
    const size_t pieces = (count + piece - 1) / piece;
    std::atomic<size_t> next = 0;
    const auto work = [&]
    {
        for (size_t i = next++; i < pieces; i = next++)
            body(i * piece, std::min((i + 1) * piece, count));
    };
    run_together(thread_count(threads, pieces), work);
}

size_t piece_per_thread(size_t count, size_t least)
{
    const size_t threads = thread_count(0, count / least);
    return std::max<size_t>((count + threads - 1) / threads, 1);
}

} // namespace voile
