// Staging: collects values for the solver's buffers and copies them through one staging buffer.
#pragma once

#include "solver/device_state.hpp"

#include "voile/gpu/recorder.hpp"

#include <deque>
#include <span>
#include <vector>

namespace voile
{

class Staging
{
public:
    // Values for a buffer from entry `first` on. They must live until write().
    template <typename Array>
    void add(buffer::Name name, uint64_t first, const Array& values)
    {
        if (!values.empty())
            pieces_.push_back(
                {name, first * sizeof(*values.data()), std::as_bytes(std::span(values.data(), values.size()))});
    }

    // The same, with a copy of the values.
    template <typename T>
    void add_copy(buffer::Name name, uint64_t first, const std::vector<T>& values)
    {
        const auto bytes = std::as_bytes(std::span(values));
        kept_.emplace_back(bytes.begin(), bytes.end());
        if (!bytes.empty())
            pieces_.push_back({name, first * sizeof(T), kept_.back()});
    }

    // A buffer with all values in the order in which they were added. Errors: out of memory.
    [[nodiscard]] Result<gpu::Buffer> write(const gpu::Context& context) const;

    // Copies from that buffer.
    void record(gpu::Recorder& recorder, VkBuffer staged, const DeviceState& device) const;

private:
    struct Piece
    {
        buffer::Name name;
        uint64_t offset; // bytes, in the buffer
        std::span<const std::byte> bytes;
    };

    std::vector<Piece> pieces_;
    std::deque<std::vector<std::byte>> kept_;
};

} // namespace voile
