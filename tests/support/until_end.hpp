// What the process keeps for all of its tests. main() destroys it after the last one, the newest first: a static object
// would be destroyed after what layers of Vulkan keep in statics of theirs, and crash in them.
#pragma once

#include <memory>
#include <utility>
#include <vector>

namespace tests
{

class UntilEnd
{
public:
    // The one of the process.
    static UntilEnd& get()
    {
        static UntilEnd all;
        return all;
    }

    template <typename T, typename... Arguments>
    T& keep(Arguments&&... arguments)
    {
        const auto kept = std::make_shared<T>(std::forward<Arguments>(arguments)...);
        kept_.push_back(kept);
        return *kept;
    }

    void destroy()
    {
        while (!kept_.empty())
            kept_.pop_back();
    }

    UntilEnd(const UntilEnd&) = delete;
    UntilEnd& operator=(const UntilEnd&) = delete;

private:
    UntilEnd() = default;
    ~UntilEnd() { destroy(); }

    std::vector<std::shared_ptr<void>> kept_;
};

} // namespace tests
