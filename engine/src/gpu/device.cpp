// Device: instance, choice of the physical device, logical device, allocator.
#include "voile/engine/gpu/device.hpp"

#include "voile/gpu/printable.hpp"

#include <volk.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <optional>

namespace voile::engine
{

namespace
{

// 1.2 and two extensions rather than 1.3: RenderDoc reports 1.2 while it captures software devices.
constexpr uint32_t k_api_version = VK_API_VERSION_1_2;
constexpr std::array k_device_extensions{VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME,
                                         VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME};

void initialize_loader()
{
    if (volkInitialize() != VK_SUCCESS)
        throw StartupError(
            "no Vulkan loader (libvulkan.so.1) on this system; Debian and Ubuntu: apt install libvulkan1");
}

bool has_instance_extension(const char* name)
{
    uint32_t count = 0;
    vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data());
    return std::any_of(extensions.begin(), extensions.end(),
                       [&](const VkExtensionProperties& extension)
                       { return std::strcmp(extension.extensionName, name) == 0; });
}

std::vector<VkPhysicalDevice> physical_devices(VkInstance instance)
{
    uint32_t count = 0;
    vkEnumeratePhysicalDevices(instance, &count, nullptr);
    std::vector<VkPhysicalDevice> devices(count);
    vkEnumeratePhysicalDevices(instance, &count, devices.data());
    return devices;
}

bool has_device_extension(VkPhysicalDevice device, const char* name)
{
    uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
    return std::any_of(extensions.begin(), extensions.end(),
                       [&](const VkExtensionProperties& extension)
                       { return std::strcmp(extension.extensionName, name) == 0; });
}

uint32_t graphics_and_compute_family(VkPhysicalDevice device)
{
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    constexpr VkQueueFlags k_wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (uint32_t i = 0; i < count; ++i)
        if ((families[i].queueFlags & k_wanted) == k_wanted)
            return i;
    return UINT32_MAX;
}

std::string why_unusable(VkPhysicalDevice device, uint32_t api_version)
{
    if (api_version < k_api_version)
        return "Vulkan " + std::to_string(VK_API_VERSION_MAJOR(api_version)) + "." +
               std::to_string(VK_API_VERSION_MINOR(api_version)) + ", needs 1.2";
    for (const char* extension : k_device_extensions)
        if (!has_device_extension(device, extension))
            return std::string("no ") + extension;
    if (graphics_and_compute_family(device) == UINT32_MAX)
        return "no queue family with graphics and compute";
    return {};
}

DeviceInfo describe(VkPhysicalDevice device)
{
    VkPhysicalDeviceProperties plain{};
    vkGetPhysicalDeviceProperties(device, &plain);
    DeviceInfo info;
    info.name = plain.deviceName;
    info.type = plain.deviceType;
    info.api_version = plain.apiVersion;
    info.unusable = why_unusable(device, plain.apiVersion);
    if (plain.apiVersion >= VK_API_VERSION_1_2)
    {
        VkPhysicalDeviceDriverProperties driver{};
        driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
        VkPhysicalDeviceProperties2 properties{};
        properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
        properties.pNext = &driver;
        vkGetPhysicalDeviceProperties2(device, &properties);
        info.driver = std::string(driver.driverName) + " " + driver.driverInfo;
    }
    return info;
}

int preference(VkPhysicalDeviceType type)
{
    switch (type)
    {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return 3;
    default:
        return 4;
    }
}

// Finds the device that `wanted` names: by index or part of the name. Usable devices come first by preference().
size_t find_device(const std::vector<DeviceInfo>& infos, const std::string& wanted)
{
    size_t index = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    if (error == std::errc{} && end == wanted.data() + wanted.size())
    {
        if (index < infos.size())
            return index;
        throw StartupError("--device: no device " + gpu::printable(wanted) + ", there are " +
                           std::to_string(infos.size()) + " (--list-devices shows them)");
    }
    for (index = 0; index < infos.size(); ++index)
        if (infos[index].name.find(wanted) != std::string::npos)
            return index;
    throw StartupError("--device: no device is called \"" + gpu::printable(wanted) + "\" (--list-devices shows them)");
}

size_t best_device(const std::vector<DeviceInfo>& infos)
{
    size_t best = infos.size();
    for (size_t i = 0; i < infos.size(); ++i)
        if (infos[i].unusable.empty() &&
            (best == infos.size() || preference(infos[i].type) < preference(infos[best].type)))
            best = i;
    return best;
}

} // namespace

void check(VkResult result, const char* what)
{
    if (result != VK_SUCCESS)
        throw StartupError(std::string(what) + ": " + gpu::to_string(result));
}

std::vector<DeviceInfo> list_devices()
{
    initialize_loader();
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = k_api_version;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    VkInstance instance = VK_NULL_HANDLE;
    check(vkCreateInstance(&info, nullptr, &instance), "no Vulkan instance");
    volkLoadInstanceOnly(instance);
    std::vector<DeviceInfo> result;
    for (const VkPhysicalDevice device : physical_devices(instance))
        result.push_back(describe(device));
    vkDestroyInstance(instance, nullptr);
    return result;
}

