// SPDX-License-Identifier: Apache-2.0
#include "server/feed/selection.h"

namespace fieldcast::feed {

namespace {

std::string size_text(std::uint32_t a, std::uint32_t b) {
    return std::to_string(a) + "x" + std::to_string(b);
}

std::string text(const PlaneSelection& selection) {
    std::string list;
    for (const wire::PlaneChoice& choice : selection.choices) {
        list += (list.empty() ? "planes " : ", ") + std::string(word_of(choice.semantic)) + " " +
                (choice.format ? std::string(word_of(*choice.format)) + " " : "") + to_text(choice.encoding);
    }
    return list;
}

std::string text(const ViewSelection& selection) {
    return "views " + size_text(selection.grid.rows, selection.grid.cols) + " of " +
           size_text(selection.format.width_px, selection.format.height_px) + " " + to_text(selection.format.encoding);
}

} // namespace

std::string to_text(const Selection& selection) {
    return std::visit([](const auto& kind) { return text(kind); }, selection);
}

std::string to_text(const codec::Encoding& encoding) {
    const std::string word(word_of(encoding.codec));
    return is_lossy(encoding.codec) ? word + " " + std::to_string(encoding.quality) : word;
}

} // namespace fieldcast::feed
