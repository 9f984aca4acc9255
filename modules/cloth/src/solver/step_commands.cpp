#include "solver/step_commands.hpp"

#include <utility>

namespace voile
{

namespace
{

constexpr uint32_t k_most_in_flight = 16;

Result<void> check_options(const gpu::Context& context, const CommandReuse& options)
{
    if (options.steps_in_flight < 1 || options.steps_in_flight > k_most_in_flight)
        return Error{"CommandReuse: steps_in_flight is " + std::to_string(options.steps_in_flight) + ", must be 1 to " +
                     std::to_string(k_most_in_flight)};
    const auto get = reinterpret_cast<PFN_vkGetPhysicalDeviceQueueFamilyProperties>(
        context.handles.get_instance_proc_addr(context.handles.instance, "vkGetPhysicalDeviceQueueFamilyProperties"));
    uint32_t count = 0;
    get(context.handles.physical_device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    get(context.handles.physical_device, &count, families.data());
    if (options.queue_family >= count)
        return Error{"CommandReuse: queue_family is " + std::to_string(options.queue_family) + ", the device has " +
                     std::to_string(count) + (count == 1 ? " family" : " families")};
    if ((families[options.queue_family].queueFlags & VK_QUEUE_COMPUTE_BIT) == 0)
        return Error{"CommandReuse: queue family " + std::to_string(options.queue_family) +
                     " does not support compute"};
    return {};
}

Error failed(const char* what, VkResult status)
{
    return Error{std::string("CommandReuse: ") + what + ": " + gpu::to_string(status)};
}

} // namespace

StepCommands::~StepCommands()
{
    if (pool_ != VK_NULL_HANDLE)
        context_.fn.vkDestroyCommandPool(context_.device(), pool_, nullptr);
}

StepCommands::StepCommands(StepCommands&& other) noexcept
{
    *this = std::move(other);
}

StepCommands& StepCommands::operator=(StepCommands&& other) noexcept
{
    std::swap(context_, other.context_);
    std::swap(pool_, other.pool_);
    std::swap(entries_, other.entries_);
    std::swap(next_, other.next_);
    std::swap(reused_, other.reused_);
    std::swap(commands_, other.commands_);
    return *this;
}

Result<StepCommands> StepCommands::create(const gpu::Context& context, const CommandReuse& options, bool checks)
{
    if (auto valid = check_options(context, options); !valid)
        return valid.error();
    StepCommands result;
    result.context_ = context;
    VkCommandPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = options.queue_family;
    if (const VkResult status = context.fn.vkCreateCommandPool(context.device(), &pool, nullptr, &result.pool_);
        status != VK_SUCCESS)
        return failed("command pool", status);
    gpu::set_name(context, VK_OBJECT_TYPE_COMMAND_POOL, result.pool_, "cloth steps");
    // An even number: even and odd steps write votes of their own (record_depenetration).
    result.entries_.resize((options.steps_in_flight + 1) / 2 * 2);
    for (Entry& entry : result.entries_)
    {
        VkCommandBufferAllocateInfo allocate{};
        allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        allocate.commandPool = result.pool_;
        allocate.level = VK_COMMAND_BUFFER_LEVEL_SECONDARY;
        allocate.commandBufferCount = 1;
        if (const VkResult status = context.fn.vkAllocateCommandBuffers(context.device(), &allocate, &entry.cmd);
            status != VK_SUCCESS)
            return failed("command buffer", status);
        gpu::set_name(context, VK_OBJECT_TYPE_COMMAND_BUFFER, entry.cmd, "cloth step");
        if (!checks)
            continue;
        auto check = LifetimeCheck::create(context, "voile::Solver");
        if (!check)
            return check.error();
        entry.check = std::move(check.value());
    }
    return result;
}

Result<void> StepCommands::next_is_free() const
{
    if (!entries_.empty() && entries_[next_].check.is_executing())
        return Error{"CommandReuse: steps_in_flight is too low: the GPU executes the step of " +
                     std::to_string(entries_.size()) + " calls before"};
    return {};
}

void StepCommands::forget()
{
    for (Entry& entry : entries_)
    {
        entry.list.clear();
        entry.recorded = false;
    }
}

void StepCommands::begin(gpu::Recorder& recorder)
{
    entries_[next_].list.begin();
    recorder.keep_in(&entries_[next_].list);
}

// A list that is found unchanged for the first time is recorded into the command buffer. So a step that changes each
// time is recorded once, as without reuse.
void StepCommands::end(gpu::Recorder& recorder)
{
    Entry& entry = entries_[next_];
    next_ = (next_ + 1) % entries_.size();
    recorder.keep_in(nullptr);
    const bool same = entry.list.end();
    reused_ = same && entry.recorded;
    commands_ = 0;
    entry.recorded = reused_ || (same && record(entry));
    if (!entry.recorded)
    {
        entry.list.record(recorder);
        return;
    }
    entry.check.begin(recorder.cmd());
    recorder.execute(entry.cmd, entry.list.dispatches());
    entry.check.end(recorder.cmd());
}

bool StepCommands::record(Entry& entry)
{
    VkCommandBufferInheritanceInfo inheritance{};
    inheritance.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_INHERITANCE_INFO;
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.pInheritanceInfo = &inheritance;
    if (context_.fn.vkBeginCommandBuffer(entry.cmd, &begin) != VK_SUCCESS)
        return false;
    gpu::Recorder recorder(context_, entry.cmd);
    entry.list.record(recorder);
    if (context_.fn.vkEndCommandBuffer(entry.cmd) != VK_SUCCESS)
        return false;
    commands_ = recorder.commands();
    return true;
}

} // namespace voile
