// A small engine that knows nothing of Voile: it loads libvulkan at run time, makes a device with one or two queues,
// and has two frames in flight. It throws std::runtime_error where something cannot be made.
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
    // A second queue, for computing while the first one draws: of a family that only computes, else a second one of the
    // same family. A device that has neither, such as a software device, gives the same queue twice.
    bool async_compute = false;
    // The loader's; null: libvulkan is opened.
    PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;
};

// A queue of the engine. `compute` is the same as `main` without EngineOptions::async_compute.
enum class Lane
{
    main,
    compute,
};

// What a submission waits for, before these stages, and what it signals. Null: nothing.
struct Order
{
    VkSemaphore wait = VK_NULL_HANDLE;
    VkPipelineStageFlags stages = 0;
    VkSemaphore signal = VK_NULL_HANDLE;
};

struct Buffer
{
    VkBuffer handle = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    void* mapped = nullptr; // of memory that the host sees
};

class Engine
{
public:
    static constexpr uint32_t k_slots = 2; // frames in flight

    explicit Engine(const EngineOptions& options = {});
    ~Engine();
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

    // The command buffer of a frame, begun. Waits until the frame before the last of this queue has completed.
    VkCommandBuffer begin_frame(Lane lane = Lane::main);
    void submit_frame(Lane lane = Lane::main, const Order& order = {});
    [[nodiscard]] uint32_t slot(Lane lane = Lane::main) const; // of the frame that was begun last: 0 or 1
    [[nodiscard]] uint32_t queue_family(Lane lane) const;
    [[nodiscard]] bool has_two_queues() const; // that differ
    void wait_idle();
    void wait_idle_quietly() noexcept; // whatever the result

    // Floats of a buffer, once the GPU is idle. The buffer needs TRANSFER_SRC usage.
    std::vector<float> read(VkBuffer buffer, VkDeviceSize offset, size_t count);

    // They live until they are destroyed, semaphores as long as the engine.
    Buffer create_buffer(VkDeviceSize bytes, VkBufferUsageFlags usage, VkMemoryPropertyFlags properties);
    void destroy_buffer(const Buffer& buffer);
    VkSemaphore create_semaphore();

    // The function of the device, null where there is none.
    [[nodiscard]] PFN_vkVoidFunction find(const char* name) const;

    [[nodiscard]] VkInstance instance() const { return instance_; }
    [[nodiscard]] VkPhysicalDevice physical_device() const { return physical_device_; }
    [[nodiscard]] VkDevice device() const { return device_; }
    [[nodiscard]] PFN_vkGetInstanceProcAddr get_instance_proc_addr() const { return get_; }

private:
    void create_instance();
    void choose_device(bool compute_only);
    [[nodiscard]] std::vector<VkQueueFamilyProperties> queue_families(VkPhysicalDevice device) const;
    void create_device(bool async_compute);
    void create_frames();

    struct Frame
    {
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer cmd = VK_NULL_HANDLE;
        VkFence fence = VK_NULL_HANDLE;
    };
    struct Queue
    {
        uint32_t family = 0;
        VkQueue handle = VK_NULL_HANDLE;
        std::array<Frame, k_slots> frames{};
        uint32_t slot = k_slots - 1;
    };
    Queue& queue(Lane lane) { return queues_[lane == Lane::compute ? queues_.size() - 1 : 0]; }

    PFN_vkGetInstanceProcAddr get_ = nullptr;
    PFN_vkGetDeviceProcAddr get_for_device_ = nullptr;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    std::vector<Queue> queues_; // one or two
    std::vector<VkSemaphore> semaphores_;
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
