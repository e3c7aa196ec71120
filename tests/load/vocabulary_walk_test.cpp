// SPDX-License-Identifier: Apache-2.0
// Every delivery mode, with every set of planes and codec that it may have, goes through all that has to know it:
// negotiation, ladder of adaptation, recording, load harness, metrics. A new row of the vocabulary is walked by itself.
#include "client/net/request_text.h"
#include "run_until.h"
#include "server/recording/replay.h"
#include "server/service/grpc_server.h"
#include "server/session/ladder.h"
#include "server/session/negotiate.h"
#include "tests/fixtures/test_folder.h"
#include "tests/server/synthetic_recording.h"

#include <gmock/gmock.h>

namespace fieldcast::client::load {
namespace {

using std::chrono_literals::operator""s;

/// One way to ask for a stream: settings as a user types them.
struct Walk {
    net::Request request;
    std::string form; ///< of a recording that has it; names the walk
};

std::vector<Walk> walks_of(DeliveryMode mode, PlaneSet set, const std::string& content) {
    std::vector<Walk> walks;
    for (const Codec codec : kAll<Codec>) {
        const std::string word(word_of(codec));
        const auto form = recording::parse_form(content + ":" + word);
        if (!form) { // a codec that carries none of the planes
            continue;
        }
        Walk walk{.request = {}, .form = content + ":" + word};
        walk.request.rows = walk.request.cols = 2;
        const net::Setters<net::Request>& setters = net::request_setters();
        EXPECT_EQ(net::set(setters, "mode", std::string(word_of(mode)), walk.request), "");
        EXPECT_EQ(net::set(setters, "planes", std::string(word_of(set)), walk.request), "");
        EXPECT_EQ(net::set(setters, "codec", word + (word == "zstd" ? "" : "+zstd"), walk.request), "");
        walks.push_back(walk);
    }
    return walks;
}

/// All of them; a mode whose planes are chosen by the client has one per set of planes.
std::vector<Walk> all_walks() {
    std::vector<Walk> walks;
    const auto add = [&walks](const std::vector<Walk>& more) { walks.insert(walks.end(), more.begin(), more.end()); };
    for (const DeliveryMode mode : kAll<DeliveryMode>) {
        if (!row_of(mode).planes.empty()) {
            add(walks_of(mode, PlaneSet::kIllumination, std::string(word_of(mode))));
            continue;
        }
        for (const PlaneSet set : kAll<PlaneSet>) {
            add(walks_of(mode, set, std::string(word_of(set))));
        }
    }
    return walks;
}

v1::Configure configure_of(const Walk& walk) {
    v1::Configure wanted = net::to_configure(walk.request, 1);
    v1::Adaptation& bounds = *wanted.mutable_adaptation();
    bounds.set_min_quality(40);
    bounds.set_min_frames_per_second(1.0F);
    for (const Codec codec : kAll<Codec>) {
        bounds.add_codecs(static_cast<v1::Codec>(codec));
    }
    for (const DeliveryMode mode : kAll<DeliveryMode>) {
        bounds.add_modes(static_cast<v1::DeliveryMode>(mode));
    }
    return wanted;
}

/// The codec of what a configuration's pictures are sent in.
std::vector<codec::Encoding> picture_encodings(const session::Configuration& granted) {
    if (const auto* views = std::get_if<feed::ViewSelection>(&granted.selection)) {
        return {views->format.encoding};
    }
    std::vector<codec::Encoding> encodings;
    for (const wire::PlaneChoice& choice : std::get<feed::PlaneSelection>(granted.selection).choices) {
        if (is_picture(choice.semantic)) {
            encodings.push_back(choice.encoding);
        }
    }
    return encodings;
}

TEST(VocabularyWalk, HasEveryModeAndCodec) {
    std::set<DeliveryMode> modes;
    std::set<Codec> codecs;
    for (const Walk& walk : all_walks()) {
        modes.insert(walk.request.mode);
        codecs.insert(walk.request.codecs.front());
    }
    EXPECT_EQ(modes.size(), kAll<DeliveryMode>.size());
    EXPECT_EQ(codecs.size(), kAll<Codec>.size());
}

TEST(VocabularyWalk, NegotiationGrantsWhatIsAsked) {
    const std::vector<std::shared_ptr<feed::Feed>> channels{std::make_shared<feed::Feed>(test::synthetic_info())};
    for (const Walk& walk : all_walks()) {
        SCOPED_TRACE(walk.form);
        const auto granted = session::negotiate(configure_of(walk), channels, {});
        ASSERT_TRUE(granted.has_value()) << granted.error().message;
        EXPECT_EQ(granted->mode, walk.request.mode);
        ASSERT_FALSE(picture_encodings(*granted).empty());
        EXPECT_EQ(picture_encodings(*granted).front().codec, walk.request.codecs.front());
        const auto agreement = net::from_configured(session::to_message(*granted, 1, 1, 3), walk.request);
        ASSERT_TRUE(agreement.has_value()) << agreement.error().message;
        EXPECT_EQ(agreement->mode, walk.request.mode);
    }
}

/// Every rung is granted, and costs less than the one before because something about the frames is different.
TEST(VocabularyWalk, EveryStepOfTheLadderSendsSomethingElse) {
    const std::vector<std::shared_ptr<feed::Feed>> channels{std::make_shared<feed::Feed>(test::synthetic_info())};
    for (const Walk& walk : all_walks()) {
        SCOPED_TRACE(walk.form);
        const v1::Configure wanted = configure_of(walk);
        const auto granted = session::negotiate(wanted, channels, {});
        ASSERT_TRUE(granted.has_value());
        const session::Ladder ladder(wanted, *granted);
        ASSERT_GT(ladder.rungs().size(), 1U);
        session::Configuration before = *granted;
        for (const session::Rung& rung : ladder.rungs().subspan(1)) {
            SCOPED_TRACE(ladder.change(rung));
            const auto next = session::negotiate(ladder.configure(rung), channels, {});
            ASSERT_TRUE(next.has_value()) << next.error().message;
            EXPECT_TRUE(next->selection != before.selection || next->frames_per_second < before.frames_per_second);
            before = *next;
        }
    }
}

class WalkThroughService : public testing::Test {
protected:
    WalkThroughService() {
        limits_.max_opens_per_second_per_peer = 1000.0;
        limits_.max_sessions_per_peer = limits_.max_sessions;
    }

