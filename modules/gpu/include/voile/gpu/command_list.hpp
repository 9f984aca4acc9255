// CommandList: the calls of a Recorder, kept on the host, so that they can be compared with those of the time before
// and recorded once.
#pragma once

#include "voile/gpu/kernel.hpp"

#include <span>
#include <vector>

namespace voile::gpu
{

class Recorder;

// Calls are compared by handles and values. A handle that was destroyed can come back as another object: clear the list
// when something that it names is destroyed.
class VOILE_GPU_API CommandList
{
public:
    // Calls that are added from here on are compared with those of the time before, and take their place.
    void begin();
    // Whether all calls since begin are those of the time before.
    [[nodiscard]] bool end();
    void clear();

    [[nodiscard]] uint32_t dispatches() const { return dispatches_; } // since begin

    // Makes the calls.
    void record(Recorder& recorder) const;

    // `push`, `bytes`: copied. Kernels and names of groups must outlive the list.
    void add_dispatch(const Kernel& kernel, VkDescriptorSet set, uint32_t columns, uint32_t rows,
                      std::span<const std::byte> push, bool ordered);
    void add_indirect(const Kernel& kernel, VkDescriptorSet set, VkBuffer sizes, VkDeviceSize offset,
                      std::span<const std::byte> push);
    void add_update(VkBuffer buffer, VkDeviceSize offset, std::span<const std::byte> bytes);
    void add_fill(VkBuffer buffer, uint32_t word);
    void add_copy(VkBuffer source, VkBuffer destination, const VkBufferCopy& region);
    void add_barrier(VkPipelineStageFlags2KHR source_stage, VkAccessFlags2KHR source_access,
                     VkPipelineStageFlags2KHR destination_stage, VkAccessFlags2KHR destination_access);
    void add_group(const char* name, uint32_t number, uint32_t count);
    void add_end_group();

private:
    enum class Kind : uint32_t;

    void add(Kind kind, std::initializer_list<uint64_t> numbers, std::span<const std::byte> bytes = {});
    // Whether the call at the list's present position is this one.
    [[nodiscard]] bool is_next(uint64_t header, std::initializer_list<uint64_t> numbers,
                               std::span<const std::byte> bytes) const;

    // Each call: a header, its numbers, its bytes, which end with zeros.
    std::vector<uint64_t> words_;
    size_t at_ = 0; // the next call
    bool same_ = false;
    uint32_t dispatches_ = 0;
};

} // namespace voile::gpu
