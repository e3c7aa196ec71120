// SPDX-License-Identifier: Apache-2.0
// What a Configure may hold, and what the largest one costs.
#include "server/session/field_limits.h"
#include "server/session/server_session.h"
#include "tests/server/synthetic.h"

#include <functional>
#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <set>

namespace fieldcast::session {
namespace {

using namespace std::chrono_literals;
using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// Whether its size is the sender's choice.
bool may_grow(const FieldDescriptor& field) {
    return field.is_repeated() || field.cpp_type() == FieldDescriptor::CPPTYPE_STRING;
}

void collect_growing(const Descriptor& message, const std::string& prefix, std::set<std::string>& paths) {
    for (int i = 0; i < message.field_count(); ++i) {
        const FieldDescriptor& field = *message.field(i);
        if (may_grow(field)) {
            paths.insert(prefix + field.name());
        }
        if (field.message_type() != nullptr) {
            collect_growing(*field.message_type(), prefix + field.name() + ".", paths);
        }
    }
}

/// A field that is no message, in one more place if it is repeated; varints take all the bytes that they can.
void put(Message& message, const FieldDescriptor& field) {
    const auto& reflection = *message.GetReflection();
    const bool repeated = field.is_repeated();
    switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_UINT32:
        return reflection.SetUInt32(&message, &field, UINT32_MAX);
    case FieldDescriptor::CPPTYPE_UINT64:
        return reflection.SetUInt64(&message, &field, UINT64_MAX);
    case FieldDescriptor::CPPTYPE_FLOAT:
        return reflection.SetFloat(&message, &field, 1e30F);
    case FieldDescriptor::CPPTYPE_BOOL:
        return reflection.SetBool(&message, &field, true);
    case FieldDescriptor::CPPTYPE_ENUM:
        return repeated ? reflection.AddEnumValue(&message, &field, 1) : reflection.SetEnumValue(&message, &field, 1);
    default:
        FAIL() << field.full_name() << ": a type that this test does not know";
    }
}

/// Sizes of the fields that may grow, by path.
using Sizes = std::function<std::size_t(const std::string& path)>;

/// Sets every field, those that may grow to their size.
void fill(Message& message, const std::string& prefix, const Sizes& sizes) {
    for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
        const FieldDescriptor& field = *message.GetDescriptor()->field(i);
        const auto& reflection = *message.GetReflection();
        const std::string path = prefix + field.name();
        const std::size_t size = may_grow(field) ? sizes(path) : 1;
        if (!field.is_repeated() && field.cpp_type() == FieldDescriptor::CPPTYPE_STRING) {
            reflection.SetString(&message, &field, std::string(size, 'x'));
            continue;
        }
        for (std::size_t n = 0; n < size; ++n) {
            if (field.message_type() == nullptr) {
                put(message, field);
                continue;
            }
            Message& inner = field.is_repeated() ? *reflection.AddMessage(&message, &field)
                                                 : *reflection.MutableMessage(&message, &field);
            fill(inner, path + ".", sizes);
        }
    }
}

std::size_t limit_of(const std::string& path) {
    for (const FieldLimit& limit : field_limits()) {
        if (limit.field == path) {
            return limit.most;
        }
    }
    ADD_FAILURE() << path << " has no limit";
    return 1;
}

v1::Configure largest_configure() {
    v1::Configure wanted;
    fill(wanted, "", limit_of);
    return wanted;
}

class FieldLimitsTest : public testing::Test {
protected:
    v1::Refused refusal(const v1::Configure& wanted) {
        v1::ClientMessage message;
        *message.mutable_configure() = wanted;
        session_.on_message(message, now_);
        v1::ServerMessage answer;
        const auto chunk = session_.next(now_);
        EXPECT_TRUE(chunk && answer.ParseFromString(wire::joined(*chunk)));
        EXPECT_TRUE(answer.has_refused()) << answer.ShortDebugString();
        now_ += 1s; // the rate of messages is none of this
        return answer.refused();
    }

    std::shared_ptr<feed::Feed> feed_ = std::make_shared<feed::Feed>(test::synthetic_info());
    TimePoint now_{TimePoint::duration(1h)};
    ServerSession session_{{feed_}, Limits{}, [](const feed::FramePtr&) {}, now_};
};

