// SPDX-License-Identifier: Apache-2.0
// Reads /proc/self; see proc(5). What cannot be read is left out.
#include "server/metrics/process_metrics.h"

#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <sys/resource.h>
#include <unistd.h>

namespace fieldcast::metrics {

namespace {

/// Fields of /proc/self/stat from the third on; the second one, the program's name, may contain any character.
std::vector<double> stat_fields() {
    std::ifstream file("/proc/self/stat");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const std::size_t name_end = text.rfind(')');
    std::vector<double> fields;
    if (name_end == std::string::npos) {
        return fields;
    }
    std::istringstream words(text.substr(name_end + 1));
    std::string state;
    words >> state;
    fields.push_back(0.0); // field 3 is a letter
    for (double number = 0.0; words >> number;) {
        fields.push_back(number);
    }
    return fields;
}

double boot_time_s() {
    std::ifstream file("/proc/stat");
    std::string word;
    double value = 0.0;
    while (file >> word) {
        if (word == "btime" && file >> value) {
            return value;
        }
    }
    return 0.0;
}

void add_files(Page& page) {
    std::error_code error;
    const std::filesystem::directory_iterator files("/proc/self/fd", error);
    if (!error) {
        const auto count = std::distance(begin(files), end(files)) - 1; // one of them belongs to this listing
        page.add_gauge({"process_open_fds", "Open file descriptors."}, {}, static_cast<double>(count));
    }
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) == 0) {
        page.add_gauge({"process_max_fds", "Limit of open file descriptors."}, {},
                       static_cast<double>(limit.rlim_cur));
    }
}

} // namespace

void add_process_metrics(Page& page) {
    // Positions by proc(5), counted from 1; the vector begins with field 3.
    constexpr std::size_t kUserTime = 14 - 3;
    constexpr std::size_t kSystemTime = 15 - 3;
    constexpr std::size_t kThreads = 20 - 3;
    constexpr std::size_t kStartTime = 22 - 3;
    constexpr std::size_t kVirtualBytes = 23 - 3;
    constexpr std::size_t kResidentPages = 24 - 3;
    const std::vector<double> fields = stat_fields();
    add_files(page);
    if (fields.size() <= kResidentPages) {
        return;
    }
    const auto ticks_per_second = static_cast<double>(sysconf(_SC_CLK_TCK));
    const auto page_bytes = static_cast<double>(sysconf(_SC_PAGESIZE));
    page.add_counter({"process_cpu_seconds_total", "Processor time used, user and system, in seconds."}, {},
                     (fields[kUserTime] + fields[kSystemTime]) / ticks_per_second);
    page.add_gauge({"process_threads", "Number of threads."}, {}, fields[kThreads]);
    page.add_gauge({"process_start_time_seconds", "Start of the process, in seconds since 1970."}, {},
                   boot_time_s() + fields[kStartTime] / ticks_per_second);
    page.add_gauge({"process_virtual_memory_bytes", "Virtual memory size in bytes."}, {}, fields[kVirtualBytes]);
    page.add_gauge({"process_resident_memory_bytes", "Resident memory size in bytes."}, {},
                   fields[kResidentPages] * page_bytes);
}

} // namespace fieldcast::metrics
