// What must not stay behind when a signal ends the program: unfinished files, processes that it started.
#pragma once

#include <functional>
#include <list>

namespace voile::engine
{

// Registers an action for as long as it lives.
class Cleanup
{
public:
    // The action runs in another thread, while the others still run. It may unlink and kill, and must not touch memory
    // that another thread writes.
    explicit Cleanup(std::function<void()> action);
    ~Cleanup();
    Cleanup(const Cleanup&) = delete;
    Cleanup& operator=(const Cleanup&) = delete;

private:
    std::list<std::function<void()>>::iterator entry_;
};

// Runs all actions, the latest first. From then on no Cleanup can be made or destroyed: the thread that tries waits for
// the program's end. Call it right before that.
void run_cleanups();

} // namespace voile::engine
