// Validation: the Khronos layer with synchronization validation, and the log of what it says.
#pragma once

#include "voile/gpu/vulkan.hpp"

#include <array>
#include <atomic>
#include <mutex>
#include <string>
#include <vector>

namespace voile::engine
{

// Counts and keeps what the validation layer says. Messages may arrive on any thread.
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

// What an instance's creation chain needs to switch validation on. Must outlive vkCreateInstance.
class ValidationRequest
{
public:
    // StartupError if the layer is not installed.
    explicit ValidationRequest(ValidationLog& log);
    ValidationRequest(const ValidationRequest&) = delete;
    ValidationRequest& operator=(const ValidationRequest&) = delete;

    // Adds layer and chain to `info`, and to `extensions` what the chain needs.
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
