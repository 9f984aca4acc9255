#include "voile/gpu/command_list.hpp"

#include "voile/gpu/recorder.hpp"

#include <algorithm>
#include <cstring>

namespace voile::gpu
{

enum class CommandList::Kind : uint32_t
{
    dispatch,
    indirect,
    update,
    fill,
    copy,
    barrier,
    group,
    end_group,
};

namespace
{

// A header: the kind in the lowest byte, then the number of numbers; the number of bytes in the upper half.
constexpr uint32_t k_numbers_shift = 8;
constexpr uint32_t k_bytes_shift = 32;

size_t words_of(size_t bytes)
{
    return (bytes + sizeof(uint64_t) - 1) / sizeof(uint64_t);
}

template <typename Handle>
uint64_t number_of(Handle handle)
{
    return reinterpret_cast<uint64_t>(handle);
}

template <typename Handle>
Handle handle_of(uint64_t number)
{
    return reinterpret_cast<Handle>(number);
}

uint64_t pair_of(uint32_t low, uint32_t high)
{
    return uint64_t{high} << 32 | low;
}

uint32_t low_of(uint64_t pair)
{
    return static_cast<uint32_t>(pair);
}

uint32_t high_of(uint64_t pair)
{
    return static_cast<uint32_t>(pair >> 32);
}

} // namespace

void CommandList::begin()
{
    at_ = 0;
    same_ = !words_.empty();
    dispatches_ = 0;
}

bool CommandList::end()
{
    const bool same = same_ && at_ == words_.size();
    words_.resize(at_);
    return same;
}

void CommandList::clear()
{
    words_.clear();
}

bool CommandList::is_next(uint64_t header, std::initializer_list<uint64_t> numbers,
                          std::span<const std::byte> bytes) const
{
    // A call with the same header is as long.
    return at_ < words_.size() && words_[at_] == header &&
           std::equal(numbers.begin(), numbers.end(), words_.begin() + static_cast<std::ptrdiff_t>(at_ + 1)) &&
           (bytes.empty() || std::memcmp(bytes.data(), words_.data() + at_ + 1 + numbers.size(), bytes.size()) == 0);
}

void CommandList::add(Kind kind, std::initializer_list<uint64_t> numbers, std::span<const std::byte> bytes)
{
    const uint64_t header = static_cast<uint64_t>(kind) | uint64_t{numbers.size()} << k_numbers_shift |
                            uint64_t{bytes.size()} << k_bytes_shift;
    const size_t words = 1 + numbers.size() + words_of(bytes.size());
    same_ = same_ && is_next(header, numbers, bytes);
    if (!same_)
    {
        words_.resize(at_);
        words_.resize(at_ + words);
        words_[at_] = header;
        std::ranges::copy(numbers, words_.begin() + static_cast<std::ptrdiff_t>(at_ + 1));
        if (!bytes.empty())
            std::memcpy(words_.data() + at_ + 1 + numbers.size(), bytes.data(), bytes.size());
    }
    at_ += words;
}

void CommandList::add_dispatch(const Kernel& kernel, VkDescriptorSet set, uint32_t columns, uint32_t rows,
                               std::span<const std::byte> push, bool ordered)
{
    ++dispatches_;
    add(Kind::dispatch, {number_of(&kernel), number_of(set), pair_of(columns, rows), ordered ? 1u : 0u}, push);
}

void CommandList::add_indirect(const Kernel& kernel, VkDescriptorSet set, VkBuffer sizes, VkDeviceSize offset,
                               std::span<const std::byte> push)
{
    ++dispatches_;
    add(Kind::indirect, {number_of(&kernel), number_of(set), number_of(sizes), offset}, push);
}

void CommandList::add_update(VkBuffer buffer, VkDeviceSize offset, std::span<const std::byte> bytes)
{
    add(Kind::update, {number_of(buffer), offset}, bytes);
}

void CommandList::add_fill(VkBuffer buffer, uint32_t word)
{
    add(Kind::fill, {number_of(buffer), word});
}

void CommandList::add_copy(VkBuffer source, VkBuffer destination, const VkBufferCopy& region)
{
    add(Kind::copy, {number_of(source), number_of(destination), region.srcOffset, region.dstOffset, region.size});
}

void CommandList::add_barrier(VkPipelineStageFlags2KHR source_stage, VkAccessFlags2KHR source_access,
                              VkPipelineStageFlags2KHR destination_stage, VkAccessFlags2KHR destination_access)
{
    add(Kind::barrier, {source_stage, source_access, destination_stage, destination_access});
}

void CommandList::add_group(const char* name, uint32_t number, uint32_t count)
{
    add(Kind::group, {number_of(name), pair_of(number, count)});
}

void CommandList::add_end_group()
{
    add(Kind::end_group, {});
}

void CommandList::record(Recorder& recorder) const
{
    for (size_t at = 0; at < words_.size();)
    {
        const uint64_t header = words_[at];
        const size_t numbers = header >> k_numbers_shift & 0xff;
        const size_t size = header >> k_bytes_shift;
        const uint64_t* n = words_.data() + at + 1;
        const std::span<const std::byte> bytes = std::as_bytes(std::span(n + numbers, words_of(size))).first(size);
        switch (static_cast<Kind>(header & 0xff))
        {
        case Kind::dispatch:
            recorder.dispatch_grid(*handle_of<const Kernel*>(n[0]), handle_of<VkDescriptorSet>(n[1]), low_of(n[2]),
                                   high_of(n[2]), bytes, n[3] != 0 ? Ordering::ordered : Ordering::unordered);
            break;
        case Kind::indirect:
            recorder.dispatch_indirect(*handle_of<const Kernel*>(n[0]), handle_of<VkDescriptorSet>(n[1]),
                                       handle_of<VkBuffer>(n[2]), n[3], bytes);
            break;
        case Kind::update:
            recorder.update(handle_of<VkBuffer>(n[0]), n[1], bytes);
            break;
        case Kind::fill:
            recorder.fill(handle_of<VkBuffer>(n[0]), low_of(n[1]));
            break;
        case Kind::copy:
            recorder.copy(handle_of<VkBuffer>(n[0]), handle_of<VkBuffer>(n[1]), {n[2], n[3], n[4]});
            break;
        case Kind::barrier:
            recorder.barrier(n[0], n[1], n[2], n[3]);
            break;
        case Kind::group:
            recorder.begin_group(handle_of<const char*>(n[0]), low_of(n[1]), high_of(n[1]));
            break;
        case Kind::end_group:
            recorder.end_group();
            break;
        }
        at += 1 + numbers + words_of(size);
    }
}

} // namespace voile::gpu
