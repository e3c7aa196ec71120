// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace fieldcast::client::load {

/// Measured durations. Their names are the same in scenario files, results and documentation.
enum class Stage : std::uint8_t {
    kDue,        ///< due moment → decoded: the latency of a viewer, see DueSchedule
    kPose,       ///< pose sampled → decoded
    kRender,     ///< rendering on the server
    kEncode,     ///< encoding on the server
    kQueue,      ///< encoded → header chunk handed to the transport
    kSend,       ///< header chunk handed to the transport → trailer received
    kTransfer,   ///< header chunk received → trailer received
    kDecode,     ///< trailer received → frame checked or decoded; includes the wait for a decoder thread
    kInterval,   ///< one frame → the next
    kConnect,    ///< dialling → Configured
    kFirstFrame, ///< dialling → first frame
};
inline constexpr std::size_t kStageCount = 11;

struct StageText {
    std::string_view name;
    std::string_view meaning;
};
inline constexpr std::array<StageText, kStageCount> kStages{{
    {"due", "due moment to decoded"},
    {"pose", "pose sampled to decoded"},
    {"render", "rendering on the server"},
    {"encode", "encoding on the server"},
    {"queue", "encoded to start of sending"},
    {"send", "start of sending to last byte"},
    {"transfer", "first byte to last byte"},
    {"decode", "last byte to decoded"},
    {"interval", "one frame to the next"},
    {"connect", "dialling to configured"},
    {"first_frame", "dialling to first frame"},
}};

constexpr std::string_view name_of(Stage stage) {
    return kStages[static_cast<std::size_t>(stage)].name;
}

constexpr std::optional<Stage> stage_of(std::string_view name) {
    for (std::size_t i = 0; i < kStageCount; ++i) {
        if (kStages[i].name == name) {
            return static_cast<Stage>(i);
        }
    }
    return std::nullopt;
}

} // namespace fieldcast::client::load
