// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/recording/recorded_form.h"
#include "server/recording/recording_writer.h"
#include "tests/server/synthetic.h"

namespace fieldcast::test {

/// Records `count` synthetic frames of the channel, so far apart, every fifth a key frame, in those forms.
inline void write_synthetic_recording(const std::filesystem::path& file, const std::vector<std::string>& forms,
                                      std::uint64_t count, feed::ChannelInfo info = synthetic_info("hall"),
                                      std::chrono::nanoseconds interval = std::chrono::milliseconds(20)) {
    feed::Demand demand;
    demand.needs_alone = true;
    for (const std::string& form : forms) {
        info.recorded.push_back(recording::selection_of(*recording::parse_form(form), info));
        feed::add(demand, info.recorded.back());
    }
    WorkerPool pool(1);
    recording::RecordingWriter writer(file, info);
    for (std::uint64_t id = 1; id <= count; ++id) {
        const std::uint64_t key_id = id - (id - 1) % 5;
        writer.add(*synthetic_frame(info, demand, id, pool, key_id), interval * static_cast<std::int64_t>(id));
    }
}

} // namespace fieldcast::test
