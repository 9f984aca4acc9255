// Device: the instance, the physical device, the logical device and the memory allocator, made once at start-up.
#pragma once

#include "voile/engine/gpu/validation.hpp"

#include "voile/gpu/allocator.hpp"
#include "voile/gpu/context.hpp"

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace voile::engine
{

// Thrown at start-up only; programs turn it into one line on standard error and exit code 1.
struct StartupError : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

struct DeviceOptions
{
    std::string device;      // index or part of a name, as `list_devices` prints them; empty: the best one
    bool validation = false; // validation and synchronization validation; StartupError if the layer is missing
    std::vector<const char*> instance_extensions; // required by windows (GLFW lists them); empty when headless
    bool swapchain = false;                       // VK_KHR_swapchain
    bool device_addresses = false;                // the feature bufferDeviceAddress; StartupError if it is missing
};

struct DeviceInfo
{
    std::string name;
    std::string driver; // driver name and version
    VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    uint32_t api_version = 0;
    std::string unusable; // why this device cannot run the engine; empty when it can
};

// All devices in the order of their index. StartupError if there is no Vulkan loader or instance.
std::vector<DeviceInfo> list_devices();

// Needs Vulkan 1.2 with VK_KHR_synchronization2 and VK_KHR_dynamic_rendering, and one queue
// family with graphics and compute. Prefers a discrete GPU, then integrated, virtual, CPU.
class Device
{
public:
    explicit Device(const DeviceOptions& options);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] const gpu::Context& context() const { return context_; }
    [[nodiscard]] gpu::Allocator& allocator() const { return *allocator_; }
    [[nodiscard]] const DeviceInfo& info() const { return info_; }
    [[nodiscard]] VkQueue queue() const { return queue_; }
    [[nodiscard]] uint32_t queue_family() const { return queue_family_; }
    [[nodiscard]] ValidationLog& validation() { return validation_; }
    [[nodiscard]] bool is_cpu() const { return info_.type == VK_PHYSICAL_DEVICE_TYPE_CPU; }
    [[nodiscard]] bool draws_wires() const { return draws_wires_; } // the feature fillModeNonSolid, which is on then
    void wait_idle() const;                                         // start-up and shutdown only

private:
    void create_instance(const DeviceOptions& options);
    void choose_physical_device(const std::string& wanted);
    void create_device(const DeviceOptions& options);
    void create_allocator(bool device_addresses);
    void release() noexcept;

    ValidationLog validation_;
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    std::unique_ptr<gpu::Allocator> allocator_;
    VkPipelineCache pipeline_cache_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    uint32_t queue_family_ = 0;
    DeviceInfo info_;
    bool draws_wires_ = false;
    gpu::Context context_;
};

// Waits for the device at the end of its scope, also after an exception. Declare it after the objects that frames in
// flight write.
class IdleGuard
{
public:
    explicit IdleGuard(const Device& device) : device_(device) {}
    ~IdleGuard() { (void)device_.context().fn.vkDeviceWaitIdle(device_.context().device()); }
    IdleGuard(const IdleGuard&) = delete;
    IdleGuard& operator=(const IdleGuard&) = delete;

private:
    const Device& device_;
};

// Throws StartupError with `what` and the result's name unless `result` is VK_SUCCESS.
void check(VkResult result, const char* what);

// The value, or StartupError with the result's message.
template <typename T>
T take(Result<T> result)
{
    if (!result)
        throw StartupError(result.error().message);
    return std::move(result.value());
}

inline void take(const Result<void>& result)
{
    if (!result)
        throw StartupError(result.error().message);
}

} // namespace voile::engine
