// Image: a VkImage with its view and memory, freed together.
#pragma once

#include "voile/engine/gpu/device.hpp"

namespace voile::engine
{

struct ImageDescription
{
    const char* name = "image";
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent2D extent{};
    VkImageUsageFlags usage = 0;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
};

class Image
{
public:
    Image() = default;
    Image(const Device& device, const ImageDescription& description); // StartupError if it cannot be made
    ~Image();
    Image(Image&& other) noexcept;
    Image& operator=(Image&& other) noexcept;

    [[nodiscard]] VkImage handle() const { return memory_.image; }
    [[nodiscard]] VkImageView view() const { return view_; }
    [[nodiscard]] VkFormat format() const { return format_; }
    [[nodiscard]] VkExtent2D extent() const { return extent_; }
    [[nodiscard]] VkImageAspectFlags aspect() const { return aspect_; }

private:
    const Device* device_ = nullptr;
    gpu::ImageMemory memory_;
    VkImageView view_ = VK_NULL_HANDLE;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    VkExtent2D extent_{};
    VkImageAspectFlags aspect_ = 0;
};

struct ImageTransition
{
    VkImageLayout from = VK_IMAGE_LAYOUT_UNDEFINED;
    VkImageLayout to = VK_IMAGE_LAYOUT_UNDEFINED;
    VkPipelineStageFlags2KHR source_stage = 0;
    VkAccessFlags2KHR source_access = 0;
    VkPipelineStageFlags2KHR destination_stage = 0;
    VkAccessFlags2KHR destination_access = 0;
};

void record_transition(const gpu::Context& context, VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect,
                       const ImageTransition& transition);

} // namespace voile::engine
