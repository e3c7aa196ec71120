// SPDX-License-Identifier: Apache-2.0
#include "core/gpu/free_memory.h"

#include "core/gpu/device_state.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>

namespace fieldcast::gpu {

namespace {

constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();

/// The number at the start of a file; kUnknown if the file does not start with a number, such as "max".
std::uint64_t number_in(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::uint64_t number = 0;
    return stream >> number ? number : kUnknown;
}

/// Available main memory, bytes; kUnknown if Linux does not report it.
std::uint64_t free_in_machine() {
    std::ifstream lines("/proc/meminfo"); // "MemAvailable:   12345 kB"
    std::string word;
    std::uint64_t kilobytes = 0;
    while (lines >> word) {
        if (word == "MemAvailable:" && lines >> kilobytes) {
            return kilobytes << 10U;
        }
    }
    return kUnknown;
}

/// Bytes that the control group (version 2) of this process has left; kUnknown without a limit.
std::uint64_t free_in_group() {
    std::ifstream lines("/proc/self/cgroup"); // "0::/system.slice/fieldcast-server.service"
    std::string line;
    while (std::getline(lines, line)) {
        if (line.starts_with("0::/")) {
            const std::filesystem::path folder = std::filesystem::path("/sys/fs/cgroup") / line.substr(4);
            const std::uint64_t most = number_in(folder / "memory.max");
            const std::uint64_t used = number_in(folder / "memory.current");
            return most == kUnknown || used == kUnknown ? kUnknown : most - std::min(most, used);
        }
    }
    return kUnknown;
}

bool reports_budget(VkPhysicalDevice physical) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> found(count);
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, found.data());
    return std::ranges::any_of(found, [](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME) == 0;
    });
}

std::uint64_t free_on_device(const DeviceState& state) {
    VkPhysicalDeviceMemoryBudgetPropertiesEXT budget{};
    budget.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT;
    VkPhysicalDeviceMemoryProperties2 memory{};
    memory.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_PROPERTIES_2;
    const bool has_budget = reports_budget(state.physical);
    memory.pNext = has_budget ? &budget : nullptr;
    vkGetPhysicalDeviceMemoryProperties2(state.physical, &memory);
    const VkPhysicalDeviceMemoryProperties& heaps = memory.memoryProperties;
    std::uint64_t most = 0;
    for (std::uint32_t i = 0; i < heaps.memoryHeapCount; ++i) {
        const VkMemoryHeap& heap = heaps.memoryHeaps[i];
        const std::uint64_t left =
            has_budget ? budget.heapBudget[i] - std::min(budget.heapBudget[i], budget.heapUsage[i]) : heap.size;
        most = (heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0 ? std::max(most, left) : most;
    }
    return most;
}

} // namespace

std::uint64_t free_memory_bytes(const Device& device) {
    return device.info().is_cpu ? std::min(free_in_machine(), free_in_group()) : free_on_device(device.state());
}

} // namespace fieldcast::gpu
