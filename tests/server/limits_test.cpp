// SPDX-License-Identifier: Apache-2.0
// Limits per peer and in total, over gRPC.
#include "server/service/download_table.h"
#include "server/service/session_table.h"
#include "tests/server/served_channel.h"

#include <future>
#include <grpcpp/generic/generic_stub.h>
#include <gtest/gtest.h>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using grpc::StatusCode;
using testing::HasSubstr;
using Kind = v1::ServerMessage;

/// A scene download that reads only when told to.
class Download {
public:
    explicit Download(int port)
        : connection_(connect_with_small_window(port)), stub_(v1::Catalog::NewStub(connection_)) {
        v1::FetchSceneRequest request;
        const auto hash = synthetic_info().scene_hash;
        request.set_scene_hash(hash.data(), hash.size());
        context_.set_wait_for_ready(true);
        context_.set_deadline(std::chrono::system_clock::now() + kCallDeadline);
        reader_ = stub_->FetchScene(&context_, request);
    }

    bool read() {
        v1::SceneChunk chunk;
        const bool is_ok = reader_->Read(&chunk);
        bytes_ += chunk.data().size();
        return is_ok;
    }

    grpc::Status finish() {
        while (read()) {
        }
        return reader_->Finish();
    }

    std::size_t bytes() const { return bytes_; }

private:
    const std::shared_ptr<grpc::Channel> connection_;
    const std::unique_ptr<v1::Catalog::Stub> stub_;
    grpc::ClientContext context_;
    std::unique_ptr<grpc::ClientReader<v1::SceneChunk>> reader_;
    std::size_t bytes_ = 0;
};

TEST(ServiceLimits, APeerMayNotOpenSessionsTooFast) {
    ServedChannel served({.max_sessions_per_peer = 3, .max_opens_per_second_per_peer = 0.1});
    for (int i = 0; i < 3; ++i) {
        OpenCall call(connect(served.port()));
        call.half_close();
        EXPECT_TRUE(call.finish().ok());
        EXPECT_TRUE(served.shows("fieldcast_sessions_closed_total{reason=\"finished\"}", i + 1.0));
    }
    const grpc::Status status = OpenCall(connect(served.port())).finish();
    EXPECT_EQ(status.error_code(), StatusCode::RESOURCE_EXHAUSTED);
    EXPECT_THAT(status.error_message(), HasSubstr("too fast"));
    EXPECT_TRUE(served.shows("fieldcast_sessions_refused_total{reason=\"opens\"}", 1));
}

TEST(ServiceLimits, AllPeersTogetherMayNotOpenSessionsTooFast) {
    ServedChannel served({.max_sessions = 2, .max_sessions_per_peer = 3, .max_opens_per_second_per_peer = 0.01});
    for (int i = 0; i < 2; ++i) {
        OpenCall call(connect(served.port()));
        call.half_close();
        EXPECT_TRUE(call.finish().ok());
        EXPECT_TRUE(served.shows("fieldcast_sessions_closed_total{reason=\"finished\"}", i + 1.0));
    }
    EXPECT_THAT(OpenCall(connect(served.port())).finish().error_message(), HasSubstr("all peers together"));
    EXPECT_TRUE(served.shows("fieldcast_sessions_refused_total{reason=\"opens\"}", 1));
}

TEST(ServiceLimits, OneAddressHasAQuarterByDefaultAndNewcomersHaveAReserve) {
    service::SessionTable table(session::Limits{.max_opens_per_second_per_peer = 100.0});
    const auto fill = [&](const std::string& peer) {
        int count = 0;
        while (table.admit(peer, {}).has_value()) {
            ++count;
        }
        return count;
    };
    for (const char* peer : {"a", "b", "c"}) {
        EXPECT_EQ(fill(peer), 16) << peer;
    }
    EXPECT_EQ(fill("d"), 8) << "the last eight of 64 are for addresses that have none";
    EXPECT_THAT(table.admit("d", {}).error().message, HasSubstr("the last 8 of 64 sessions"));
    for (const char* peer : {"e", "f", "g", "h", "i", "j", "k", "l"}) {
        EXPECT_EQ(fill(peer), 1) << peer;
    }
    EXPECT_THAT(table.admit("m", {}).error().message, HasSubstr("all 64 sessions"));
}

TEST(ServiceLimits, OneAddressMayHaveAllWhereTheLimitsSaySo) {
    service::SessionTable table(session::Limits{.max_sessions = 5, .max_sessions_per_peer = 5});
    for (int i = 0; i < 5; ++i) {
        EXPECT_TRUE(table.admit("proxy", {}).has_value()) << i;
    }
    EXPECT_THAT(table.admit("proxy", {}).error().message, HasSubstr("all 5 sessions"));
}

