#include "solver/lifetime_check.hpp"

#include <cstdio>
#include <cstdlib>
#include <utility>

namespace voile
{

LifetimeCheck::~LifetimeCheck()
{
    if (event_ == VK_NULL_HANDLE)
        return;
    if (is_executing())
    {
        std::fprintf(stderr, "voile: a %s is destroyed while the GPU executes its commands\n", object_);
        std::abort();
    }
    context_.fn.vkDestroyEvent(context_.device(), event_, nullptr);
}

LifetimeCheck::LifetimeCheck(LifetimeCheck&& other) noexcept
{
    *this = std::move(other);
}

LifetimeCheck& LifetimeCheck::operator=(LifetimeCheck&& other) noexcept
{
    std::swap(context_, other.context_);
    std::swap(event_, other.event_);
    std::swap(object_, other.object_);
    return *this;
}

Result<LifetimeCheck> LifetimeCheck::create(const gpu::Context& context, const char* object)
{
    LifetimeCheck check;
    check.context_ = context;
    check.object_ = object;
    VkEventCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_EVENT_CREATE_INFO;
    const VkResult status = context.fn.vkCreateEvent(context.device(), &info, nullptr, &check.event_);
    if (status != VK_SUCCESS)
        return Error{std::string("event of the lifetime check: ") + gpu::to_string(status)};
    return check;
}

bool LifetimeCheck::is_executing() const
{
    return event_ != VK_NULL_HANDLE && context_.fn.vkGetEventStatus(context_.device(), event_) == VK_EVENT_SET;
}

void LifetimeCheck::begin(VkCommandBuffer cmd) const
{
    if (event_ != VK_NULL_HANDLE)
        context_.fn.vkCmdSetEvent(cmd, event_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
}

void LifetimeCheck::end(VkCommandBuffer cmd) const
{
    if (event_ != VK_NULL_HANDLE)
        context_.fn.vkCmdResetEvent(cmd, event_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
}

} // namespace voile
