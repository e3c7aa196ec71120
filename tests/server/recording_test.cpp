// SPDX-License-Identifier: Apache-2.0
#include "server/recording/channel_recorder.h"
#include "server/recording/recorded_form.h"
#include "server/recording/replay.h"
#include "server/session/recorded.h"
#include "tests/fixtures/test_folder.h"
#include "tests/server/frame_time.h"
#include "tests/server/synthetic.h"

#include <gmock/gmock.h>

namespace fieldcast::recording {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr auto kPatience = 20s; // of a test on a busy machine

feed::Selection views_selection(const feed::ChannelInfo& info) {
    return selection_of(*parse_form("views:2x2:32x18"), info);
}

/// What the tests record: four small views and the illumination.
std::vector<feed::Selection> selections_of(const feed::ChannelInfo& info) {
    return {views_selection(info), selection_of(*parse_form("illumination"), info)};
}

feed::Demand demand_of(const feed::ChannelInfo& info) {
    feed::Demand demand;
    for (const feed::Selection& selection : selections_of(info)) {
        feed::add(demand, selection);
    }
    demand.needs_alone = true;
    return demand;
}

/// Everything that a client would receive of its selection, in bytes.
std::string bytes_of(const feed::EncodedFrame& frame, const feed::Selection& selection, bool has_key_frame) {
    const wire::ChunkOptions options{.epoch = 3, .has_key_frame = has_key_frame};
    wire::WireFrame chunks;
    if (const auto* planes = std::get_if<feed::PlaneSelection>(&selection)) {
        chunks = wire::source_chunks(*frame.source, planes->choices, options);
    } else {
        const auto& views = std::get<feed::ViewSelection>(selection);
        chunks = wire::view_chunks(*feed::find_views(frame, views.format), views.grid, options);
    }
    std::string bytes;
    for (const wire::WireChunk& chunk : chunks.chunks) {
        bytes += wire::joined(chunk);
    }
    return bytes + wire::joined(wire::trailer_chunk(chunks, frame.times));
}

/// The synthetic channel with a bundle that is quick to check.
feed::ChannelInfo small_info() {
    feed::ChannelInfo info = test::synthetic_info("hall");
    info.bundle = std::make_shared<const Bytes>(Bytes(1000, std::byte{7}));
    return info;
}

class RecordingTest : public testing::Test {
protected:
    /// Six frames: 5 and 8 are key frames, others refer to them, the first refers to one that is not recorded.
    void write() {
        feed::ChannelInfo info = info_;
        info.recorded = selections_of(info_);
        RecordingWriter writer(file_, info);
        for (const auto& [id, key] : {std::pair(4U, 1U), {5U, 5U}, {6U, 5U}, {7U, 5U}, {8U, 8U}, {9U, 8U}}) {
            frames_.push_back(test::synthetic_frame(info_, demand_of(info_), id, pool_, key));
            ASSERT_TRUE(writer.add(*frames_.back(), 100ms + 20ms * id));
            ends_.push_back(writer.file_bytes());
        }
        writer.finish();
    }

    /// Frame `i` must be what was recorded.
    void expect_same(Recording& recording, std::size_t i) {
        const auto frame = recording.read(i);
        ASSERT_TRUE(frame.has_value()) << frame.error().message;
        expect_same(*frame, i);
    }

    void expect_same(const feed::EncodedFrame& frame, std::size_t i) {
        for (const feed::Selection& selection : selections_of(info_)) {
            EXPECT_EQ(bytes_of(frame, selection, false), bytes_of(*frames_[i], selection, false)) << i;
            if (i > 0) { // the key frame of the first is not in the file
                EXPECT_EQ(bytes_of(frame, selection, true), bytes_of(*frames_[i], selection, true)) << i;
            }
        }
    }

