// Timestamps: GPU times of named passes, collected per frame slot without a stall.
#pragma once

#include "voile/gpu/context.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace voile::gpu
{

// The time of one pass name, summed over all its dispatches in a frame.
struct PassTime
{
    std::string_view name; // the label given while recording; must point to a permanent string (a literal)
    double milliseconds = 0;
};

// One query pool per frame slot. Call begin_frame, any number of begin/end pairs, and read once the slot's submission
// has completed. Recording never allocates: a pass beyond the capacity is counted in dropped().
class VOILE_GPU_API Timestamps
{
public:
    Timestamps() = default;
    ~Timestamps();
    Timestamps(Timestamps&& other) noexcept;
    Timestamps& operator=(Timestamps&& other) noexcept;

    static Result<Timestamps> create(const Context& context, uint32_t queue_family, uint32_t slots,
                                     uint32_t max_passes);

    // Resets the slot's queries; the slot's previous submission must have completed.
    void begin_frame(VkCommandBuffer cmd, uint32_t slot);
    // `name` must be a literal. Passes may nest.
    [[nodiscard]] uint32_t begin(VkCommandBuffer cmd, const char* name);
    void end(VkCommandBuffer cmd, uint32_t pass);

    // Times by name in the order of first use, valid until the next call. The slot's submission must have completed.
    std::span<const PassTime> read(uint32_t slot);

    [[nodiscard]] uint32_t dropped() const { return dropped_; }

private:
    struct Slot
    {
        VkQueryPool pool = VK_NULL_HANDLE;
        std::vector<const char*> names; // one per recorded pass
    };

    void release();
    [[nodiscard]] bool is_late() const;
    [[nodiscard]] uint32_t queries() const;

    Context context_;
    std::vector<Slot> slots_;
    std::vector<uint64_t> ticks_;
    std::vector<PassTime> times_;
    uint32_t current_ = 0;
    uint32_t max_passes_ = 0;
    uint32_t dropped_ = 0;
    uint32_t valid_bits_ = 0;
};

} // namespace voile::gpu
