// The engine of the sample: loader, device, frames, and a copy back from the GPU.
#include "engine.hpp"

#if defined(_WIN32)
#define NOMINMAX
#include <windows.h>
#else
#include <dlfcn.h>
#endif

#include <cstring>
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
    throw std::runtime_error("no memory that the host sees");
}

} // namespace

// Each function is looked up by its name where it is used.
#define FN(name) reinterpret_cast<PFN_##name>(find(#name))

PFN_vkVoidFunction Engine::find(const char* name) const
{
    if (device_ != VK_NULL_HANDLE)
        if (const PFN_vkVoidFunction found = get_for_device_(device_, name))
            return found;
    return get_(instance_, name);
}

Engine::Engine(const EngineOptions& options)
{
    get_ = options.get_instance_proc_addr != nullptr ? options.get_instance_proc_addr : open_loader();
    create_instance();
    choose_device(options.compute_only);
    create_device();
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
    check(FN(vkCreateInstance)(&info, nullptr, &instance_), "instance");
    get_for_device_ = FN(vkGetDeviceProcAddr);
}

void Engine::choose_device(bool compute_only)
{
    uint32_t count = 0;
    check(FN(vkEnumeratePhysicalDevices)(instance_, &count, nullptr), "physical devices");
    std::vector<VkPhysicalDevice> devices(count);
    check(FN(vkEnumeratePhysicalDevices)(instance_, &count, devices.data()), "physical devices");
    const VkQueueFlags wanted = compute_only ? VK_QUEUE_COMPUTE_BIT : VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT;
    for (const VkPhysicalDevice device : devices)
    {
        FN(vkGetPhysicalDeviceQueueFamilyProperties)(device, &count, nullptr);
        std::vector<VkQueueFamilyProperties> families(count);
        FN(vkGetPhysicalDeviceQueueFamilyProperties)(device, &count, families.data());
        for (uint32_t i = 0; i < count; ++i)
            if ((families[i].queueFlags & (VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT)) == wanted)
            {
                physical_device_ = device;
                queue_family_ = i;
                return;
            }
    }
    throw std::runtime_error(compute_only ? "no device has a queue that only computes"
                                          : "no device has a queue that computes and draws");
}

// Vulkan 1.3, of which the module needs one feature; see voile::requirements().
void Engine::create_device()
{
    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info{};
    queue_info.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue_info.queueFamilyIndex = queue_family_;
    queue_info.queueCount = 1;
    queue_info.pQueuePriorities = &priority;
    VkPhysicalDeviceVulkan13Features features{};
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    features.synchronization2 = VK_TRUE;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &features;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue_info;
    check(FN(vkCreateDevice)(physical_device_, &info, nullptr, &device_), "device");
    FN(vkGetDeviceQueue)(device_, queue_family_, 0, &queue_);
}

void Engine::create_frames()
{
    for (Frame& frame : frames_)
    {
        VkCommandPoolCreateInfo pool_info{};
        pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        pool_info.queueFamilyIndex = queue_family_;
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
    for (const Frame& frame : frames_)
    {
        FN(vkDestroyFence)(device_, frame.fence, nullptr);
        FN(vkDestroyCommandPool)(device_, frame.pool, nullptr);
    }
    FN(vkDestroyDevice)(device_, nullptr);
    device_ = VK_NULL_HANDLE;
    FN(vkDestroyInstance)(instance_, nullptr);
}

VkCommandBuffer Engine::begin_frame()
{
    slot_ = (slot_ + 1) % k_slots;
    const Frame& frame = frames_[slot_];
    check(FN(vkWaitForFences)(device_, 1, &frame.fence, VK_TRUE, UINT64_MAX), "fence");
    check(FN(vkResetFences)(device_, 1, &frame.fence), "fence");
    check(FN(vkResetCommandPool)(device_, frame.pool, 0), "command pool");
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(FN(vkBeginCommandBuffer)(frame.cmd, &info), "command buffer");
    return frame.cmd;
}

void Engine::submit_frame()
{
    const Frame& frame = frames_[slot_];
    check(FN(vkEndCommandBuffer)(frame.cmd), "command buffer");
    VkSubmitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    info.commandBufferCount = 1;
    info.pCommandBuffers = &frame.cmd;
    check(FN(vkQueueSubmit)(queue_, 1, &info, frame.fence), "submission");
}

void Engine::wait_idle()
{
    check(FN(vkDeviceWaitIdle)(device_), "device");
}

void Engine::wait_idle_quietly() noexcept
{
    FN(vkDeviceWaitIdle)(device_);
}

std::vector<float> Engine::read(VkBuffer buffer, VkDeviceSize offset, size_t count)
{
    std::vector<float> values(count);
    const VkDeviceSize bytes = count * sizeof(float);
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes;
    info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    VkBuffer copy = VK_NULL_HANDLE;
    check(FN(vkCreateBuffer)(device_, &info, nullptr, &copy), "buffer");
    VkMemoryRequirements needs{};
    FN(vkGetBufferMemoryRequirements)(device_, copy, &needs);
    VkPhysicalDeviceMemoryProperties properties{};
    FN(vkGetPhysicalDeviceMemoryProperties)(physical_device_, &properties);
    VkMemoryAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex = find_memory(
        properties, needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check(FN(vkAllocateMemory)(device_, &allocation, nullptr, &memory), "memory");
    check(FN(vkBindBufferMemory)(device_, copy, memory, 0), "memory");

    const VkCommandBuffer cmd = begin_frame();
    const VkBufferCopy region{offset, 0, bytes};
    FN(vkCmdCopyBuffer)(cmd, buffer, copy, 1, &region);
    submit_frame();
    wait_idle();
    void* mapped = nullptr;
    check(FN(vkMapMemory)(device_, memory, 0, bytes, 0, &mapped), "memory");
    std::memcpy(values.data(), mapped, bytes);
    FN(vkDestroyBuffer)(device_, copy, nullptr);
    FN(vkFreeMemory)(device_, memory, nullptr);
    return values;
}

} // namespace foreign