    const test::TestFolder folder_;
    const std::filesystem::path file_ = folder_ / "test.fcrec";
    const feed::ChannelInfo info_ = small_info();
    WorkerPool pool_{1};
    std::vector<feed::FramePtr> frames_;
    std::vector<std::uint64_t> ends_; ///< of each frame in the file
    metrics::Registry registry_;
};

TEST_F(RecordingTest, GivesBackEveryByte) {
    write();
    Recording recording(file_);
    EXPECT_EQ(recording.info().name, "hall");
    EXPECT_EQ(recording.info().recorded, selections_of(info_));
    EXPECT_EQ(recording.info().scene_hash, info_.scene_hash);
    EXPECT_EQ(*recording.info().bundle, *info_.bundle) << "clients need the scene for planes";
    EXPECT_FALSE(recording.ignored().has_value());
    ASSERT_EQ(recording.frames().size(), 6U);
    for (std::size_t i = 0; i < 6; ++i) {
        expect_same(recording, i);
    }
    EXPECT_EQ(recording.frames()[0].mark.key_frame_id, 0U);
    EXPECT_EQ(recording.frames()[3].mark.key_frame_id, 5U);
    EXPECT_EQ(recording.frames()[5].mark.at_ns, 100'000'000);
    EXPECT_NE(bytes_of(*recording.read(2), views_selection(info_), true),
              bytes_of(*recording.read(2), views_selection(info_), false))
        << "frame 6 refers to frame 5: otherwise the test shows nothing about key frames";
}

TEST_F(RecordingTest, EveryCutTailIsIgnoredAndReported) {
    write();
    const std::string whole = test::text_of(file_);
    const std::size_t first = ends_[0];
    std::vector<std::size_t> lengths{first - 1, first, first + 1, first + 11, first + 12, whole.size() - 1};
    for (std::size_t length = first; length < whole.size(); length += 211) {
        lengths.push_back(length);
    }
    for (const std::size_t length : lengths) {
        test::write_file(file_, whole.substr(0, length));
        const auto complete =
            static_cast<std::size_t>(std::ranges::count_if(ends_, [&](std::uint64_t end) { return end <= length; }));
        if (complete == 0) {
            EXPECT_THROW(Recording{file_}, UserError) << length;
            continue;
        }
        Recording recording(file_);
        ASSERT_EQ(recording.frames().size(), complete) << length;
        EXPECT_TRUE(recording.ignored().has_value()) << length;
        expect_same(recording, complete - 1);
    }
}

TEST_F(RecordingTest, NoDamagedByteGoesUnnoticed) {
    feed::ChannelInfo small = info_;
    small.bundle = nullptr;
    small.recorded = {selection_of(*parse_form("views:1x1:8x4"), small)};
    feed::Demand demand;
    feed::add(demand, small.recorded[0]);
    demand.needs_alone = true;
    const feed::FramePtr original = test::synthetic_frame(small, demand, 7, pool_, 7);
    { RecordingWriter(file_, small).add(*original, 0ms); }
    const std::string whole = test::text_of(file_);
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ 0x21);
        test::write_file(file_, damaged);
        try {
            Recording recording(file_);
            const auto frame = recording.read(0);
            if (frame) { // the damage lies in the index, which was made anew
                EXPECT_TRUE(recording.ignored().has_value()) << i;
                EXPECT_EQ(bytes_of(*frame, small.recorded[0], true), bytes_of(*original, small.recorded[0], true)) << i;
            }
        } catch (const UserError& problem) {
            EXPECT_THAT(problem.what(), HasSubstr("test.fcrec")) << i;
        }
    }
}

TEST_F(RecordingTest, LengthsAreCheckedBeforeMemoryIsTaken) {
    write();
    std::string bytes = test::text_of(file_);
    bytes.replace(kMagic.size() + 4, 4, "\xFF\xFF\xFF\xFF"); // length of the first record
    test::write_file(file_, bytes);
    try {
        Recording recording(file_);
        FAIL() << "was read";
    } catch (const UserError& problem) {
        EXPECT_THAT(problem.what(), HasSubstr("4294967295 bytes announced"));
    }
    test::write_file(file_, std::string(kMagic.substr(0, kMagic.size() - 1)) + "\x02");
    EXPECT_THROW(Recording{file_}, UserError);
    test::write_file(file_, "no recording at all");
    EXPECT_THROW(Recording{file_}, UserError);
}

/// A channel is recorded while it runs; frames that a client would have got are in the file.
TEST_F(RecordingTest, RecordsAChannelAsItIsPublished) {
    const auto feed = std::make_shared<feed::Feed>(info_);
    {
        ChannelRecorder recorder(feed, {.file = file_, .selections = selections_of(info_), .max_frames = 3}, registry_);
        EXPECT_TRUE(feed->demand().needs_alone) << "clients of a replay join anywhere";
        const auto deadline = std::chrono::steady_clock::now() + kPatience;
        for (std::uint64_t id = 1; !recorder.has_ended(); ++id) {
            ASSERT_LT(std::chrono::steady_clock::now(), deadline);
            if (feed->subscriber_count() > 0) {
                auto frame = std::make_shared<feed::EncodedFrame>(
                    *test::synthetic_frame(info_, demand_of(info_), id, pool_, id));
                frame->times.encode_end_ns = static_cast<std::int64_t>(id) * 1'000'000;
                frames_.push_back(frame);
                feed->publish(frame);
            }
            test::pass_frame_time(5ms);
        }
        EXPECT_EQ(feed->subscriber_count(), 0U) << "the channel may sleep";
    }
    Recording recording(file_);
    ASSERT_EQ(recording.frames().size(), 3U);
    const auto last = recording.read(2);
    ASSERT_TRUE(last.has_value());
    expect_same(*last, last->header.frame_id - 1);
    EXPECT_THAT(registry_.page().text(), HasSubstr("fieldcast_recorded_frames_total{channel=\"hall\"} 3"));
}

