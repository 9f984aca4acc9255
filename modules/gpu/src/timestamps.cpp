// Timestamps: two queries per pass, summed by name when they are read.
#include "voile/gpu/timestamps.hpp"

#include <algorithm>
#include <utility>

namespace voile::gpu
{

namespace
{

uint32_t timestamp_bits(const Context& context, uint32_t queue_family)
{
    const auto get = reinterpret_cast<PFN_vkGetPhysicalDeviceQueueFamilyProperties>(
        context.handles.get_instance_proc_addr(context.handles.instance, "vkGetPhysicalDeviceQueueFamilyProperties"));
    uint32_t count = 0;
    get(context.handles.physical_device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    get(context.handles.physical_device, &count, families.data());
    return queue_family < count ? families[queue_family].timestampValidBits : 0;
}

} // namespace

Timestamps::~Timestamps()
{
    release();
}

Timestamps::Timestamps(Timestamps&& other) noexcept
{
    *this = std::move(other);
}

Timestamps& Timestamps::operator=(Timestamps&& other) noexcept
{
    std::swap(context_, other.context_);
    std::swap(slots_, other.slots_);
    std::swap(ticks_, other.ticks_);
    std::swap(times_, other.times_);
    std::swap(current_, other.current_);
    std::swap(max_passes_, other.max_passes_);
    std::swap(dropped_, other.dropped_);
    std::swap(valid_bits_, other.valid_bits_);
    return *this;
}

void Timestamps::release()
{
    for (const Slot& slot : slots_)
        context_.fn.vkDestroyQueryPool(context_.device(), slot.pool, nullptr);
    slots_.clear();
}

Result<Timestamps> Timestamps::create(const Context& context, uint32_t queue_family, uint32_t slots,
                                      uint32_t max_passes)
{
    Timestamps result;
    result.context_ = context;
    result.max_passes_ = max_passes;
    result.valid_bits_ = timestamp_bits(context, queue_family);
    if (result.valid_bits_ == 0)
        return Error{"the device's queue family " + std::to_string(queue_family) + " has no timestamps"};

    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = result.queries();
    for (uint32_t i = 0; i < slots; ++i)
    {
        Slot slot;
        const VkResult status = context.fn.vkCreateQueryPool(context.device(), &info, nullptr, &slot.pool);
        if (status != VK_SUCCESS)
            return Error{"timestamp query pool cannot be made: " + to_string(status)};
        slot.names.reserve(max_passes);
        result.slots_.push_back(std::move(slot));
    }
    result.ticks_.resize(size_t{2} * max_passes);
    result.times_.reserve(64);
    return result;
}

// Once something was drawn, Mesa's llvmpipe takes the time of a query only when the next one waits, so after the
// dispatch in between.
bool Timestamps::is_late() const
{
    return context_.device_type == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

// One more for each pass where times are late.
uint32_t Timestamps::queries() const
{
    return (is_late() ? 3 : 2) * max_passes_;
}

void Timestamps::begin_frame(VkCommandBuffer cmd, uint32_t slot)
{
    current_ = slot;
    slots_[slot].names.clear();
    context_.fn.vkCmdResetQueryPool(cmd, slots_[slot].pool, 0, queries());
}

uint32_t Timestamps::begin(VkCommandBuffer cmd, const char* name)
{
    Slot& slot = slots_[current_];
    if (slot.names.size() == max_passes_)
    {
        ++dropped_;
        return max_passes_;
    }
    const auto pass = static_cast<uint32_t>(slot.names.size());
    slot.names.push_back(name);
    context_.fn.vkCmdWriteTimestamp2KHR(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT_KHR, slot.pool, 2 * pass);
    if (is_late())
        context_.fn.vkCmdWriteTimestamp2KHR(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT_KHR, slot.pool,
                                            2 * max_passes_ + pass);
    return pass;
}

void Timestamps::end(VkCommandBuffer cmd, uint32_t pass)
{
    if (pass < max_passes_)
        context_.fn.vkCmdWriteTimestamp2KHR(cmd, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT_KHR, slots_[current_].pool,
                                            2 * pass + 1);
}

std::span<const PassTime> Timestamps::read(uint32_t slot_index)
{
    const Slot& slot = slots_[slot_index];
    times_.clear();
    const auto count = static_cast<uint32_t>(slot.names.size());
    if (count == 0)
        return times_;
    const VkResult status = context_.fn.vkGetQueryPoolResults(context_.device(), slot.pool, 0, 2 * count,
                                                              size_t{2} * count * sizeof(uint64_t), ticks_.data(),
                                                              sizeof(uint64_t), VK_QUERY_RESULT_64_BIT);
    if (status != VK_SUCCESS)
        return times_;
    const uint64_t mask = valid_bits_ >= 64 ? ~uint64_t{0} : (uint64_t{1} << valid_bits_) - 1;
    const double milliseconds_per_tick = static_cast<double>(context_.limits.timestampPeriod) * 1e-6;
    for (uint32_t pass = 0; pass < count; ++pass)
    {
        const uint64_t ticks = (ticks_[2 * size_t{pass} + 1] - ticks_[2 * size_t{pass}]) & mask;
        const std::string_view name = slot.names[pass];
        auto entry =
            std::find_if(times_.begin(), times_.end(), [&](const PassTime& time) { return time.name == name; });
        if (entry == times_.end())
            entry = times_.insert(times_.end(), PassTime{name, 0});
        entry->milliseconds += static_cast<double>(ticks) * milliseconds_per_tick;
    }
    return times_;
}

} // namespace voile::gpu
