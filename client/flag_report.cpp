// SPDX-License-Identifier: Apache-2.0
#include "client/flag_report.h"

#include "core/base/flag_problem.h"

#include <CLI/CLI.hpp>
#include <sstream>

namespace fieldcast::client {

FlagReport report_of(const CLI::App& app, const CLI::ParseError& error) {
    std::ostringstream out;
    if (app.exit(error, out, out) == 0) { // --help, --version
        return {out.str(), 0};
    }
    const auto type_of = [&](const std::string& flag) {
        const CLI::Option* const option = app.get_option_no_throw(flag);
        return option == nullptr ? std::string() : option->get_type_name();
    };
    return {flag_problem(error.get_name(), error.what(), type_of) + "\n" + app.get_name() + " --help lists all flags\n",
            2};
}

} // namespace fieldcast::client
