// Work on large meshes on several threads: by the host's job system, or by threads that live as long as the call.
#pragma once

#include "voile/jobs.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>

namespace voile
{

// While one lives, these jobs do the parallel work that its thread starts. The innermost one counts.
class JobScope
{
public:
    explicit JobScope(const Jobs& jobs);
    ~JobScope();
    JobScope(const JobScope&) = delete;
    JobScope& operator=(const JobScope&) = delete;

private:
    Jobs before_;
};

// `wanted` threads, or as many as there are workers or cores if that is 0; at least 1, and no more than there are
// `parts` of work.
uint32_t thread_count(uint32_t wanted, size_t parts);

// Calls work() on up to `threads` threads and returns when all calls have returned. There may be fewer
// threads, and jobs may run one after the other, so work() must take the work that is left and not depend on a second
// call. The first exception of a call is rethrown once all have returned.
void run_together(uint32_t threads, const std::function<void()>& work);

// Calls body(first, last) for consecutive pieces of [0, count) in any order, on up to `threads` threads (0: all). Only
// `piece`, their size, decides where pieces begin, so results need not depend on the number of threads.
void parallel_for(size_t count, size_t piece, const std::function<void(size_t, size_t)>& body, uint32_t threads = 0);

// The size of a piece that gives each thread one, of at least `least`. For pieces that go through all items in their
// order and process those that belong to them, so that results do not depend on where pieces begin.
size_t piece_per_thread(size_t count, size_t least);

} // namespace voile
