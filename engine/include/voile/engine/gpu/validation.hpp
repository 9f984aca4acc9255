// Validation: the Khronos layer with synchronization validation, and the log of its messages.
#pragma once

#include "voile/gpu/vulkan.hpp"

#include <array>
#include <atomic>
#include <mutex>
#include <string>
#include <vector>

namespace voile::engine
{

// Counts and keeps the messages of the validation layer. They may arrive on any thread.
class ValidationLog
{
public:
    void add(std::string message);
    [[nodiscard]] uint32_t count() const { return count_; }
    [[nodiscard]] std::vector<std::string> messages() const; // the first 32
    void clear();
    bool echo = true; // print each message on standard error as it comes

private:
    std::atomic<uint32_t> count_ = 0;
    mutable std::mutex mutex_;
    std::vector<std::string> messages_;
};

// The instance creation chain that enables validation. Must outlive vkCreateInstance.
class ValidationRequest
{
public:
    // StartupError if the layer is not installed.
    explicit ValidationRequest(ValidationLog& log);
    ValidationRequest(const ValidationRequest&) = delete;
    ValidationRequest& operator=(const ValidationRequest&) = delete;

    // Adds layer and chain to `info`, and the extensions that the chain needs to `extensions`.
    void apply(VkInstanceCreateInfo& info, std::vector<const char*>& extensions) const;

    [[nodiscard]] const VkDebugUtilsMessengerCreateInfoEXT& messenger() const { return messenger_; }

private:
    VkDebugUtilsMessengerCreateInfoEXT messenger_{};
    VkValidationFeaturesEXT features_{};
#ifdef VK_EXT_layer_settings
    bool layer_settings_ = false;
    VkBool32 on_ = VK_TRUE;
    std::array<VkLayerSettingEXT, 2> settings_{};
    VkLayerSettingsCreateInfoEXT settings_info_{};
#endif
};

} // namespace voile::engine
