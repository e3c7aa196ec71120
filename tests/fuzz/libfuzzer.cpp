// SPDX-License-Identifier: Apache-2.0
// fieldcast-fuzz --target=NAME [libFuzzer's flags] [CORPUS …]. libFuzzer itself passes over flags with two dashes, and
// hands them on to the processes that it starts to merge and to minimise.
#include "tests/fuzz/targets.h"

#include "core/base/log.h"
#include "core/wire/protobuf_log.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace {

const fieldcast::fuzz::Target* target = nullptr;

} // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    constexpr std::string_view kFlag = "--target=";
    for (int i = 1; i < *argc; ++i) {
        const std::string_view argument = (*argv)[i];
        if (argument.starts_with(kFlag)) {
            target = fieldcast::fuzz::find_target(argument.substr(kFlag.size()));
        }
    }
    if (target == nullptr) {
        std::fputs("usage: fieldcast-fuzz --target=NAME [libFuzzer's flags] [CORPUS …]; targets:", stderr);
        for (const fieldcast::fuzz::Target& known : fieldcast::fuzz::all_targets()) {
            std::fprintf(stderr, " %s", std::string(known.name).c_str());
        }
        std::fputs("\n", stderr);
        std::exit(2);
    }
    fieldcast::log::set_level(fieldcast::log::Level::kError);
    fieldcast::wire::take_protobuf_log();
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    target->run(std::as_bytes(std::span(data, size)));
    return 0;
}
