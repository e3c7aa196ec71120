// SPDX-License-Identifier: Apache-2.0
// Usage: make_golden_recording FILE. Writes the recording that server_golden_recording_test.cpp reads.
#include "tests/server/synthetic_recording.h"

int main(int argc, char** argv) {
    using namespace fieldcast;
    if (argc != 2) {
        return 2;
    }
    feed::ChannelInfo info = test::synthetic_info("golden");
    std::vector<std::byte> bundle(100);
    for (std::size_t i = 0; i < bundle.size(); ++i) {
        bundle[i] = static_cast<std::byte>(3 * i);
    }
    info.bundle = std::make_shared<const std::vector<std::byte>>(std::move(bundle));
    test::write_synthetic_recording(argv[1], {"views:2x2:32x18", "views:1x2:16x9:jpeg:90", "g-buffer"}, 6, info);
    return 0;
}
