// UploadBatch: copies host data into device buffers. The caller's command buffer records the copies.
#pragma once

#include "voile/gpu/recorder.hpp"

#include <span>
#include <vector>

namespace voile::engine
{

// Collects copies, records them all with one barrier to vertex input and compute reads, and owns the staging memory.
// The batch must live until that command buffer has completed.
class UploadBatch
{
public:
    explicit UploadBatch(const gpu::Context& context) : context_(context) {}

    // Returns a new device buffer that holds `bytes` once the batch has run. StartupError if it cannot be made.
    gpu::Buffer buffer(const char* name, std::span<const std::byte> bytes, VkBufferUsageFlags usage);

    template <typename T>
    gpu::Buffer buffer(const char* name, const std::vector<T>& values, VkBufferUsageFlags usage)
    {
        return buffer(name, std::as_bytes(std::span(values)), usage);
    }

    void record(VkCommandBuffer cmd);

    [[nodiscard]] const gpu::Context& context() const { return context_; }

private:
    struct Copy
    {
        VkBuffer destination;
        VkDeviceSize bytes;
        gpu::Buffer staging;
    };

    const gpu::Context& context_;
    std::vector<Copy> copies_;
};

} // namespace voile::engine