TEST(FieldLimits, EveryFieldThatMayGrowHasOne) {
    std::set<std::string> growing;
    collect_growing(*v1::Configure::descriptor(), "", growing);
    std::set<std::string> limited;
    for (const FieldLimit& limit : field_limits()) {
        limited.insert(std::string(limit.field));
    }
    EXPECT_EQ(limited, growing);
}

TEST(FieldLimits, OnlyPosesGrowInOtherMessages) {
    std::set<std::string> growing;
    collect_growing(*v1::ClientMessage::descriptor(), "", growing);
    std::erase_if(growing, [](const std::string& path) { return path.starts_with("configure."); });
    EXPECT_THAT(growing, testing::ElementsAre("steer_camera.world_from_camera")) << "which has 12 values or is refused";
}

TEST(FieldLimits, AMessageHasRoomForTwiceTheLargestConfigure) {
    v1::ClientMessage message;
    *message.mutable_configure() = largest_configure();
    EXPECT_LE(message.ByteSizeLong(), std::size_t{kMaxClientMessageBytes} / 2);
    EXPECT_FALSE(oversized_field(message.configure()));
}

TEST_F(FieldLimitsTest, OneMoreIsRefusedByName) {
    for (const FieldLimit& limit : field_limits()) {
        v1::Configure wanted;
        fill(wanted, "", [&](const std::string& path) { return path == limit.field ? limit.most + 1 : 1; });
        const v1::Refused refused = refusal(wanted);
        EXPECT_EQ(refused.field(), limit.field);
        EXPECT_EQ(refused.reason(), v1::REFUSAL_REASON_INVALID);
        EXPECT_EQ(refused.message(), std::to_string(limit.most + 1) + " " + std::string(limit.unit) +
                                         " sent, at most " + std::to_string(limit.most) + " allowed");
    }
}

TEST_F(FieldLimitsTest, ThousandsOfCodecsCostARefusal) {
    v1::Configure wanted;
    for (int i = 0; i < 32'000; ++i) {
        wanted.add_codecs();
    }
    wanted.mutable_adaptation()->set_min_quality(1);
    const v1::Refused refused = refusal(wanted);
    EXPECT_EQ(refused.field(), "codecs");
    EXPECT_EQ(refused.message(), "32000 entries sent, at most 32 allowed");
    EXPECT_FALSE(session_.configuration());
}

TEST_F(FieldLimitsTest, TheLongestLadderOfTheLargestConfigureIsSmall) {
    feed::ChannelInfo info = test::synthetic_info();
    info.source_width_px = info.source_height_px = kMaxPlaneSide;
    v1::Configure wanted = largest_configure();
    v1::Adaptation& bounds = *wanted.mutable_adaptation();
    bounds.set_codecs(0, v1::CODEC_JPEG);
    bounds.set_min_quality(1);
    bounds.set_min_frames_per_second(0.1F);
    bounds.set_min_view_height_px(1);
    bounds.set_min_rows(1);
    bounds.set_min_cols(1);
    Configuration granted{.feed = std::make_shared<feed::Feed>(info), .view_set = {}, .selection = feed::ViewSelection{}};
    granted.view_set.grid.rows = 1;
    granted.view_set.grid.cols = kMaxViews;
    granted.view_set.width_px = granted.view_set.height_px = kMaxPlaneSide;
    const Ladder ladder(wanted, granted);
    EXPECT_LE(ladder.rungs().size(), 64U);
    const std::size_t bytes = ladder.configure(Rung{}).SpaceUsedLong() + ladder.rungs().size_bytes();
    EXPECT_LE(bytes, std::size_t{16} << 10) << "one message, and rungs that own nothing";
}

TEST_F(FieldLimitsTest, BytesCountAsMessages) {
    const auto most = static_cast<std::size_t>(2.0 * Limits{}.max_messages_per_second) * kBytesPerMessage;
    session_.on_bytes(kBytesPerMessage - 1, now_);
    session_.on_bytes(most, now_);
    EXPECT_FALSE(session_.is_flooded());
    session_.on_bytes(kBytesPerMessage, now_);
    EXPECT_TRUE(session_.is_flooded());
}

} // namespace
} // namespace fieldcast::session
