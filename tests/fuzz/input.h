// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/fuzz/targets.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace fieldcast::fuzz {

/// Takes an input apart.
class Reader {
public:
    explicit Reader(Bytes bytes) : bytes_(bytes) {}

    bool is_empty() const { return bytes_.empty(); }
    std::uint8_t take_byte();             ///< 0 at the end
    Bytes take(std::size_t count);        ///< fewer at the end
    Bytes take_piece();                   ///< two bytes, little-endian, say how long it is
    Bytes rest() { return take(bytes_.size()); }

private:
    Bytes bytes_;
};

std::string_view as_text(Bytes bytes);

/// A piece as `Reader::take_piece` takes it.
std::string as_piece(std::string_view bytes);

/// A folder of this process, removed when it ends.
const std::filesystem::path& scratch_folder();

/// Writes `bytes` into the scratch folder.
std::filesystem::path scratch_file(const std::string& name, Bytes bytes);

/// Runs `read`, which may throw UserError and nothing else. Returns whether it threw.
bool is_refused(const std::function<void()>& read);

} // namespace fieldcast::fuzz
