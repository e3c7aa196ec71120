// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fieldcast::scene {

/// Throws UserError "file: object: reason".
[[noreturn]] void refuse(const std::string& file, const std::string& object, const std::string& reason);

/// The name of an object in messages ("node 12 'lamp'"). Names from files are shortened, and control characters become
/// question marks.
std::string object_name(std::string_view kind, std::size_t index, std::string_view name = {});

/// Counts contents of a file that the scene ignores; one line per kind, at most 32 kinds.
class LoadWarnings {
public:
    /// `what` is a statement ("skins are ignored"), `unit` the counted object ("node"). Without unit there is no count.
    void add(const std::string& what, const std::string& unit = {});
    /// Lines such as "skins are ignored (3 nodes)", in alphabetical order.
    std::vector<std::string> lines() const;

private:
    std::map<std::pair<std::string, std::string>, std::uint64_t> counts_;
};

} // namespace fieldcast::scene
