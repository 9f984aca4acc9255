// Validation: enables older and newer versions of the layer.
#include "voile/engine/gpu/validation.hpp"

#include "voile/engine/gpu/device.hpp"

#include <volk.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace voile::engine
{

namespace
{

constexpr const char* k_layer = "VK_LAYER_KHRONOS_validation";
constexpr VkValidationFeatureEnableEXT k_synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;

// The Vulkan version of the installed layer; 0 without a layer.
uint32_t layer_version()
{
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    const auto layer = std::find_if(layers.begin(), layers.end(),
                                    [](const VkLayerProperties& l) { return std::strcmp(l.layerName, k_layer) == 0; });
    return layer != layers.end() ? layer->specVersion : 0;
}

// From this version on the layer compares the command buffers of a submission by default. It checks shader accesses
// through descriptors only on request, by VK_EXT_layer_settings.
constexpr uint32_t k_layer_with_settings = VK_MAKE_API_VERSION(0, 1, 3, 290);

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user)
{
    std::string message = data->pMessage;
    const char* name = data->pMessageIdName; // newer layers omit it from the text
    if (name != nullptr && message.find(name) == std::string::npos)
        message = std::string(name) + ": " + message;
    static_cast<ValidationLog*>(user)->add(std::move(message));
    return VK_FALSE;
}

} // namespace

void ValidationLog::add(std::string message)
{
    constexpr size_t k_kept = 32;
    if (echo)
        std::fprintf(stderr, "validation: %s\n", message.c_str());
    const std::scoped_lock lock(mutex_);
    if (messages_.size() < k_kept)
        messages_.push_back(std::move(message));
    ++count_;
}

std::vector<std::string> ValidationLog::messages() const
{
    const std::scoped_lock lock(mutex_);
    return messages_;
}

void ValidationLog::clear()
{
    const std::scoped_lock lock(mutex_);
    messages_.clear();
    count_ = 0;
}

ValidationRequest::ValidationRequest(ValidationLog& log)
{
    const uint32_t version = layer_version();
    if (version == 0)
        throw StartupError(
            "--validate: the Khronos validation layer is not installed (Debian: vulkan-validationlayers)");
    messenger_.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    messenger_.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT;
    messenger_.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger_.pfnUserCallback = on_message;
    messenger_.pUserData = &log;
    features_.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features_.pNext = &messenger_;
    features_.enabledValidationFeatureCount = 1;
    features_.pEnabledValidationFeatures = &k_synchronization;
    if (version < k_layer_with_settings)
    {
        // Only the environment enables the comparison of a submission's command buffers.
        setenv("VK_LAYER_ENABLES", "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT", 0);
        return;
    }
#ifdef VK_EXT_layer_settings
    layer_settings_ = true;
    settings_[0] = {k_layer, "validate_sync", VK_LAYER_SETTING_TYPE_BOOL32_EXT, 1, &on_};
    settings_[1] = {k_layer, "syncval_shader_accesses_heuristic", VK_LAYER_SETTING_TYPE_BOOL32_EXT, 1, &on_};
    settings_info_.sType = VK_STRUCTURE_TYPE_LAYER_SETTINGS_CREATE_INFO_EXT;
    settings_info_.pNext = &messenger_;
    settings_info_.settingCount = static_cast<uint32_t>(settings_.size());
    settings_info_.pSettings = settings_.data();
#endif
}

void ValidationRequest::apply(VkInstanceCreateInfo& info, std::vector<const char*>& extensions) const
{
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &k_layer;
    info.pNext = &features_;
#ifdef VK_EXT_layer_settings
    if (layer_settings_)
    {
        extensions.push_back(VK_EXT_LAYER_SETTINGS_EXTENSION_NAME);
        info.pNext = &settings_info_;
    }
#endif
    (void)extensions;
}

} // namespace voile::engine
