// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/fixtures/program.h"

#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace fieldcast::test {

/// fieldcast-server as a process that renders small images of the demo scene, with metrics, on ports of its own.
class RunningServer {
public:
    /// Starts it with `flags` besides the usual ones. Waits until it is SERVING, or has ended.
    explicit RunningServer(const std::string& program, const std::vector<std::string>& flags = {});

    /// It ended because there is no Vulkan device. If it ended for another reason, the test fails.
    bool lacks_device() const;

    int port() const { return port_; }
    int metrics_port() const { return metrics_port_; }

    /// What /metrics shows now, without the head of the answer.
    std::string metrics() const;

    /// The value of a series as it stands on the page now, labels included; -1 if it is not there.
    double metric(const std::string& series) const { return value_on(metrics(), series); }

    /// The same on a page fetched before: several values of one moment.
    static double value_on(const std::string& page, const std::string& series);

    /// Waits until the series has that value.
    testing::AssertionResult shows(const std::string& series, double value, std::chrono::seconds patience) const;

    Program& process() { return process_; }
    std::string log() const { return process_.text(); }

private:
    /// Its own, beside the test's; removed at the end.
    struct Folder {
        Folder();
        ~Folder();
        Folder(const Folder&) = delete;
        Folder& operator=(const Folder&) = delete;
        std::filesystem::path path;
    };

    const Folder folder_;
    Program process_;
    bool is_serving_;
    int port_ = 0;
    int metrics_port_ = 0;
};

} // namespace fieldcast::test
