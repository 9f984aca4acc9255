// StepCommands: secondary command buffers with the passes of a step, which later steps with the same passes execute.
//
// The passes of each step are listed on the host and compared with those that a command buffer has. So nothing can
// change the passes of a step unnoticed. What may differ between steps with the same passes is in StepInput.
#pragma once

#include "solver/lifetime_check.hpp"

#include "voile/gpu/command_list.hpp"
#include "voile/gpu/recorder.hpp"
#include "voile/solver.hpp"

#include <vector>

namespace voile
{

class StepCommands
{
public:
    // `checks`: next_is_free finds command buffers that are still executed. Errors: a queue family without compute, a
    // number of steps out of range, out of memory.
    static Result<StepCommands> create(const gpu::Context& context, const CommandReuse& options, bool checks);
    StepCommands() = default;
    ~StepCommands();
    StepCommands(StepCommands&& other) noexcept;
    StepCommands& operator=(StepCommands&& other) noexcept;

    // Errors: the GPU executes the command buffer that the next step may use.
    [[nodiscard]] Result<void> next_is_free() const;
    // When buffers or descriptor sets are replaced.
    void forget();

    // Around the passes of a step. `end` executes the command buffer that has them, or else records them.
    void begin(gpu::Recorder& recorder);
    void end(gpu::Recorder& recorder);

    // Of the last `end`: whether it executed commands of an earlier step, and how many it recorded into a command
    // buffer of its own.
    [[nodiscard]] bool reused() const { return reused_; }
    [[nodiscard]] uint32_t commands() const { return commands_; }

private:
    struct Entry
    {
        VkCommandBuffer cmd = VK_NULL_HANDLE;
        gpu::CommandList list;
        bool recorded = false; // `cmd` has the list's commands
        LifetimeCheck check;   // of `cmd`
    };

    // False: out of memory.
    bool record(Entry& entry);

    gpu::Context context_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    std::vector<Entry> entries_;
    size_t next_ = 0;
    bool reused_ = false;
    uint32_t commands_ = 0;
};

} // namespace voile
