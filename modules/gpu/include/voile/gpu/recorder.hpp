// Recorder: where compute passes are recorded. The helper that dispatches owns the barrier. A dry recorder, which has
// no command buffer, counts the dispatches of the same code.
#pragma once

#include "voile/gpu/kernel.hpp"
#include "voile/gpu/timestamps.hpp"

#include <array>

namespace voile::gpu
{

class CommandList;

// A scope that RenderDoc and validation show as `name`, and that is timed when `timestamps` is given.
class VOILE_GPU_API LabelScope
{
public:
    LabelScope(const Context& context, VkCommandBuffer cmd, const char* name, Timestamps* timestamps = nullptr);
    ~LabelScope();
    LabelScope(const LabelScope&) = delete;
    LabelScope& operator=(const LabelScope&) = delete;

private:
    const Context& context_;
    VkCommandBuffer cmd_;
    Timestamps* timestamps_;
    uint32_t pass_ = 0;
};

// Whether a barrier follows a dispatch. Use `unordered` if the next dispatch accesses none of this one's data. The
// barrier then follows the next ordered dispatch.
enum class Ordering
{
    ordered,
    unordered,
};

// Records what a dispatch needs beyond the one before: the same kernel, set or push constants are bound once. Call
// forget_bindings after other code has bound compute state in the command buffer.
class VOILE_GPU_API Recorder
{
public:
    // Called after each dispatch with the current command buffer. Returns the command buffer to continue in. Tests use
    // it to record one command buffer per dispatch: validation then sees hazards that it misses within one command
    // buffer.
    using Split = VkCommandBuffer (*)(void* user, VkCommandBuffer cmd);

    Recorder(const Context& context, VkCommandBuffer cmd, Timestamps* timestamps = nullptr)
        : context_(context), cmd_(cmd), timestamps_(timestamps)
    {
    }

    // A dry recorder: it counts dispatches and records nothing.
    explicit Recorder(const Context& context) : context_(context), dry_(true) {}

    void split_with(Split split, void* user)
    {
        split_ = split;
        split_user_ = user;
    }

    // Label, optional timestamps, pipeline, set, push constants, and enough workgroups of `group_size` for
    // `threads`; then a barrier from compute writes to compute reads and writes, unless `ordering` says otherwise.
    // Nothing is recorded for 0 threads. `push` must be exactly the kernel's push-constant block.
    void dispatch(const Kernel& kernel, VkDescriptorSet set, uint32_t threads, uint32_t group_size,
                  std::span<const std::byte> push, Ordering ordering = Ordering::ordered);

    template <typename Push>
    void dispatch(const Kernel& kernel, VkDescriptorSet set, uint32_t threads, uint32_t group_size, const Push& push,
                  Ordering ordering = Ordering::ordered)
    {
        dispatch(kernel, set, threads, group_size, std::as_bytes(std::span(&push, 1)), ordering);
    }

    // Like dispatch, with `columns` times `rows` workgroups.
    void dispatch_grid(const Kernel& kernel, VkDescriptorSet set, uint32_t columns, uint32_t rows,
                       std::span<const std::byte> push, Ordering ordering = Ordering::ordered);

    template <typename Push>
    void dispatch_grid(const Kernel& kernel, VkDescriptorSet set, uint32_t columns, uint32_t rows, const Push& push,
                       Ordering ordering = Ordering::ordered)
    {
        dispatch_grid(kernel, set, columns, rows, std::as_bytes(std::span(&push, 1)), ordering);
    }

    // Like dispatch, with the workgroup counts that `sizes` holds at `offset` (bytes), three words. An earlier dispatch
    // may have written them, if a barrier has made them visible to indirect commands.
    void dispatch_indirect(const Kernel& kernel, VkDescriptorSet set, VkBuffer sizes, VkDeviceSize offset,
                           std::span<const std::byte> push);

    template <typename Push>
    void dispatch_indirect(const Kernel& kernel, VkDescriptorSet set, VkBuffer sizes, VkDeviceSize offset,
                           const Push& push)
    {
        dispatch_indirect(kernel, set, sizes, offset, std::as_bytes(std::span(&push, 1)));
    }

    // From here on all calls go into the list instead of the command buffer; null: into the command buffer again. Not
    // with a split or with timestamps, which lists do not have.
    void keep_in(CommandList* list) { list_ = list; }

    // A secondary command buffer, with so many dispatches. Nothing is bound after it.
    void execute(VkCommandBuffer secondary, uint32_t dispatches);

    // The next dispatch binds everything.
    void forget_bindings() { bound_ = {}; }

    // Copies of the host's bytes, a multiple of 4, into a buffer. It may have any size: each command takes 64 KiB.
    void update(VkBuffer buffer, VkDeviceSize offset, std::span<const std::byte> bytes);
    // Sets all words of a buffer.
    void fill(VkBuffer buffer, uint32_t word);
    void copy(VkBuffer source, VkBuffer destination, const VkBufferCopy& region);

    // A global memory barrier between two scopes.
    void barrier(VkPipelineStageFlags2KHR source_stage, VkAccessFlags2KHR source_access,
                 VkPipelineStageFlags2KHR destination_stage, VkAccessFlags2KHR destination_access);

    // A label around the dispatches until end_group: "name number/count". Groups may be nested. Not timed. None if
    // command buffers are split: a label ends in the command buffer in which it begins.
    void begin_group(const char* name, uint32_t number, uint32_t count);
    void end_group();

    [[nodiscard]] bool is_dry() const { return dry_; }
    [[nodiscard]] VkCommandBuffer cmd() const { return cmd_; } // null if dry
    [[nodiscard]] Timestamps* timestamps() const { return timestamps_; }
    [[nodiscard]] const Context& context() const { return context_; }
    [[nodiscard]] bool is_split() const { return split_ != nullptr; }
    // Recorded or executed, or if dry, counted; not those that are in a list alone.
    [[nodiscard]] uint32_t dispatches() const { return dispatches_; }
    // Recorded into the command buffer, without labels and timestamps.
    [[nodiscard]] uint32_t commands() const { return commands_; }

private:
    void bind(const Kernel& kernel, VkDescriptorSet set, std::span<const std::byte> push);
    // Inside the timed pass: waiting belongs to the pass's cost, and some devices only finish here.
    void compute_barrier();
    void finish_dispatch(); // counts it and splits the command buffer
    [[nodiscard]] bool groups() const { return !dry_ && split_ == nullptr && context_.begin_label != nullptr; }

    // Of the command buffer. Layouts of two kernels differ, so another kernel takes another set and push constants.
    struct Bound
    {
        VkPipeline pipeline = VK_NULL_HANDLE;
        VkDescriptorSet set = VK_NULL_HANDLE;
        std::array<std::byte, 128> push{}; // more are bound each time
    };

    const Context& context_;
    VkCommandBuffer cmd_ = VK_NULL_HANDLE;
    Timestamps* timestamps_ = nullptr;
    bool dry_ = false;
    Bound bound_{};
    Split split_ = nullptr;
    void* split_user_ = nullptr;
    CommandList* list_ = nullptr;
    uint32_t dispatches_ = 0;
    uint32_t commands_ = 0;
};

// A group of a recorder, as a scope.
class GroupScope
{
public:
    GroupScope(Recorder& recorder, const char* name, uint32_t number, uint32_t count) : recorder_(recorder)
    {
        recorder_.begin_group(name, number, count);
    }
    ~GroupScope() { recorder_.end_group(); }
    GroupScope(const GroupScope&) = delete;
    GroupScope& operator=(const GroupScope&) = delete;

private:
    Recorder& recorder_;
};

} // namespace voile::gpu
