// The engine of the sample: loader, device, frames, and a copy back from the GPU.
#include "engine.hpp"

#if defined(_WIN32)
#define NOMINMAX
#include <windows.h>
#else
#include <dlfcn.h>
#endif

#include <algorithm>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>

namespace foreign
{

namespace
{

// The loader stays open as long as the program runs.
PFN_vkGetInstanceProcAddr open_loader()
{
#if defined(_WIN32)
    if (const HMODULE library = LoadLibraryA("vulkan-1.dll"))
        return reinterpret_cast<PFN_vkGetInstanceProcAddr>(
            reinterpret_cast<void*>(GetProcAddress(library, "vkGetInstanceProcAddr")));
#else
    for (const char* name : {"libvulkan.so.1", "libvulkan.1.dylib", "libMoltenVK.dylib"})
        if (void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL))
            return reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vkGetInstanceProcAddr"));
#endif
    throw std::runtime_error("there is no Vulkan loader on this system");
}

void check(VkResult result, const char* what)
{
    if (result != VK_SUCCESS)
        throw std::runtime_error(std::string(what) + ": VkResult " + std::to_string(static_cast<int>(result)));
}

uint32_t find_memory(const VkPhysicalDeviceMemoryProperties& memory, uint32_t types, VkMemoryPropertyFlags flags)
{
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
        if ((types & (1u << i)) != 0 && (memory.memoryTypes[i].propertyFlags & flags) == flags)
            return i;
    throw std::runtime_error("no memory of the wanted kind");
}

constexpr VkQueueFlags k_computes = VK_QUEUE_COMPUTE_BIT;

// A family that draws and computes as `wanted` says, and no more.
std::optional<uint32_t> find_family(const std::vector<VkQueueFamilyProperties>& families, VkQueueFlags wanted)
{
    for (uint32_t i = 0; i < families.size(); ++i)
        if ((families[i].queueFlags & (k_computes | VK_QUEUE_GRAPHICS_BIT)) == wanted)
            return i;
    return {};
}

} // namespace

// Each function is looked up by its name where it is used. A device knows none of the instance, and layers warn who
// asks it.
#define FN(name) reinterpret_cast<PFN_##name>(find(#name))
#define INSTANCE_FN(name) reinterpret_cast<PFN_##name>(get_(instance_, #name))

PFN_vkVoidFunction Engine::find(const char* name) const
{
    return get_for_device_(device_, name);
}

Engine::Engine(const EngineOptions& options)
{
    get_ = options.get_instance_proc_addr != nullptr ? options.get_instance_proc_addr : open_loader();
    create_instance();
    choose_device(options.compute_only);
    create_device(options.async_compute);
    create_frames();
}

void Engine::create_instance()
{
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    check(INSTANCE_FN(vkCreateInstance)(&info, nullptr, &instance_), "instance");
    get_for_device_ = INSTANCE_FN(vkGetDeviceProcAddr);
}