Device::Device(const DeviceOptions& options)
{
    initialize_loader();
    try
    {
        create_instance(options);
        choose_physical_device(options.device);
        create_device(options);
        create_allocator(options.device_addresses);
    }
    catch (...)
    {
        release(); // no destructor runs if the constructor throws
        throw;
    }
}

Device::~Device()
{
    release();
}

void Device::release() noexcept
{
    if (pipeline_cache_ != VK_NULL_HANDLE)
        context_.fn.vkDestroyPipelineCache(device_, pipeline_cache_, nullptr);
    allocator_.reset();
    if (device_ != VK_NULL_HANDLE)
    {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDevice>(vkGetDeviceProcAddr(device_, "vkDestroyDevice"));
        destroy(device_, nullptr);
    }
    if (messenger_ != VK_NULL_HANDLE)
        vkDestroyDebugUtilsMessengerEXT(instance_, messenger_, nullptr);
    if (instance_ != VK_NULL_HANDLE)
        vkDestroyInstance(instance_, nullptr);
}

void Device::wait_idle() const
{
    check(context_.fn.vkDeviceWaitIdle(device_), "device");
}

void Device::create_instance(const DeviceOptions& options)
{
    std::optional<ValidationRequest> validation;
    if (options.validation)
        validation.emplace(validation_);

    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "voile";
    application.apiVersion = k_api_version;

    std::vector<const char*> extensions = options.instance_extensions;
    const bool debug_utils = has_instance_extension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME) || options.validation;
    if (debug_utils)
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    if (validation)
        validation->apply(info, extensions);
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    check(vkCreateInstance(&info, nullptr, &instance_), "no Vulkan instance");
    volkLoadInstanceOnly(instance_);
    if (validation)
        check(vkCreateDebugUtilsMessengerEXT(instance_, &validation->messenger(), nullptr, &messenger_),
              "debug messenger");
}

void Device::choose_physical_device(const std::string& wanted)
{
    const std::vector<VkPhysicalDevice> devices = physical_devices(instance_);
    std::vector<DeviceInfo> infos;
    infos.reserve(devices.size());
    for (const VkPhysicalDevice device : devices)
        infos.push_back(describe(device));
    if (devices.empty())
        throw StartupError(
            "no Vulkan device on this system; Mesa's lavapipe runs without a GPU (Debian and Ubuntu: apt "
            "install mesa-vulkan-drivers)");
    const size_t index = wanted.empty() ? best_device(infos) : find_device(infos, wanted);
    if (index == infos.size())
        throw StartupError("no usable Vulkan device: \"" + infos[0].name + "\" has " + infos[0].unusable);
    if (!infos[index].unusable.empty())
        throw StartupError("device \"" + infos[index].name + "\" cannot be used: " + infos[index].unusable);
    physical_device_ = devices[index];
    info_ = infos[index];
    queue_family_ = graphics_and_compute_family(physical_device_);
}

void Device::create_device(const DeviceOptions& options)
{
    std::vector<const char*> extensions(k_device_extensions.begin(), k_device_extensions.end());
    if (options.swapchain)
        extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);

    VkPhysicalDeviceDynamicRenderingFeaturesKHR dynamic_rendering{};
    dynamic_rendering.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES_KHR;
    dynamic_rendering.dynamicRendering = VK_TRUE;
    VkPhysicalDeviceSynchronization2FeaturesKHR synchronization2{};
    synchronization2.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES_KHR;
    synchronization2.synchronization2 = VK_TRUE;
    synchronization2.pNext = &dynamic_rendering;

    VkPhysicalDeviceBufferDeviceAddressFeatures device_addresses{};
    device_addresses.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES;
    device_addresses.bufferDeviceAddress = VK_TRUE;
    if (options.device_addresses)
        dynamic_rendering.pNext = &device_addresses;

    VkPhysicalDeviceFeatures supported{};
    vkGetPhysicalDeviceFeatures(physical_device_, &supported);
    VkPhysicalDeviceFeatures features{};
    features.fillModeNonSolid = supported.fillModeNonSolid;
    draws_wires_ = features.fillModeNonSolid == VK_TRUE;

    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info{};
    queue_info.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue_info.queueFamilyIndex = queue_family_;
    queue_info.queueCount = 1;
    queue_info.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &synchronization2;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue_info;
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    info.pEnabledFeatures = &features;
    check(vkCreateDevice(physical_device_, &info, nullptr, &device_), "device");
}

void Device::create_allocator(bool device_addresses)
{
    Handles handles{.instance = instance_,
                    .physical_device = physical_device_,
                    .device = device_,
                    .get_instance_proc_addr = vkGetInstanceProcAddr};
    allocator_ = take(gpu::Allocator::create(handles, device_addresses));
    handles.buffer_allocator = allocator_.get();
    context_ = take(gpu::create_context(handles));
    VkPipelineCacheCreateInfo cache_info{};
    cache_info.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
    check(context_.fn.vkCreatePipelineCache(device_, &cache_info, nullptr, &pipeline_cache_), "pipeline cache");
    context_.handles.pipeline_cache = pipeline_cache_;
    context_.fn.vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
    gpu::set_name(context_, VK_OBJECT_TYPE_QUEUE, queue_, "main queue");
}

} // namespace voile::engine
