// Jobs: the host's job system, for the module's work on several CPU threads.
#pragma once

#include <cstdint>

namespace voile
{

// Adding and cooking large meshes uses several threads, and so does Solver::create, which compiles kernels. Without a
// job system the module starts its own, one per core, for the duration of the call. Results are bit-identical for any
// job system, number of threads and order.
//
// `run` calls task(data, index) once for every index below `count` and returns when all calls have returned. It may use
// any threads and any order, even one call after the other on the calling thread. A task may wait for tasks that have
// begun, never for one that has not. Tasks neither throw nor call `run`. `run` must not throw. It gets `user`
// unchanged.
struct Jobs
{
    using Task = void (*)(void* data, uint32_t index);

    void (*run)(void* user, uint32_t count, Task task, void* data) = nullptr; // null: the module's own threads
    void* user = nullptr;

    // The most tasks that can run at the same time: the largest `count`. 0: the number of cores. 1: `run` is not
    // called.
    uint32_t workers = 0;
};

} // namespace voile
