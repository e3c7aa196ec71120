// SPDX-License-Identifier: Apache-2.0
#include "server/config/output_files.h"

#include <algorithm>
#include <fcntl.h>
#include <unistd.h>

namespace fieldcast::config {

namespace {

namespace fs = std::filesystem;

struct NamedFile {
    std::string flag;
    fs::path file;
    bool is_swapped_in = false; ///< written beside it and renamed, so that readers see all of it
};

std::vector<NamedFile> outputs_of(const Config& config) {
    std::vector<NamedFile> files;
    const auto add = [&](const char* flag, const fs::path& file, bool is_swapped_in = false) {
        files.push_back({.flag = flag, .file = file, .is_swapped_in = is_swapped_in});
    };
    add("--port-file", config.port_file.value_or(""), true);
    add("--metrics-port-file", config.metrics_port_file.value_or(""), true);
    add("--frame-log", config.timing_files.frame_log);
    add("--trace", config.timing_files.trace);
    for (const channel::RecordChoice& record : config.rendering.records) {
        add("--record", record.file);
    }
    std::erase_if(files, [](const NamedFile& named) { return named.file.empty(); });
    return files;
}

std::vector<NamedFile> inputs_of(const Config& config) {
    std::vector<NamedFile> files;
    for (const channel::ChannelChoice& channel : config.rendering.channels) {
        files.push_back({.flag = "--scene", .file = channel.scene});
    }
    for (const recording::ReplaySetup& replay : config.rendering.replays) {
        files.push_back({.flag = "--replay", .file = replay.file});
    }
    if (config.rendering.environment) {
        files.push_back({.flag = "--environment", .file = *config.rendering.environment});
    }
    if (config.security.tokens) {
        files.push_back({.flag = "--tokens", .file = *config.security.tokens});
    }
    if (config.security.certificates) {
        files.push_back({.flag = "--tls-cert", .file = config.security.certificates->certificate});
        files.push_back({.flag = "--tls-key", .file = config.security.certificates->key});
    }
    return files;
}

bool is_same(const fs::path& a, const fs::path& b) {
    std::error_code ignored;
    return fs::weakly_canonical(a, ignored) == fs::weakly_canonical(b, ignored);
}

/// Reason why the file cannot be written; empty: it can be written or created.
std::optional<std::string> writing_problem(const NamedFile& output) {
    const fs::path& file = output.file;
    std::error_code ignored;
    if (fs::is_directory(file, ignored)) {
        return "is a folder; name a file in it";
    }
    const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
    if (!fs::is_directory(folder, ignored)) {
        return "there is no folder " + folder.string() + "; make it first";
    }
    const bool is_kept = fs::exists(file, ignored) && !output.is_swapped_in;
    const fs::path& touched = is_kept ? file : folder;
    if (::faccessat(AT_FDCWD, touched.c_str(), is_kept ? W_OK : W_OK | X_OK, AT_EACCESS) != 0) {
        return "this user may not write to " + (is_kept ? std::string("it") : "the folder " + folder.string());
    }
    return std::nullopt;
}

} // namespace

std::vector<std::string> output_problems(const Config& config) {
    std::vector<std::string> problems;
    std::vector<NamedFile> taken = inputs_of(config);
    for (const NamedFile& output : outputs_of(config)) {
        const std::string subject = output.flag + " " + output.file.string() + ": ";
        if (const auto problem = writing_problem(output)) {
            problems.push_back(subject + *problem);
        }
        const auto other =
            std::ranges::find_if(taken, [&](const NamedFile& t) { return is_same(t.file, output.file); });
        if (other != taken.end()) {
            problems.push_back(subject + other->flag + " names the same file; take another one");
        }
        taken.push_back(output);
    }
    return problems;
}

} // namespace fieldcast::config