TEST(ServiceLimits, TheLastDownloadsAreForNewcomers) {
    metrics::Registry registry;
    service::DownloadTable table(session::Limits{.max_scene_downloads = 4, .max_scene_downloads_per_peer = 3}, registry);
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(table.admit("a").has_value()) << i;
    }
    EXPECT_FALSE(table.admit("a").has_value());
    EXPECT_TRUE(table.admit("b").has_value());
    service::DownloadTable other(session::Limits{.max_scene_downloads = 3, .max_scene_downloads_per_peer = 2}, registry);
    EXPECT_TRUE(other.admit("a").has_value());
    EXPECT_TRUE(other.admit("a").has_value());
    EXPECT_FALSE(other.admit("a").has_value());
    EXPECT_TRUE(other.admit("b").has_value());
    EXPECT_THAT(other.admit("b").error(), HasSubstr("all 3 scene downloads"));
}

TEST(ServiceLimits, AllSessionsTogetherHaveABudgetOfBytes) {
    ServedChannel served({.max_bytes_in_flight_in_total = 1});
    OpenCall silent(connect(served.port()));
    silent.configure();
    ASSERT_TRUE(silent.read_frame().has_value()) << "one may go alone; it is not acknowledged";
    const feed::Selection planes = feed::PlaneSelection{.choices = {{.semantic = PlaneSemantic::kDiffuse}}};
    const auto recorder = feed::Feed::subscribe(served.feed(), planes, [](const feed::FramePtr&) {});
    ASSERT_TRUE(recorder.has_value()) << "the channel goes on, whoever else has room";
    OpenCall other(connect(served.port()));
    other.configure();
    ASSERT_TRUE(other.read_until(Kind::kConfigured).has_value());
    int heartbeats = 0;
    for (; heartbeats < 3; ++heartbeats) {
        const auto message = other.read();
        ASSERT_TRUE(message.has_value());
        ASSERT_FALSE(message->has_frame_chunk()) << "there are no bytes left for it";
    }
    EXPECT_THAT(served.page(), HasSubstr("reason=\"no_budget\"} "));
    EXPECT_GT(served.metric("fieldcast_frames_dropped_total{channel=\"synthetic\",reason=\"no_budget\"}"), 0.0);
    silent.cancel();
    EXPECT_FALSE(silent.finish().ok());
    EXPECT_TRUE(other.read_until(Kind::kFrameChunk).has_value()) << "the bytes came back";
    other.half_close();
    EXPECT_TRUE(other.finish().ok());
}

TEST(ServiceLimits, PixelsOfOnePeerAreLimited) {
    ServedChannel served({.max_pixels_per_peer = 5 * 64 * 36});
    v1::Configure wanted;
    wanted.mutable_grid()->set_rows(2);
    wanted.mutable_grid()->set_cols(2);
    OpenCall one(connect(served.port()));
    one.configure(wanted);
    ASSERT_TRUE(one.read_until(Kind::kConfigured).has_value());
    OpenCall two(connect(served.port()));
    two.configure(wanted);
    const auto refused = two.read_until(Kind::kRefused);
    ASSERT_TRUE(refused.has_value());
    EXPECT_EQ(refused->refused().reason(), v1::REFUSAL_REASON_EXHAUSTED);
    one.half_close();
    EXPECT_TRUE(one.finish().ok());
    EXPECT_TRUE(served.shows("fieldcast_sessions_closed_total{reason=\"finished\"}", 1));
    two.configure(wanted);
    EXPECT_TRUE(two.read_until(Kind::kConfigured).has_value());
    two.half_close();
    EXPECT_TRUE(two.finish().ok());
}

TEST(ServiceLimits, BytesOfMessagesCountBeforeAnybodyReadsThem) {
    ServedChannel served({.max_messages_per_second = 50.0}); // 100 at once
    v1::Configure wanted;
    wanted.set_resume_token(std::string(7000, 'x')); // 54 for its bytes, and 50 for a Configure
    OpenCall call(connect(served.port()));
    call.configure(wanted);
    const grpc::Status status = call.finish();
    EXPECT_EQ(status.error_code(), StatusCode::RESOURCE_EXHAUSTED);
    EXPECT_THAT(status.error_message(), HasSubstr("messages or bytes"));
    EXPECT_TRUE(served.shows("fieldcast_sessions_closed_total{reason=\"flooding\"}", 1));
    wanted.set_resume_token(std::string(257, 'x'));
    OpenCall other(connect(served.port()));
    other.configure(wanted);
    const auto refused = other.read_until(Kind::kRefused);
    ASSERT_TRUE(refused.has_value());
    EXPECT_EQ(refused->refused().field(), "resume_token");
    other.half_close();
    EXPECT_TRUE(other.finish().ok());
}

