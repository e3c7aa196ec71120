// SPDX-License-Identifier: Apache-2.0
#include "client/play/cache_entry.h"

#include "core/base/error.h"
#include "tests/fuzz/input.h"

#include <algorithm>

namespace fieldcast::fuzz {

namespace {

void expect_inside(const std::filesystem::path& file) {
    const auto relative = file.lexically_normal().lexically_relative(scratch_folder());
    FC_ASSERT(!relative.empty() && *relative.begin() != "..", "a cached scene lies in its folder");
}

} // namespace

void cache_entry(Bytes input) {
    scratch_file("entry.json", input);
    const auto entry = client::play::read_cache_entry(scratch_folder());
    if (entry) {
        expect_inside(entry->file);
        if (entry->options.environment) {
            expect_inside(*entry->options.environment);
        }
    }
}

} // namespace fieldcast::fuzz
