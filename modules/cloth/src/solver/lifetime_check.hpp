// LifetimeCheck: finds an object that is destroyed while the GPU executes the commands that use it. An event is set
// before these commands and reset after them. Commands that are never submitted do not change the event, so there are
// no false reports. Commands that are submitted and have not begun are not detected.
#pragma once

#include "voile/gpu/context.hpp"

namespace voile
{

class LifetimeCheck
{
public:
    LifetimeCheck() = default; // checks nothing
    ~LifetimeCheck();          // ends the program with a line on stderr if the commands are being executed
    LifetimeCheck(LifetimeCheck&& other) noexcept;
    LifetimeCheck& operator=(LifetimeCheck&& other) noexcept;

    // `object`: the name of the object for the message; a literal.
    static Result<LifetimeCheck> create(const gpu::Context& context, const char* object);

    // Whether the GPU executes commands that use the object.
    [[nodiscard]] bool is_executing() const;

    // Around all commands that use the object.
    void begin(VkCommandBuffer cmd) const;
    void end(VkCommandBuffer cmd) const;

private:
    gpu::Context context_;
    VkEvent event_ = VK_NULL_HANDLE;
    const char* object_ = nullptr;
};

} // namespace voile
