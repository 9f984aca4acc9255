// The registered actions.
#include "voile/engine/assets/cleanup.hpp"

#include <mutex>
#include <utility>

namespace voile::engine
{

namespace
{

struct Registry
{
    std::mutex mutex;
    std::list<std::function<void()>> actions;
};

// Never destroyed: signals may arrive until the very end.
Registry& registry()
{
    static auto* const instance = new Registry;
    return *instance;
}

} // namespace

Cleanup::Cleanup(std::function<void()> action)
{
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    entry_ = all.actions.insert(all.actions.begin(), std::move(action));
}

Cleanup::~Cleanup()
{
    Registry& all = registry();
    const std::lock_guard lock(all.mutex);
    all.actions.erase(entry_);
}

void run_cleanups()
{
    Registry& all = registry();
    all.mutex.lock(); // never released
    for (const std::function<void()>& action : all.actions)
        action();
}

} // namespace voile::engine
