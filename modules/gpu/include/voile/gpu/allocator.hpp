// Allocator: a device's memory for buffers and images, through a VulkanMemoryAllocator of its own. Its implementation
// is compiled inside this library and none of its names is visible outside, so that the host may have any version of
// it.
#pragma once

#include "voile/export.hpp"
#include "voile/handles.hpp"

#include "voile/gpu/vulkan.hpp"

#include <memory>

namespace voile::gpu
{

struct ImageMemory
{
    VkImage image = VK_NULL_HANDLE;
    void* allocation = nullptr;
};

class VOILE_GPU_API Allocator final : public BufferAllocator
{
public:
    // `device_addresses`: buffers can have VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT; the device must have the feature
    // bufferDeviceAddress on. Errors: out of memory.
    static Result<std::unique_ptr<Allocator>> create(const Handles& handles, bool device_addresses = false);
    ~Allocator(); // when all of its buffers and images are destroyed
    Allocator(const Allocator&) = delete;
    Allocator& operator=(const Allocator&) = delete;

    Result<BufferMemory> create_buffer(const BufferRequest& request) noexcept override;
    void destroy_buffer(const BufferMemory& memory) noexcept override;
    void flush(const BufferMemory& memory) noexcept override;
    void invalidate(const BufferMemory& memory) noexcept override;

    // In memory that is fast on the device.
    VkResult create_image(const VkImageCreateInfo& info, ImageMemory& image);
    void destroy_image(const ImageMemory& image);

private:
    struct Implementation;
    explicit Allocator(std::unique_ptr<Implementation> implementation);
    std::unique_ptr<Implementation> implementation_;
};

} // namespace voile::gpu
