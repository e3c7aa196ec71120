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

/// Of a command line that CLI11 did not parse: the help that was asked for, or what is wrong with which flag.
FlagReport report_of(const CLI::App& app, const CLI::ParseError& error);

} // namespace fieldcast::client