    /// Clients of the load harness, a group per walk, that decode everything.
    LoadResult run(service::GrpcServer& server, const std::vector<Walk>& walks) {
        Scenario scenario;
        scenario.address = "127.0.0.1:" + std::to_string(server.port());
        scenario.threads = 2;
        for (const Walk& walk : walks) {
            Group& group = scenario.groups.emplace_back();
            group.name = walk.form;
            group.request = walk.request;
            group.request.max_frames_per_second = 5.0F;
            group.decoding = wire::Decoding::kFull;
        }
        return test::run_until(scenario, test::frames_for_everybody(2));
    }

    void expect_frames(const LoadResult& result) {
        for (const GroupResult& group : result.groups) {
            EXPECT_EQ(group.tally.failed + group.tally.refused + group.tally.lost, 0U) << group.group.name;
            EXPECT_GT(group.tally.frames, 0U) << group.group.name;
        }
    }

    /// Planes and codecs have the labels of the vocabulary.
    void expect_counted(const std::vector<Walk>& walks) {
        const std::string page = registry_->page().text();
        for (const Walk& walk : walks) {
            const std::string label = "codec=\"" + std::string(word_of(walk.request.codecs.front())) + "\"";
            EXPECT_THAT(page, testing::HasSubstr(label)) << walk.form;
        }
    }

    session::Limits limits_;
    const std::shared_ptr<metrics::Registry> registry_ = std::make_shared<metrics::Registry>();
};

TEST_F(WalkThroughService, LoadHarnessGetsFramesOfAllAndMetricsCountThem) {
    const std::vector<Walk> walks = all_walks();
    test::SyntheticChannel channel;
    service::GrpcServer server({.host = "127.0.0.1", .port = 0}, {channel.feed()}, limits_, access::Security{},
                               service::Observation{.registry = registry_});
    expect_frames(run(server, walks));
    expect_counted(walks);
}

TEST_F(WalkThroughService, RecordingsHaveAllAndReplayThem) {
    const std::vector<Walk> walks = all_walks();
    const test::TestFolder folder;
    const std::filesystem::path file = folder / "all.fcrec";
    std::vector<std::string> forms;
    for (const Walk& walk : walks) {
        forms.push_back(walk.form);
    }
    test::write_synthetic_recording(file, forms, 6);
    recording::Replay replay({.file = file, .name = "", .frames_per_second = std::nullopt}, *registry_);
    ASSERT_EQ(replay.feed()->info().recorded.size(), walks.size());
    service::GrpcServer server({.host = "127.0.0.1", .port = 0}, {replay.feed()}, limits_, access::Security{},
                               service::Observation{.registry = registry_});
    expect_frames(run(server, walks));
    expect_counted(walks);
}

} // namespace
} // namespace fieldcast::client::load
