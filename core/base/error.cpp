// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"

namespace fieldcast {

void assertion_failed(const char* condition, const char* message, const char* file, int line) {
    throw std::logic_error(std::string(file) + ":" + std::to_string(line) + ": " + message + " (" + condition + ")");
}

} // namespace fieldcast
