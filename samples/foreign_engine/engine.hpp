// A small engine that knows nothing of Voile: it loads libvulkan at run time, makes a device for compute, and has two
// frames in flight. It throws std::runtime_error where something cannot be made.
#pragma once

#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <vector>

namespace foreign
{

struct EngineOptions
{
    // A queue that computes and does not draw.
    bool compute_only = false;
    // The loader's; null: libvulkan is opened.
    PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;
};

class Engine
{
public:
    static constexpr uint32_t k_slots = 2; // frames in flight

    explicit Engine(const EngineOptions& options = {});
    ~Engine();
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    // The command buffer of a frame, begun. Waits until the frame before the last has completed.
    VkCommandBuffer begin_frame();
    void submit_frame();
    [[nodiscard]] uint32_t slot() const { return slot_; } // of the frame that was begun last: 0 or 1
    void wait_idle();
    void wait_idle_quietly() noexcept; // whatever the result

    // Floats of a buffer, once the GPU is idle. The buffer needs TRANSFER_SRC usage.
    std::vector<float> read(VkBuffer buffer, VkDeviceSize offset, size_t count);

    // The function of the device, or of the instance, null where there is none.
    [[nodiscard]] PFN_vkVoidFunction find(const char* name) const;

    [[nodiscard]] VkInstance instance() const { return instance_; }
    [[nodiscard]] VkPhysicalDevice physical_device() const { return physical_device_; }
    [[nodiscard]] VkDevice device() const { return device_; }
    [[nodiscard]] PFN_vkGetInstanceProcAddr get_instance_proc_addr() const { return get_; }

private:
    void create_instance();
    void choose_device(bool compute_only);
    void create_device();
    void create_frames();

    struct Frame
    {
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer cmd = VK_NULL_HANDLE;
        VkFence fence = VK_NULL_HANDLE;
    };

    PFN_vkGetInstanceProcAddr get_ = nullptr;
    PFN_vkGetDeviceProcAddr get_for_device_ = nullptr;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    uint32_t queue_family_ = 0;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::array<Frame, k_slots> frames_{};
    uint32_t slot_ = k_slots - 1;
};

// Waits for the GPU at the end of its scope.
class IdleGuard
{
public:
    explicit IdleGuard(Engine& engine) : engine_(engine) {}
    ~IdleGuard() { engine_.wait_idle_quietly(); }
    IdleGuard(const IdleGuard&) = delete;
    IdleGuard& operator=(const IdleGuard&) = delete;

private:
    Engine& engine_;
};

} // namespace foreign
