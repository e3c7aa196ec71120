// SPDX-License-Identifier: Apache-2.0
#include "core/wire/protobuf_log.h"

#include "core/base/log.h"

#include <google/protobuf/stubs/logging.h>
#include <string>

namespace fieldcast::wire {

void take_protobuf_log() {
    google::protobuf::SetLogHandler([](google::protobuf::LogLevel, const char*, int, const std::string& message) {
        log::debug("protobuf", {{"message", message}});
    });
}

} // namespace fieldcast::wire
