// Cleanup actions for signals that end the program: they remove unfinished files and stop child processes.
#pragma once

#include <functional>
#include <list>

namespace voile::engine
{

// Registers an action for its lifetime.
class Cleanup
{
public:
    // The action runs in another thread while the others still run. It may unlink and kill. It must not touch memory
    // that another thread writes.
    explicit Cleanup(std::function<void()> action);
    ~Cleanup();
    Cleanup(const Cleanup&) = delete;
    Cleanup& operator=(const Cleanup&) = delete;

private:
    std::list<std::function<void()>>::iterator entry_;
};

// Runs all actions, the latest first. Afterwards no Cleanup can be made or destroyed: a thread that tries blocks until
// the program ends. Call this right before the end.
void run_cleanups();

} // namespace voile::engine
