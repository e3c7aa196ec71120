// SPDX-License-Identifier: Apache-2.0
#include "server/web/spare_descriptors.h"

#include <fcntl.h>
#include <unistd.h>

namespace fieldcast::web {

bool SpareDescriptors::release() {
    const bool has_some = !open_.empty();
    for (const int descriptor : open_) {
        ::close(descriptor);
    }
    open_.clear();
    return has_some;
}

void SpareDescriptors::refill() {
    while (open_.size() < count_) {
        const int descriptor = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
        if (descriptor < 0) {
            return;
        }
        open_.push_back(descriptor);
    }
}

} // namespace fieldcast::web
