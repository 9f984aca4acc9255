// Window: GLFW and the swapchain.
#include "voile/engine/app/window.hpp"

#include "app/input_events.hpp"

#include <GLFW/glfw3.h>
#include <volk.h>

#include <algorithm>

namespace voile::engine
{

namespace
{

// GLFW is initialized on first use and never terminated: it has no reference count, and it may stay open at exit.
bool initialize_glfw()
{
    static const bool initialized = []
    {
        glfwSetErrorCallback([](int, const char*) {}); // errors show in the return values
        return glfwInit() == GLFW_TRUE;
    }();
    return initialized;
}

VkSurfaceFormatKHR choose_format(VkPhysicalDevice physical_device, VkSurfaceKHR surface)
{
    uint32_t count = 0;
    vkGetPhysicalDeviceSurfaceFormatsKHR(physical_device, surface, &count, nullptr);
    std::vector<VkSurfaceFormatKHR> formats(count);
    vkGetPhysicalDeviceSurfaceFormatsKHR(physical_device, surface, &count, formats.data());
    if (formats.empty())
        throw StartupError("the window's surface has no formats");
    for (const VkSurfaceFormatKHR& format : formats)
        if (format.format == VK_FORMAT_B8G8R8A8_SRGB || format.format == VK_FORMAT_R8G8B8A8_SRGB)
            return format;
    return formats[0];
}

} // namespace

bool display_available()
{
    return initialize_glfw() && glfwVulkanSupported() == GLFW_TRUE;
}

std::vector<const char*> window_instance_extensions()
{
    uint32_t count = 0;
    if (!initialize_glfw())
        throw StartupError("no display to open a window on; use --headless");
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    if (names == nullptr)
        throw StartupError("the windowing system has no Vulkan surfaces; use --headless");
    return {names, names + count};
}

Window::Window(const std::string& title, VkExtent2D extent)
{
    if (!initialize_glfw())
        throw StartupError("no display to open a window on; use --headless");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(static_cast<int>(extent.width), static_cast<int>(extent.height), title.c_str(), nullptr,
                               nullptr);
    if (window_ == nullptr)
        throw StartupError("no window could be opened; use --headless");
    collect_input(window_, input_);
}

Window::~Window()
{
    glfwDestroyWindow(window_);
}

void Window::attach(const Device& device, uint32_t slots)
{
    device_ = &device;
    const gpu::Context& context = device.context();
    check(glfwCreateWindowSurface(context.handles.instance, window_, nullptr, &surface_), "window surface");
    VkBool32 supported = VK_FALSE;
    check(vkGetPhysicalDeviceSurfaceSupportKHR(context.handles.physical_device, device.queue_family(), surface_,
                                               &supported),
          "window surface");
    if (supported != VK_TRUE)
        throw StartupError("device \"" + device.info().name + "\" cannot present to this window; use --headless");
    acquired_.resize(slots);
    VkSemaphoreCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    for (VkSemaphore& semaphore : acquired_)
        check(context.fn.vkCreateSemaphore(context.device(), &info, nullptr, &semaphore), "semaphore");
    create_swapchain();
}

void Window::detach()
{
    if (device_ == nullptr)
        return;
    const gpu::Context& context = device_->context();
    destroy_swapchain();
    for (const VkSemaphore semaphore : acquired_)
        context.fn.vkDestroySemaphore(context.device(), semaphore, nullptr);
    vkDestroySurfaceKHR(context.handles.instance, surface_, nullptr);
    device_ = nullptr;
}

bool Window::poll()
{
    constexpr double k_longest_wait = 0.1; // s
    if (minimized())
        glfwWaitEventsTimeout(k_longest_wait);
    else
        glfwPollEvents();
    return open();
}

bool Window::open() const
{
    return glfwWindowShouldClose(window_) == GLFW_FALSE;
}

void Window::close()
{
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void Window::set_title(const std::string& title)
{
    glfwSetWindowTitle(window_, title.c_str());
}

VkExtent2D Window::framebuffer_extent() const
{
    int width = 0;
    int height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

bool Window::minimized() const
{
    const VkExtent2D extent = framebuffer_extent(); // X11 keeps it, Windows makes it 0
    return glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE || extent.width == 0 || extent.height == 0;
}

void Window::create_swapchain()
{
    const gpu::Context& context = device_->context();
    VkSurfaceCapabilitiesKHR capabilities{};
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(context.handles.physical_device, surface_, &capabilities),
          "window surface");
    const VkExtent2D wanted = framebuffer_extent();
    extent_ = {std::clamp(wanted.width, capabilities.minImageExtent.width, capabilities.maxImageExtent.width),
               std::clamp(wanted.height, capabilities.minImageExtent.height, capabilities.maxImageExtent.height)};
    const VkSurfaceFormatKHR format = choose_format(context.handles.physical_device, surface_);
    const uint32_t most = capabilities.maxImageCount == 0 ? UINT32_MAX : capabilities.maxImageCount;

    VkSwapchainCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
    info.surface = surface_;
    info.minImageCount = std::min(capabilities.minImageCount + 1, most);
    info.imageFormat = format.format;
    info.imageColorSpace = format.colorSpace;
    info.imageExtent = extent_;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.preTransform = capabilities.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR; // every device has it
    info.clipped = VK_TRUE;
    check(context.fn.vkCreateSwapchainKHR(context.device(), &info, nullptr, &swapchain_), "swapchain");

    uint32_t count = 0;
    check(context.fn.vkGetSwapchainImagesKHR(context.device(), swapchain_, &count, nullptr), "swapchain images");
    images_.resize(count);
    check(context.fn.vkGetSwapchainImagesKHR(context.device(), swapchain_, &count, images_.data()), "swapchain images");
    rendered_.resize(count);
    VkSemaphoreCreateInfo semaphore_info{};
    semaphore_info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    for (VkSemaphore& semaphore : rendered_)
        check(context.fn.vkCreateSemaphore(context.device(), &semaphore_info, nullptr, &semaphore), "semaphore");
    stale_ = false;
}

void Window::destroy_swapchain()
{
    const gpu::Context& context = device_->context();
    for (const VkSemaphore semaphore : rendered_)
        context.fn.vkDestroySemaphore(context.device(), semaphore, nullptr);
    rendered_.clear();
    context.fn.vkDestroySwapchainKHR(context.device(), swapchain_, nullptr);
    swapchain_ = VK_NULL_HANDLE;
}

std::optional<Window::Target> Window::acquire(uint32_t slot)
{
    const gpu::Context& context = device_->context();
    const VkExtent2D wanted = framebuffer_extent();
    if (stale_ || wanted.width != extent_.width || wanted.height != extent_.height)
    {
        device_->wait_idle(); // a resize, not a frame
        destroy_swapchain();
        create_swapchain();
    }
    Target target;
    const VkResult result = context.fn.vkAcquireNextImageKHR(context.device(), swapchain_, UINT64_MAX, acquired_[slot],
                                                             VK_NULL_HANDLE, &target.index);
    if (result == VK_ERROR_OUT_OF_DATE_KHR)
    {
        stale_ = true;
        return std::nullopt;
    }
    if (result == VK_SUBOPTIMAL_KHR)
        stale_ = true; // this image can still be presented
    else
        check(result, "swapchain image");
    target.image = images_[target.index];
    target.extent = extent_;
    target.acquired = acquired_[slot];
    target.rendered = rendered_[target.index];
    return target;
}

void Window::record_blit(VkCommandBuffer cmd, const Image& source, const Target& target) const
{
    const gpu::Context& context = device_->context();
    record_transition(context, cmd, target.image, VK_IMAGE_ASPECT_COLOR_BIT,
                      {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                       VK_PIPELINE_STAGE_2_BLIT_BIT_KHR | VK_PIPELINE_STAGE_2_COPY_BIT_KHR, 0,
                       VK_PIPELINE_STAGE_2_BLIT_BIT_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR});
    VkImageBlit region{};
    region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.dstSubresource = region.srcSubresource;
    region.srcOffsets[1] = {static_cast<int32_t>(source.extent().width), static_cast<int32_t>(source.extent().height),
                            1};
    region.dstOffsets[1] = {static_cast<int32_t>(target.extent.width), static_cast<int32_t>(target.extent.height), 1};
    context.fn.vkCmdBlitImage(cmd, source.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target.image,
                              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_LINEAR);
    record_transition(context, cmd, target.image, VK_IMAGE_ASPECT_COLOR_BIT,
                      {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
                       VK_PIPELINE_STAGE_2_BLIT_BIT_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR,
                       VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT_KHR, 0});
}

void Window::present(const Target& target)
{
    VkPresentInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &target.rendered;
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain_;
    info.pImageIndices = &target.index;
    const VkResult result = device_->context().fn.vkQueuePresentKHR(device_->queue(), &info);
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR)
        stale_ = true;
    else
        check(result, "presentation");
}

Input Window::take_input()
{
    Input result = input_;
    input_.begin_frame();
    return result;
}

} // namespace voile::engine
