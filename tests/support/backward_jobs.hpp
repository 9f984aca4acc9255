// A host's job system of one thread that starts with the last task.
#pragma once

#include "voile/jobs.hpp"

namespace tests
{

// For Jobs::run. `user`: a uint32_t, to which it adds the number of tasks.
inline void run_backwards(void* user, uint32_t count, voile::Jobs::Task task, void* data)
{
    *static_cast<uint32_t*>(user) += count;
    for (uint32_t i = count; i-- > 0;)
        task(data, i);
}

} // namespace tests