/// Two and a half loops: ids grow, key frames belong to their loop, loops begin with a cut.
TEST_F(RecordingTest, ReplaysInALoop) {
    write();
    Guarded<std::vector<feed::FramePtr>> shown;
    std::condition_variable changed; // outlives the replay, which may call once more after the subscription has ended
    Replay replay({.file = file_, .name = "again", .frames_per_second = 200.0F}, registry_);
    EXPECT_EQ(replay.feed()->info().name, "again");
    auto subscription = feed::Feed::subscribe(replay.feed(), views_selection(info_), [&](const feed::FramePtr& frame) {
        shown.lock()->push_back(frame);
        changed.notify_all();
    });
    ASSERT_TRUE(subscription.has_value());
    ASSERT_TRUE(shown.lock().wait_until(changed, std::chrono::steady_clock::now() + kPatience,
                                        [](const auto& frames) { return frames.size() >= 15; }));
    subscription->end();
    const std::vector<feed::FramePtr> frames = *shown.lock();
    const std::int64_t now_ns = std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
    constexpr std::array<std::uint64_t, 6> kKeys{0, 2, 2, 2, 5, 5}; // of the first loop, whose ids are 1 to 6
    for (std::size_t i = 0; i < 15; ++i) {
        const feed::EncodedFrame& frame = *frames[i];
        const std::uint64_t loop = i / 6;
        EXPECT_EQ(frame.header.frame_id, i + 1);
        EXPECT_EQ(frame.key_frame_id, kKeys[i % 6] == 0 ? 0 : kKeys[i % 6] + 6 * loop);
        EXPECT_EQ(frame.header.cut, i % 6 == 0);
        EXPECT_EQ(frame.views.front().header.cut, i % 6 == 0);
        EXPECT_EQ(frame.views.front().key_frame_id, frame.key_frame_id);
        EXPECT_EQ(frame.source->header.frame_id, i + 1);
        EXPECT_LE(frame.times.encode_end_ns, now_ns);
        EXPECT_EQ(frame.times.pose_sampled_ns, frame.times.encode_end_ns) << "latencies are those of the replay";
        EXPECT_GE(frame.times.encode_end_ns, now_ns - std::chrono::nanoseconds(kPatience).count());
        const auto original = frames_[i % 6];
        for (const auto& [position, view] : frame.views.front().views) {
            const auto& recorded = original->views.front().views.at(position).image.strips;
            EXPECT_EQ(*view.image.strips[0].alone.bytes, *recorded[0].alone.bytes);
            EXPECT_EQ(view.image.strips[0].alone.crc32c, recorded[0].alone.crc32c);
        }
    }
}

TEST_F(RecordingTest, ReplaysSlowlyAtTinyFrameRates) {
    write();
    Guarded<std::size_t> shown(0);
    std::condition_variable changed;
    Replay replay({.file = file_, .name = "slow", .frames_per_second = 1e-30F}, registry_);
    auto subscription = feed::Feed::subscribe(replay.feed(), views_selection(info_), [&](const feed::FramePtr&) {
        ++*shown.lock();
        changed.notify_all();
    });
    ASSERT_TRUE(subscription.has_value());
    const auto is_there = [&](std::size_t count, auto patience) {
        return shown.lock().wait_until(changed, std::chrono::steady_clock::now() + patience,
                                       [&](std::size_t frames) { return frames >= count; });
    };
    EXPECT_TRUE(is_there(1, kPatience));
    EXPECT_FALSE(is_there(2, 200ms)) << "an interval that does not fit would be none at all";
}

TEST(RecordingForm, ReadsWhatCanBeTyped) {
    const feed::ChannelInfo info = test::synthetic_info();
    const auto text = [&](const char* form) { return feed::to_text(selection_of(*parse_form(form), info)); };
    EXPECT_EQ(text("views"), "views 6x6 of 64x36 zstd");
    EXPECT_EQ(text("views:raw"), "views 6x6 of 64x36 raw");
    EXPECT_EQ(text("views:3x4:32x18:jpeg:50"), "views 3x4 of 32x18 jpeg 50");
    EXPECT_EQ(text("illumination:jpeg"), "planes diffuse jpeg 75, specular jpeg 75");
    EXPECT_EQ(text("g-buffer"),
              "planes diffuse zstd, specular zstd, depth zstd, normal zstd, id zstd, material zstd");
    for (const char* const wrong : {"", "view", "views:", "views:3", "views:3x3:64x36:zstd:5", "views:3x3:jpeg:0",
                                    "views:jpeg:101", "illumination:3x3", "views:3x3:4x4:5x5", "g-buffer:raw:raw"}) {
        EXPECT_FALSE(parse_form(wrong).has_value()) << wrong;
    }
    EXPECT_THROW(selection_of(*parse_form("views:2x2:65x36"), info), UserError);
    EXPECT_THROW(selection_of(*parse_form("views:20x20"), info), UserError);
}

} // namespace
} // namespace fieldcast::recording
