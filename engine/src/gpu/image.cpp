// Image: creation, and layout transitions.
#include "voile/engine/gpu/image.hpp"

#include <utility>

namespace voile::engine
{

Image::Image(const Device& device, const ImageDescription& description)
    : device_(&device), format_(description.format), extent_(description.extent), aspect_(description.aspect)
{
    const gpu::Context& context = device.context();
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format_;
    info.extent = {extent_.width, extent_.height, 1};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = description.samples;
    info.usage = description.usage;
    const std::string what = std::string("image \"") + description.name + "\" of " + std::to_string(extent_.width) +
                             "x" + std::to_string(extent_.height);
    check(device.allocator().create_image(info, memory_), what.c_str());
    gpu::set_name(context, VK_OBJECT_TYPE_IMAGE, handle(), description.name);

    VkImageViewCreateInfo view_info{};
    view_info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view_info.image = handle();
    view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view_info.format = format_;
    view_info.subresourceRange = {aspect_, 0, 1, 0, 1};
    check(context.fn.vkCreateImageView(context.device(), &view_info, nullptr, &view_), what.c_str());
    gpu::set_name(context, VK_OBJECT_TYPE_IMAGE_VIEW, view_, description.name);
}

Image::~Image()
{
    if (device_ == nullptr)
        return;
    const gpu::Context& context = device_->context();
    context.fn.vkDestroyImageView(context.device(), view_, nullptr);
    device_->allocator().destroy_image(memory_);
}

Image::Image(Image&& other) noexcept
{
    *this = std::move(other);
}

Image& Image::operator=(Image&& other) noexcept
{
    std::swap(device_, other.device_);
    std::swap(memory_, other.memory_);
    std::swap(view_, other.view_);
    std::swap(format_, other.format_);
    std::swap(extent_, other.extent_);
    std::swap(aspect_, other.aspect_);
    return *this;
}

void record_transition(const gpu::Context& context, VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect,
                       const ImageTransition& transition)
{
    VkImageMemoryBarrier2KHR barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2_KHR;
    barrier.srcStageMask = transition.source_stage;
    barrier.srcAccessMask = transition.source_access;
    barrier.dstStageMask = transition.destination_stage;
    barrier.dstAccessMask = transition.destination_access;
    barrier.oldLayout = transition.from;
    barrier.newLayout = transition.to;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {aspect, 0, 1, 0, 1};
    VkDependencyInfoKHR dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO_KHR;
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    context.fn.vkCmdPipelineBarrier2KHR(cmd, &dependency);
}

} // namespace voile::engine
