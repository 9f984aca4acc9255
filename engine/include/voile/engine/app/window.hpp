// Window: a GLFW window with its swapchain. Survives resizing and minimizing.
#pragma once

#include "voile/engine/app/input.hpp"
#include "voile/engine/gpu/device.hpp"
#include "voile/engine/gpu/image.hpp"

#include <optional>
#include <string>
#include <vector>

struct GLFWwindow;

namespace voile::engine
{

// Returns true if a display is available.
bool display_available();

// The instance extensions that windows need.
std::vector<const char*> window_instance_extensions();

class Window
{
public:
    Window(const std::string& title, VkExtent2D extent);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    // Creates surface and swapchain; `slots` frames are in flight.
    void attach(const Device& device, uint32_t slots);
    // Destroys surface and swapchain. The device must be idle and still alive.
    void detach();

    // Polls events and returns open(). While it is minimized it waits for events.
    bool poll();
    // False once the user has closed it, or close() was called.
    [[nodiscard]] bool open() const;
    void close();
    void set_title(const std::string& title);
    [[nodiscard]] bool minimized() const;
    [[nodiscard]] VkExtent2D framebuffer_extent() const;

    struct Target
    {
        VkImage image = VK_NULL_HANDLE;
        VkExtent2D extent{};
        VkSemaphore acquired = VK_NULL_HANDLE;
        VkSemaphore rendered = VK_NULL_HANDLE;
        uint32_t index = 0;
    };

    // Acquires the next image of the swapchain. Returns none if the swapchain must be recreated first; the caller skips
    // this frame.
    std::optional<Target> acquire(uint32_t slot);

    // Records a blit of `source` (TRANSFER_SRC_OPTIMAL) onto the target and its transition for presentation.
    void record_blit(VkCommandBuffer cmd, const Image& source, const Target& target) const;
    void present(const Target& target);

    // What the user has done since the last call.
    Input take_input();

private:
    void create_swapchain();
    void destroy_swapchain();

    GLFWwindow* window_ = nullptr;
    const Device* device_ = nullptr;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    VkExtent2D extent_{};
    std::vector<VkImage> images_;
    std::vector<VkSemaphore> acquired_; // one per slot
    std::vector<VkSemaphore> rendered_; // one per image: presentation holds it until that image is acquired again
    Input input_;
    bool stale_ = false;
};

} // namespace voile::engine
