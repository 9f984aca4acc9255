// Recorder and LabelScope: labels, timestamps, dispatches and their barriers.
#include "voile/gpu/recorder.hpp"

#include "voile/gpu/command_list.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace voile::gpu
{

namespace
{

void begin_label(const Context& context, VkCommandBuffer cmd, const char* name)
{
    if (context.begin_label == nullptr)
        return;
    VkDebugUtilsLabelEXT label{};
    label.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT;
    label.pLabelName = name;
    context.begin_label(cmd, &label);
}

void end_label(const Context& context, VkCommandBuffer cmd)
{
    if (context.end_label != nullptr)
        context.end_label(cmd);
}

} // namespace

LabelScope::LabelScope(const Context& context, VkCommandBuffer cmd, const char* name, Timestamps* timestamps)
    : context_(context), cmd_(cmd), timestamps_(timestamps)
{
    begin_label(context_, cmd_, name);
    if (timestamps_ != nullptr)
        pass_ = timestamps_->begin(cmd_, name);
}

LabelScope::~LabelScope()
{
    if (timestamps_ != nullptr)
        timestamps_->end(cmd_, pass_);
    end_label(context_, cmd_);
}

namespace
{

// A mismatch would read past the caller's struct or leave constants undefined: a bug that no run survives.
void require_push(const Kernel& kernel, std::span<const std::byte> push)
{
    if (push.size() != kernel.push_bytes())
        std::abort();
}

} // namespace

void Recorder::bind(const Kernel& kernel, VkDescriptorSet set, std::span<const std::byte> push)
{
    const bool same_kernel = bound_.pipeline == kernel.pipeline();
    if (!same_kernel)
    {
        context_.fn.vkCmdBindPipeline(cmd_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline());
        ++commands_;
    }
    if (!same_kernel || bound_.set != set)
    {
        context_.fn.vkCmdBindDescriptorSets(cmd_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.layout(), 0, 1, &set, 0,
                                            nullptr);
        ++commands_;
    }
    bound_.pipeline = kernel.pipeline();
    bound_.set = set;
    const bool kept = push.size() <= bound_.push.size();
    if (push.empty() || (same_kernel && kept && std::memcmp(push.data(), bound_.push.data(), push.size()) == 0))
        return;
    context_.fn.vkCmdPushConstants(cmd_, kernel.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                                   static_cast<uint32_t>(push.size()), push.data());
    ++commands_;
    if (kept)
        std::memcpy(bound_.push.data(), push.data(), push.size());
}

void Recorder::compute_barrier()
{
    barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR,
            VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR,
            VK_ACCESS_2_SHADER_READ_BIT_KHR | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT_KHR);
}

void Recorder::finish_dispatch()
{
    ++dispatches_;
    if (split_ == nullptr || is_dry())
        return;
    cmd_ = split_(split_user_, cmd_);
    forget_bindings();
}

void Recorder::dispatch(const Kernel& kernel, VkDescriptorSet set, uint32_t threads, uint32_t group_size,
                        std::span<const std::byte> push, Ordering ordering)
{
    dispatch_grid(kernel, set, (threads + group_size - 1) / group_size, 1, push, ordering);
}

void Recorder::dispatch_grid(const Kernel& kernel, VkDescriptorSet set, uint32_t columns, uint32_t rows,
                             std::span<const std::byte> push, Ordering ordering)
{
    if (columns == 0 || rows == 0)
        return;
    require_push(kernel, push);
    if (list_ != nullptr)
    {
        list_->add_dispatch(kernel, set, columns, rows, push, ordering == Ordering::ordered);
        return;
    }
    if (!is_dry())
    {
        const LabelScope scope(context_, cmd_, kernel.name(), timestamps_);
        bind(kernel, set, push);
        context_.fn.vkCmdDispatch(cmd_, columns, rows, 1);
        ++commands_;
        if (ordering == Ordering::ordered)
            compute_barrier();
    }
    finish_dispatch();
}

