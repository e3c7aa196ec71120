// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/instance.h"

#include "core/base/error.h"
#include "core/base/log.h"
#include "core/gpu/vulkan_error.h"

#include <algorithm>
#include <cstring>

namespace fieldcast::gpu {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr std::size_t kMaxKeptMessages = 64;

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                          VkDebugUtilsMessageTypeFlagsEXT /*types*/,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    const std::string text = data->pMessage != nullptr ? data->pMessage : "";
    const bool is_error = (severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT) != 0;
    if (is_error) {
        log::error("Vulkan validation", {{"message", text}});
    } else {
        log::warn("Vulkan validation", {{"message", text}});
    }
    auto messages = static_cast<DeviceState*>(user)->validation.lock();
    ++messages->count;
    if (messages->texts.size() < kMaxKeptMessages) {
        messages->texts.push_back(text);
    }
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(DeviceState& state) {
    VkDebugUtilsMessengerCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    // General messages come from the loader (unusable drivers, other layers), not from our calls.
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pfnUserCallback = on_message;
    info.pUserData = &state;
    return info;
}

bool has_layer(const char* name) {
    std::uint32_t count = 0;
    check(vkEnumerateInstanceLayerProperties(&count, nullptr), "vkEnumerateInstanceLayerProperties");
    std::vector<VkLayerProperties> layers(count);
    check(vkEnumerateInstanceLayerProperties(&count, layers.data()), "vkEnumerateInstanceLayerProperties");
    return std::ranges::any_of(layers, [&](const auto& layer) { return std::strcmp(layer.layerName, name) == 0; });
}

} // namespace

void create_instance(DeviceState& state, bool validation) {
    if (validation && !has_layer(kValidationLayer)) {
        throw UserError("Vulkan validation was requested, but VK_LAYER_KHRONOS_validation is not installed "
                        "(Debian package vulkan-validationlayers)");
    }
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "fieldcast";
    application.apiVersion = VK_API_VERSION_1_3;
    const auto messenger = messenger_info(state);
    const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;

    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    if (validation) {
        info.pNext = &messenger;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &kValidationLayer;
        info.enabledExtensionCount = 1;
        info.ppEnabledExtensionNames = &extension;
    }
    const VkResult result = vkCreateInstance(&info, nullptr, &state.instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
        throw NoDeviceError("no Vulkan driver found; install one, e.g. the software driver in mesa-vulkan-drivers");
    }
    check(result, "vkCreateInstance");
    if (validation) {
        const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(state.instance, "vkCreateDebugUtilsMessengerEXT"));
        check(create(state.instance, &messenger, nullptr, &state.messenger), "vkCreateDebugUtilsMessengerEXT");
    }
}

} // namespace fieldcast::gpu
