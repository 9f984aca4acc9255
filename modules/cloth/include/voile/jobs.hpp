// Jobs: the host's job system, for what the module does on several threads of the processor.
#pragma once

#include <cstdint>

namespace voile
{

// Adding and cooking large meshes is shared out. Without a job system threads of the module's own do it, one per core,
// as long as the call takes; results do not depend on who does it, on how many threads or in what order, to the bit.
//
// `run` calls task(data, index) for every index below `count`, each once, on any threads and in any order, one after
// the other if it likes, and returns when all calls have returned. A task takes up what is left to do and may wait for
// other tasks that have begun, never for one that has not. It neither throws nor calls `run`. The calling thread may
// run tasks itself. `run` must not throw, and `user` is passed on as it is.
struct Jobs
{
    using Task = void (*)(void* data, uint32_t index);

    void (*run)(void* user, uint32_t count, Task task, void* data) = nullptr; // null: the module's own threads
    void* user = nullptr;
    uint32_t workers = 0; // tasks that can run at the same time, at most what `count` becomes; 0: the number of cores
};

} // namespace voile
