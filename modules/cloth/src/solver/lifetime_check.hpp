// LifetimeCheck: finds an object that is destroyed while the GPU executes the commands that use it. An event is set
// before these commands and reset after them. Commands that are recorded and never submitted leave it alone, so that it
// is never wrong; what is submitted and has not begun escapes it.
#pragma once

#include "voile/gpu/context.hpp"

namespace voile
{

class LifetimeCheck
{
public:
    LifetimeCheck() = default; // checks nothing
    ~LifetimeCheck();          // ends the program, with a line on stderr, where the commands are being executed
    LifetimeCheck(LifetimeCheck&& other) noexcept;
    LifetimeCheck& operator=(LifetimeCheck&& other) noexcept;

    // `object`: what is destroyed, for the line; a literal.
    static Result<LifetimeCheck> create(const gpu::Context& context, const char* object);

    // Around all commands that use the object.
    void begin(VkCommandBuffer cmd) const;
    void end(VkCommandBuffer cmd) const;

private:
    gpu::Context context_;
    VkEvent event_ = VK_NULL_HANDLE;
    const char* object_ = nullptr;
};

} // namespace voile
