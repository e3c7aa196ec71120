// SPDX-License-Identifier: Apache-2.0
// The programs beside a server that means ill: what it says reaches no terminal as a command.
#include "core/wire/convert.h"
#include "tests/client/fake_server.h"
#include "tests/fixtures/program.h"
#include "tests/fixtures/test_folder.h"

#include <gmock/gmock.h>
#include <grpcpp/generic/async_generic_service.h>

namespace fieldcast::test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

constexpr auto kRunPatience = 60s;

/// A title, a cleared screen, the same as C1 control, and text that runs backwards.
constexpr const char* kIll = "ILL\x1B]0;owned\x07\x1B[2J\xC2\x9B" "2J\xE2\x80\xAE" "desrever";

void expect_harmless(const std::string& text) {
    EXPECT_THAT(text, HasSubstr("ILL")) << "the words themselves are told";
    for (const char* const command : {"\x1B", "\x07", "\xC2\x9B", "\xE2\x80\xAE"}) {
        EXPECT_THAT(text, Not(HasSubstr(command)));
    }
}

/// Ends every call of every service with a status.
class StatusServer : public grpc::CallbackGenericService {
public:
    explicit StatusServer(grpc::StatusCode code) : code_(code) {
        grpc::ServerBuilder builder;
        builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
        builder.RegisterCallbackGenericService(this);
        server_ = builder.BuildAndStart();
    }
    StatusServer(const StatusServer&) = delete;
    StatusServer& operator=(const StatusServer&) = delete;
    ~StatusServer() override {
        server_->Shutdown();
        server_->Wait();
    }
    std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

private:
    class Reactor : public grpc::ServerGenericBidiReactor {
    public:
        explicit Reactor(const grpc::Status& status) { Finish(status); }
        void OnDone() override { delete this; }
    };
    grpc::ServerGenericBidiReactor* CreateReactor(grpc::GenericCallbackServerContext* /*context*/) override {
        return new Reactor({code_, kIll});
    }

    const grpc::StatusCode code_;
    int port_ = 0;
    std::unique_ptr<grpc::Server> server_;
};

class PrintedText : public testing::Test {
protected:
    /// What a program says until its end.
    std::string said(const char* program, std::vector<std::string> flags) {
        Program run(program, std::move(flags), folder_ / "said.txt");
        EXPECT_TRUE(run.exit_code(kRunPatience).has_value()) << run.text();
        return run.text();
    }
    std::string client(const std::string& address) {
        return said(FIELDCAST_CLIENT, {"--server", address, "--frames", "1", "--save", "none", "--patience", "1",
                                       "--no-reconnect", "--verbose"});
    }
    std::string load(const std::string& address) {
        return said(FIELDCAST_LOAD, {"--clients", "1", "--duration", "1", "--verbose", address});
    }

    const TestFolder folder_;
};

TEST_F(PrintedText, StatusesAreHarmlessInEveryProgram) {
    for (const auto code : {grpc::StatusCode::UNAUTHENTICATED, grpc::StatusCode::UNAVAILABLE,
                            grpc::StatusCode::INVALID_ARGUMENT, grpc::StatusCode::INTERNAL}) {
        const StatusServer server(code);
        expect_harmless(client(server.address()));
        expect_harmless(load(server.address()));
        expect_harmless(said(FIELDCAST_SERVER, {"--health", server.address()}));
    }
}

TEST_F(PrintedText, RefusalsAreHarmless) {
    const FakeServer server([](FakeCall& call, int) {
        call.read_until(v1::ClientMessage::kConfigure);
        v1::ServerMessage message;
        message.mutable_refused()->set_request_id(1);
        message.mutable_refused()->set_field(kIll);
        message.mutable_refused()->set_message(kIll);
        call.send(message);
        call.read_rest();
    });
    expect_harmless(client(server.address()));
    expect_harmless(load(server.address()));
}

TEST_F(PrintedText, FarewellsAreHarmless) {
    const FakeServer server([](FakeCall& call, int) {
        call.read_until(v1::ClientMessage::kConfigure);
        v1::ServerMessage message;
        message.mutable_going_away()->set_reason(kIll);
        message.mutable_going_away()->set_deadline_ms(500);
        call.send(message);
        call.read_rest();
    });
    expect_harmless(client(server.address()));
    expect_harmless(load(server.address()));
}

TEST_F(PrintedText, NamesAreHarmless) {
    const FakeServer server([](FakeCall& call, int) {
        const auto configure = call.read_until(v1::ClientMessage::kConfigure);
        ASSERT_TRUE(configure.has_value());
        v1::ServerMessage message = configured_message(configure->configure());
        message.mutable_configured()->set_channel(kIll);
        call.send(message);
        const auto set = wire::from_proto(message.configured().view_set());
        ASSERT_TRUE(set.has_value());
        call.send(views_messages(*set, 1, message.configured().epoch()));
        call.read_rest();
    });
    const std::string log = folder_ / "frames.csv";
    const std::string text = said(FIELDCAST_CLIENT, {"--server", server.address(), "--grid", "2x2", "--frames", "1", "--save",
                                                     "none", "--verbose", "--frame-log", log});
    expect_harmless(text);
    expect_harmless(text_of(log));
}

} // namespace
} // namespace fieldcast::test