std::vector<VkQueueFamilyProperties> Engine::queue_families(VkPhysicalDevice device) const
{
    uint32_t count = 0;
    INSTANCE_FN(vkGetPhysicalDeviceQueueFamilyProperties)(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    INSTANCE_FN(vkGetPhysicalDeviceQueueFamilyProperties)(device, &count, families.data());
    return families;
}

void Engine::choose_device(bool compute_only)
{
    uint32_t count = 0;
    check(INSTANCE_FN(vkEnumeratePhysicalDevices)(instance_, &count, nullptr), "physical devices");
    std::vector<VkPhysicalDevice> devices(count);
    check(INSTANCE_FN(vkEnumeratePhysicalDevices)(instance_, &count, devices.data()), "physical devices");
    for (const VkPhysicalDevice device : devices)
        if (const auto family =
                find_family(queue_families(device), compute_only ? k_computes : k_computes | VK_QUEUE_GRAPHICS_BIT))
        {
            physical_device_ = device;
            queues_.push_back({.family = *family});
            return;
        }
    throw std::runtime_error(compute_only ? "no device has a queue that only computes"
                                          : "no device has a queue that computes and draws");
}

// Vulkan 1.3, of which the module needs one feature; see voile::requirements().
void Engine::create_device(bool async_compute)
{
    const std::vector<VkQueueFamilyProperties> families = queue_families(physical_device_);
    const uint32_t main_family = queues_[0].family;
    if (async_compute)
        queues_.push_back({.family = find_family(families, k_computes).value_or(main_family)});
    const bool same_family = queues_.back().family == main_family;
    const uint32_t wanted = same_family ? static_cast<uint32_t>(queues_.size()) : 1;
    const std::array<float, 2> priorities{1, 1};
    std::vector<VkDeviceQueueCreateInfo> queue_infos;
    for (size_t i = 0; i < (same_family ? 1 : queues_.size()); ++i)
    {
        VkDeviceQueueCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
        info.queueFamilyIndex = queues_[i].family;
        info.queueCount = std::min(wanted, families[queues_[i].family].queueCount);
        info.pQueuePriorities = priorities.data();
        queue_infos.push_back(info);
    }
    VkPhysicalDeviceVulkan13Features features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    features.synchronization2 = VK_TRUE;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &features;
    info.queueCreateInfoCount = static_cast<uint32_t>(queue_infos.size());
    info.pQueueCreateInfos = queue_infos.data();
    check(INSTANCE_FN(vkCreateDevice)(physical_device_, &info, nullptr, &device_), "device");
    for (size_t i = 0; i < queues_.size(); ++i)
        FN(vkGetDeviceQueue)
    (device_, queues_[i].family, i == 1 && same_family ? queue_infos[0].queueCount - 1 : 0, &queues_[i].handle);
}

void Engine::create_frames()
{
    for (Queue& queue : queues_)
        for (Frame& frame : queue.frames)
        {
            VkCommandPoolCreateInfo pool_info{};
            pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
            pool_info.queueFamilyIndex = queue.family;
            check(FN(vkCreateCommandPool)(device_, &pool_info, nullptr, &frame.pool), "command pool");
            VkCommandBufferAllocateInfo info{};
            info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
            info.commandPool = frame.pool;
            info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
            info.commandBufferCount = 1;
            check(FN(vkAllocateCommandBuffers)(device_, &info, &frame.cmd), "command buffer");
            VkFenceCreateInfo fence_info{};
            fence_info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
            fence_info.flags = VK_FENCE_CREATE_SIGNALED_BIT;
            check(FN(vkCreateFence)(device_, &fence_info, nullptr, &frame.fence), "fence");
        }
}

Engine::~Engine()
{
    wait_idle_quietly();
    for (const VkSemaphore semaphore : semaphores_)
        FN(vkDestroySemaphore)(device_, semaphore, nullptr);
    for (const Queue& queue : queues_)
        for (const Frame& frame : queue.frames)
        {
            FN(vkDestroyFence)(device_, frame.fence, nullptr);
            FN(vkDestroyCommandPool)(device_, frame.pool, nullptr);
        }
    FN(vkDestroyDevice)(device_, nullptr);
    device_ = VK_NULL_HANDLE;
    INSTANCE_FN(vkDestroyInstance)(instance_, nullptr);
}

uint32_t Engine::slot(Lane lane) const
{
    return lane == Lane::compute ? queues_.back().slot : queues_[0].slot;
}

uint32_t Engine::queue_family(Lane lane) const
{
    return lane == Lane::compute ? queues_.back().family : queues_[0].family;
}

bool Engine::has_two_queues() const
{
    return queues_.back().handle != queues_[0].handle;
}

VkCommandBuffer Engine::begin_frame(Lane lane)
{
    Queue& queue = this->queue(lane);
    queue.slot = (queue.slot + 1) % k_slots;
    const Frame& frame = queue.frames[queue.slot];
    check(FN(vkWaitForFences)(device_, 1, &frame.fence, VK_TRUE, UINT64_MAX), "fence");
    check(FN(vkResetFences)(device_, 1, &frame.fence), "fence");
    check(FN(vkResetCommandPool)(device_, frame.pool, 0), "command pool");
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(FN(vkBeginCommandBuffer)(frame.cmd, &info), "command buffer");
    return frame.cmd;
}

void Engine::submit_frame(Lane lane, const Order& order)
{
    const Queue& queue = this->queue(lane);
    const Frame& frame = queue.frames[queue.slot];
    check(FN(vkEndCommandBuffer)(frame.cmd), "command buffer");
    VkSubmitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    info.waitSemaphoreCount = order.wait != VK_NULL_HANDLE ? 1 : 0;
    info.pWaitSemaphores = &order.wait;
    info.pWaitDstStageMask = &order.stages;
    info.commandBufferCount = 1;
    info.pCommandBuffers = &frame.cmd;
    info.signalSemaphoreCount = order.signal != VK_NULL_HANDLE ? 1 : 0;
    info.pSignalSemaphores = &order.signal;
    check(FN(vkQueueSubmit)(queue.handle, 1, &info, frame.fence), "submission");
}

void Engine::wait_idle()
{
    check(FN(vkDeviceWaitIdle)(device_), "device");
}

void Engine::wait_idle_quietly() noexcept
{
    FN(vkDeviceWaitIdle)(device_);
}

VkSemaphore Engine::create_semaphore()
{
    VkSemaphoreCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    VkSemaphore semaphore = VK_NULL_HANDLE;
    check(FN(vkCreateSemaphore)(device_, &info, nullptr, &semaphore), "semaphore");
    semaphores_.push_back(semaphore);
    return semaphore;
}

Buffer Engine::create_buffer(VkDeviceSize bytes, VkBufferUsageFlags usage, VkMemoryPropertyFlags properties)
{
    Buffer buffer;
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes;
    info.usage = usage;
    check(FN(vkCreateBuffer)(device_, &info, nullptr, &buffer.handle), "buffer");
    VkMemoryRequirements needs{};
    FN(vkGetBufferMemoryRequirements)(device_, buffer.handle, &needs);
    VkPhysicalDeviceMemoryProperties memory{};
    INSTANCE_FN(vkGetPhysicalDeviceMemoryProperties)(physical_device_, &memory);
    VkMemoryAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = find_memory(memory, needs.memoryTypeBits, properties);
    check(FN(vkAllocateMemory)(device_, &allocation, nullptr, &buffer.memory), "memory");
    check(FN(vkBindBufferMemory)(device_, buffer.handle, buffer.memory, 0), "memory");
    if ((properties & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0)
        check(FN(vkMapMemory)(device_, buffer.memory, 0, bytes, 0, &buffer.mapped), "memory");
    return buffer;
}

void Engine::destroy_buffer(const Buffer& buffer)
{
    FN(vkDestroyBuffer)(device_, buffer.handle, nullptr);
    FN(vkFreeMemory)(device_, buffer.memory, nullptr);
}

std::vector<float> Engine::read(VkBuffer buffer, VkDeviceSize offset, size_t count)
{
    std::vector<float> values(count);
    const VkDeviceSize bytes = count * sizeof(float);
    const Buffer copy = create_buffer(bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    const VkCommandBuffer cmd = begin_frame();
    const VkBufferCopy region{offset, 0, bytes};
    FN(vkCmdCopyBuffer)(cmd, buffer, copy.handle, 1, &region);
    submit_frame();
    wait_idle();
    std::memcpy(values.data(), copy.mapped, bytes);
    destroy_buffer(copy);
    return values;
}

} // namespace foreign
