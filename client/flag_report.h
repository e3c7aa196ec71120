// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
} // namespace CLI

namespace fieldcast::client {

/// What a program prints instead of running.
struct FlagReport {
    std::string text;
    int exit_code = 0; ///< 0: help or version
};

/// Text and exit code for a command line that CLI11 did not accept: the requested help or version (exit code 0), or the
/// flag and its problem (exit code 2).
FlagReport report_of(const CLI::App& app, const CLI::ParseError& error);

} // namespace fieldcast::client