/// A call that is begun, and whose request never comes.
class BegunCall final : public grpc::ClientBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer> {
public:
    BegunCall(const std::shared_ptr<grpc::Channel>& channel, const std::string& method) : stub_(channel) {
        context_.set_wait_for_ready(true);
        stub_.PrepareBidiStreamingCall(&context_, method, grpc::StubOptions(), this);
        StartCall();
    }
    void OnDone(const grpc::Status& status) override { status_.set_value(status); }

    /// How the server ended it; nothing: it did not, in all that time.
    std::optional<grpc::Status> end() {
        auto status = status_.get_future();
        if (status.wait_for(kCallDeadline) == std::future_status::ready) {
            return status.get();
        }
        context_.TryCancel();
        status.wait();
        return std::nullopt;
    }

private:
    grpc::GenericStub stub_;
    grpc::ClientContext context_;
    std::promise<grpc::Status> status_;
};

TEST(ServiceLimits, CallsWithoutARequestAreCut) {
    ServedChannel served({.configure_deadline = 1500ms});
    Bystander bystander(served.port());
    const auto connection = connect(served.port());
    std::vector<std::unique_ptr<BegunCall>> calls;
    for (const char* const method : {"GetServerInfo", "ListChannels", "FetchScene"}) {
        for (int i = 0; i < 20; ++i) {
            calls.push_back(std::make_unique<BegunCall>(connection, std::string("/fieldcast.v1.Catalog/") + method));
        }
    }
    for (const auto& call : calls) {
        const auto status = call->end();
        ASSERT_TRUE(status.has_value());
        EXPECT_EQ(status->error_code(), StatusCode::DEADLINE_EXCEEDED);
        EXPECT_EQ(status->error_message(), "the request did not come in time");
    }
    EXPECT_TRUE(bystander.gets_more_frames());
    EXPECT_TRUE(Download(served.port()).finish().ok());
    EXPECT_EQ(served.metric("fieldcast_scene_downloads_total{result=\"stalled\"}"), 0.0) << "none of them was one";
}

TEST(ServiceLimits, RequestsThatAreNoneAreRefused) {
    ServedChannel served({});
    std::string answer;
    const auto connection = connect(served.port());
    EXPECT_EQ(call_raw(*connection, "/fieldcast.v1.Catalog/FetchScene", "\xFF\xFF", answer).error_code(),
              StatusCode::INVALID_ARGUMENT);
    EXPECT_TRUE(call_raw(*connection, "/fieldcast.v1.Catalog/ListChannels", "", answer).ok());
    EXPECT_NE(answer.find("synthetic"), std::string::npos);
}

TEST(ServiceLimits, SceneDownloadsAreLimitedAndCounted) {
    ServedChannel served({.max_scene_downloads_per_peer = 1});
    Download first(served.port());
    EXPECT_TRUE(first.read());
    EXPECT_EQ(served.metric("fieldcast_scene_downloads"), 1.0);
    Download second(served.port());
    const grpc::Status refused = second.finish();
    EXPECT_EQ(refused.error_code(), StatusCode::RESOURCE_EXHAUSTED);
    EXPECT_THAT(refused.error_message(), HasSubstr("all 1 scene downloads"));
    EXPECT_TRUE(first.finish().ok());
    EXPECT_TRUE(served.shows("fieldcast_scene_downloads_total{result=\"finished\"}", 1));
    EXPECT_EQ(served.metric("fieldcast_scene_downloads_total{result=\"refused\"}"), 1.0);
    EXPECT_EQ(served.metric("fieldcast_scene_bytes_total"), static_cast<double>(first.bytes()));
    EXPECT_TRUE(Download(served.port()).finish().ok()) << "there is room again";
}

TEST(ServiceLimits, ADownloadThatIsNotReadIsCut) {
    ServedChannel served({.max_scene_downloads = 1, .stall_deadline = 300ms});
    Bystander bystander(served.port());
    Download silent(served.port());
    EXPECT_TRUE(silent.read());
    EXPECT_TRUE(served.shows("fieldcast_scene_downloads_total{result=\"stalled\"}", 1));
    EXPECT_TRUE(served.shows("fieldcast_scene_downloads", 0));
    EXPECT_FALSE(silent.finish().ok());
    EXPECT_TRUE(Download(served.port()).finish().ok());
    EXPECT_TRUE(bystander.gets_more_frames());
}

} // namespace
} // namespace fieldcast::test
