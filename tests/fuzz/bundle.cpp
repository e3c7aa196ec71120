// SPDX-License-Identifier: Apache-2.0
#include "core/scene/bundle.h"

#include "core/base/error.h"
#include "tests/fuzz/input.h"

namespace fieldcast::fuzz {

namespace fs = std::filesystem;

namespace {

/// Nothing may lie beside `name` in `folder`.
void expect_alone(const fs::path& folder, const std::string& name) {
    for (const auto& entry : fs::directory_iterator(folder)) {
        FC_ASSERT(entry.path().filename() == name, "a bundle writes into its own folder");
    }
}

} // namespace

void bundle(Bytes input) {
    const fs::path above = scratch_folder() / "bundle";
    fs::create_directories(above);
    const auto unpacked = scene::unpack_bundle(input, above / "scene");
    expect_alone(above, "scene");
    if (unpacked) {
        FC_ASSERT(fs::is_regular_file(unpacked->file), "the file to load is there");
        try { // its glTF may be anything
            const auto again = scene::make_bundle(unpacked->file, unpacked->options);
            FC_ASSERT(again.size() <= input.size(), "a scene has no files that were not sent");
        } catch (const UserError&) {
        }
    }
    fs::remove_all(above);
}

} // namespace fieldcast::fuzz