void Recorder::dispatch_indirect(const Kernel& kernel, VkDescriptorSet set, VkBuffer sizes, VkDeviceSize offset,
                                 std::span<const std::byte> push)
{
    require_push(kernel, push);
    if (list_ != nullptr)
    {
        list_->add_indirect(kernel, set, sizes, offset, push);
        return;
    }
    if (!is_dry())
    {
        const LabelScope scope(context_, cmd_, kernel.name(), timestamps_);
        bind(kernel, set, push);
        context_.fn.vkCmdDispatchIndirect(cmd_, sizes, offset);
        ++commands_;
        compute_barrier();
    }
    finish_dispatch();
}

void Recorder::begin_group(const char* name, uint32_t number, uint32_t count)
{
    if (!groups())
        return;
    if (list_ != nullptr)
    {
        list_->add_group(name, number, count);
        return;
    }
    std::array<char, 64> text{};
    size_t used = 0;
    const auto add = [&](std::string_view part)
    {
        const size_t fits = std::min(part.size(), text.size() - 1 - used);
        std::copy_n(part.data(), fits, text.data() + used);
        used += fits;
    };
    const auto add_number = [&](uint32_t value)
    {
        std::array<char, 10> digits{};
        const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
        add({digits.data(), static_cast<size_t>(end - digits.data())});
    };
    add(name);
    add(" ");
    add_number(number);
    add("/");
    add_number(count);
    begin_label(context_, cmd_, text.data());
}

void Recorder::end_group()
{
    if (!groups())
        return;
    if (list_ != nullptr)
        list_->add_end_group();
    else
        end_label(context_, cmd_);
}

void Recorder::update(VkBuffer buffer, VkDeviceSize offset, std::span<const std::byte> bytes)
{
    constexpr size_t k_most = 65536; // of vkCmdUpdateBuffer
    if (list_ != nullptr)
    {
        list_->add_update(buffer, offset, bytes);
        return;
    }
    for (; !is_dry() && !bytes.empty(); bytes = bytes.subspan(std::min(bytes.size(), k_most)))
    {
        const size_t piece = std::min(bytes.size(), k_most);
        context_.fn.vkCmdUpdateBuffer(cmd_, buffer, offset, piece, bytes.data());
        ++commands_;
        offset += piece;
    }
}

void Recorder::fill(VkBuffer buffer, uint32_t word)
{
    if (list_ != nullptr)
        list_->add_fill(buffer, word);
    else if (!is_dry())
    {
        context_.fn.vkCmdFillBuffer(cmd_, buffer, 0, VK_WHOLE_SIZE, word);
        ++commands_;
    }
}

void Recorder::copy(VkBuffer source, VkBuffer destination, const VkBufferCopy& region)
{
    if (list_ != nullptr)
        list_->add_copy(source, destination, region);
    else if (!is_dry())
    {
        context_.fn.vkCmdCopyBuffer(cmd_, source, destination, 1, &region);
        ++commands_;
    }
}

void Recorder::barrier(VkPipelineStageFlags2KHR source_stage, VkAccessFlags2KHR source_access,
                       VkPipelineStageFlags2KHR destination_stage, VkAccessFlags2KHR destination_access)
{
    if (list_ != nullptr)
    {
        list_->add_barrier(source_stage, source_access, destination_stage, destination_access);
        return;
    }
    if (is_dry())
        return;
    const VkMemoryBarrier2KHR memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2_KHR,
                                     nullptr,
                                     source_stage,
                                     source_access,
                                     destination_stage,
                                     destination_access};
    VkDependencyInfoKHR dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO_KHR;
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &memory;
    context_.fn.vkCmdPipelineBarrier2KHR(cmd_, &dependency);
    ++commands_;
}

void Recorder::execute(VkCommandBuffer secondary, uint32_t dispatches)
{
    context_.fn.vkCmdExecuteCommands(cmd_, 1, &secondary);
    ++commands_;
    dispatches_ += dispatches;
    forget_bindings();
}

} // namespace voile::gpu
