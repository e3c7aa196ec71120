// SPDX-License-Identifier: Apache-2.0
// Listening and exchanges. The only file that knows Boost.Asio's sockets; everything but the constructor and the
// destructor runs in the endpoint's thread.
#include "server/web/endpoint.h"

#include "core/base/error.h"
#include "core/base/log.h"
#include "server/access/listening_rule.h"
#include "server/access/tls_context.h"
#include "server/web/connection_table.h"
#include "server/web/request_reader.h"
#include "server/web/spare_descriptors.h"

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <fcntl.h>
#include <map>
#include <thread>

namespace fieldcast::web {

namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using Clock = std::chrono::steady_clock;
using Error = boost::system::error_code;
using TlsStream = asio::ssl::stream<boost::beast::tcp_stream&>;

constexpr int kBacklog = 128;
constexpr std::size_t kSpareDescriptors = 4; // for one caller and for collecting its metrics
constexpr std::chrono::milliseconds kAcceptPause{100};
constexpr std::size_t kMostDrainedBytes = 64 * 1024;

/// Keeps programs that this process starts from inheriting the socket, which is the default of Asio.
void close_on_exec(int descriptor) {
    ::fcntl(descriptor, F_SETFD, FD_CLOEXEC);
}

/// Network of an address for limits: the IPv4 address itself or the IPv6 /64, because one caller has a whole /64.
std::string network_of(const asio::ip::address& address) {
    if (address.is_v4()) {
        return address.to_string();
    }
    const asio::ip::address_v6 v6 = address.to_v6();
    if (v6.is_v4_mapped()) {
        return asio::ip::make_address_v4(asio::ip::v4_mapped, v6).to_string();
    }
    constexpr std::size_t kPrefixBytes = 8;
    const auto bytes = v6.to_bytes();
    return {bytes.begin(), bytes.begin() + kPrefixBytes};
}

/// State shared by all exchanges of an endpoint.
struct Service {
    Service(std::vector<Route> pages, const access::Gate* guard, const Limits& bounds)
        : limits(bounds), routes(std::move(pages)), gate(guard), connections(bounds.connections) {}

    Limits limits;
    std::vector<Route> routes;
    const access::Gate* gate; ///< null: all callers are admitted
    ConnectionTable connections;
    SpareDescriptors spares{kSpareDescriptors};
};

/// One connection, from accepting to closing. Lives as long as one of its operations is pending.
class Exchange : public std::enable_shared_from_this<Exchange> {
public:
    Exchange(Service& service, ConnectionTable::Id id, tcp::socket socket)
        : service_(service), id_(id), socket_(std::move(socket)), reader_(service.limits) {}

    void begin(ssl_ctx_st* tls);
    void finish(); ///< at any time

private:
    void read();
    void answer(const ReadRequest& request);
    void part();
    void close_after_answer();
    void drain();

    /// Sets the deadline of the next operations to `time` from now, at most to the end of the whole exchange.
    void expire_in(std::chrono::milliseconds time) { socket_.expires_at(std::min(Clock::now() + time, end_)); }

    /// Whether closing discards unsent data; otherwise the system keeps it, for minutes.
    void forget_unsent(bool is_wanted) {
        Error ignored;
        socket_.socket().set_option(asio::socket_base::linger(is_wanted, 0), ignored);
    }

    /// Calls `use` with the stream that carries text: TLS or the plain socket.
    template <class Use> void with_stream(Use use) {
        if (tls_) {
            use(*tls_);
        } else {
            use(socket_);
        }
    }

    /// Wraps a handler that runs after an operation, with or without an error.
    template <class Next> auto anyway(Next next) {
        return [self = shared_from_this(), next](const Error& error, std::size_t count = 0) {
            try {
                next(error, count);
            } catch (const std::exception& problem) {
                log::warn("exchange failed", {{"problem", problem.what()}});
                self->finish();
            }
        };
    }

    /// Wraps a handler that runs after a successful operation; an error ends the exchange.
    template <class Next> auto then(Next next) {
        return anyway([this, next](const Error& error, std::size_t count) { error ? finish() : next(count); });
    }

    Service& service_;
    ConnectionTable::Id id_;
    Clock::time_point end_ = Clock::now() + service_.limits.exchange;
    boost::beast::tcp_stream socket_;
    std::optional<TlsStream> tls_; ///< over `socket_`
    RequestReader reader_;
    std::array<char, 4096> buffer_{};
    std::string text_; ///< the answer
    std::size_t drained_ = 0;
};

void Exchange::begin(ssl_ctx_st* tls) {
    if (tls == nullptr) {
        expire_in(service_.limits.request);
        read();
        return;
    }
    asio::ssl::context context(tls); // the stream keeps a reference to what it needs
    tls_.emplace(socket_, context);
    expire_in(service_.limits.handshake);
    tls_->async_handshake(TlsStream::server, then([this](std::size_t) {
                              expire_in(service_.limits.request);
                              read();
                          }));
}

void Exchange::read() {
    with_stream([this](auto& stream) {
        stream.async_read_some(asio::buffer(buffer_), then([this](std::size_t count) {
                                   const auto request = reader_.put({buffer_.data(), count});
                                   if (request) {
                                       answer(*request);
                                   } else {
                                       read();
                                   }
                               }));
    });
}

void Exchange::answer(const ReadRequest& request) {
    service_.connections.move_to(id_, Stage::kAnswering);
    service_.spares.release(); // pages may open files
    const Answer answer = request ? respond(*request, service_.routes, service_.gate) : request.error();
    service_.spares.refill();
    text_ = text_of(answer, request && request->method == "HEAD");
    forget_unsent(true);
    expire_in(service_.limits.exchange);
    with_stream([this](auto& stream) {
        asio::async_write(stream, asio::buffer(text_), then([this](std::size_t) { part(); }));
    });
}

/// Waits before closing: closing at once would discard the answer of callers that sent more than was read.
void Exchange::part() {
    service_.connections.move_to(id_, Stage::kParting);
    forget_unsent(false);
    expire_in(service_.limits.parting);
    if (tls_) {
        tls_->async_shutdown(anyway([this](const Error&, std::size_t) { close_after_answer(); }));
    } else {
        close_after_answer();
    }
}

void Exchange::close_after_answer() {
    Error ignored;
    socket_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    drain();
}

void Exchange::drain() {
    socket_.async_read_some(asio::buffer(buffer_), then([this](std::size_t count) {
                                drained_ += count;
                                drained_ > kMostDrainedBytes ? finish() : drain();
                            }));
}

void Exchange::finish() {
    socket_.close();
    service_.connections.remove(id_);
    service_.spares.refill();
}

/// The TLS context; none on loopback. Throws UserError if TLS or tokens are required and missing.
std::optional<access::TlsContext> tls_for(const Listening& listening) {
    const auto& [address, flag, security] = listening;
    if (is_loopback(address.host)) {
        return std::nullopt;
    }
    const access::Protection protection{.has_tls = security.certificates.has_value(),
                                        .has_tokens = security.tokens.has_value()};
    if (const auto problem = access::listening_problem(address.host, protection)) {
        throw UserError(flag + " " + to_text(address) + " " + *problem);
    }
    return access::TlsContext(*security.certificates);
}

/// "[::1]" -> "::1"
std::string without_brackets(const std::string& host) {
    return host.starts_with('[') && host.ends_with(']') ? host.substr(1, host.size() - 2) : host;
}

/// Throws std::runtime_error.
tcp::acceptor listen_on(asio::io_context& context, const HostPort& address) {
    Error error;
    tcp::resolver resolver(context);
    const auto found = resolver.resolve(without_brackets(address.host), std::to_string(address.port),
                                        tcp::resolver::passive | tcp::resolver::numeric_service, error);
    if (error) {
        throw std::runtime_error("cannot listen on " + to_text(address) + ": unknown host");
    }
    for (const auto& candidate : found) {
        tcp::acceptor acceptor(context);
        acceptor.open(candidate.endpoint().protocol(), error);
        if (error) {
            continue;
        }
        close_on_exec(acceptor.native_handle());
        acceptor.set_option(tcp::acceptor::reuse_address(true));
        acceptor.bind(candidate.endpoint(), error);
        if (!error) {
            acceptor.listen(kBacklog, error);
        }
        if (!error) {
            acceptor.non_blocking(true);
            return acceptor;
        }
    }
    throw std::runtime_error("cannot listen on " + to_text(address) + ": " + error.message() + "; is the port in use?");
}

} // namespace

class Endpoint::Impl {
public:
    Impl(const Listening& listening, const access::Gate& gate, std::vector<Route> routes, const Limits& limits)
        : tls_(tls_for(listening)), service_(std::move(routes), tls_ ? &gate : nullptr, limits),
          acceptor_(listen_on(context_, listening.address)), port_(acceptor_.local_endpoint().port()), pause_(context_),
          thread_([this](const std::stop_token& stop) { run(stop); }) {}

    int port() const { return port_; }

private:
    void run(const std::stop_token& stop);
    void await_caller();
    Error accept(tcp::socket& caller);
    bool cut_first();
    void pause(const Error& error);
    void welcome(tcp::socket socket);
    void cut(ConnectionTable::Id id);

    std::optional<access::TlsContext> tls_; ///< unset: plain text for all callers
    Service service_;
    std::map<ConnectionTable::Id, std::weak_ptr<Exchange>> exchanges_;
    asio::io_context context_{1};
    tcp::acceptor acceptor_;
    int port_;
    asio::steady_timer pause_;
    bool is_waiting_ = false; ///< waits for a caller or for the end of the pause
    bool is_deaf_ = false;    ///< already logged that accepting fails
    std::jthread thread_;
};

/// Runs until the stop request, which does not finish the exchanges; they are destroyed with `context_`.
void Endpoint::Impl::run(const std::stop_token& stop) {
    const std::stop_callback end(stop, [this] { context_.stop(); });
    while (!stop.stop_requested()) {
        try {
            if (!is_waiting_) {
                await_caller();
            }
            context_.run();
        } catch (const std::exception& problem) {
            log::error("web endpoint", {{"problem", problem.what()}}); // only the failed exchange ends
        }
    }
}

void Endpoint::Impl::await_caller() {
    // Not async_accept: without a descriptor, accepting fails even if no caller is waiting.
    acceptor_.async_wait(tcp::acceptor::wait_read, [this](const Error&) {
        is_waiting_ = false;
        tcp::socket caller(context_);
        const Error error = accept(caller);
        if (error && error != asio::error::would_block) {
            pause(error);
            return;
        }
        is_deaf_ = false;
        await_caller(); // first, independent of this caller
        if (!error) {
            welcome(std::move(caller));
        }
    });
    is_waiting_ = true;
}

/// Handles a lack of descriptors: the endpoint uses its reserve and closes connections until the reserve is refilled.
Error Endpoint::Impl::accept(tcp::socket& caller) {
    Error error;
    bool has_more_room = true;
    while (has_more_room) {
        acceptor_.accept(caller, error);
        const bool lacks_room =
            error == asio::error::no_descriptors || error == boost::system::errc::too_many_files_open_in_system;
        has_more_room = lacks_room && (service_.spares.release() || cut_first());
    }
    service_.spares.refill();
    while (!service_.spares.is_full() && cut_first()) {
    }
    return error;
}

/// False if there is no connection to close.
bool Endpoint::Impl::cut_first() {
    const auto first = service_.connections.first_to_go();
    if (first) {
        cut(*first);
    }
    return first.has_value();
}

/// Accepting failed; tries again after a pause, in which other connections may end.
void Endpoint::Impl::pause(const Error& error) {
    if (!std::exchange(is_deaf_, true)) {
        log::warn("web endpoint cannot accept callers and tries again", {{"problem", error.message()}});
    }
    pause_.expires_after(kAcceptPause);
    pause_.async_wait([this](const Error&) { await_caller(); });
    is_waiting_ = true;
}

void Endpoint::Impl::welcome(tcp::socket socket) {
    Error error;
    close_on_exec(socket.native_handle());
    const tcp::endpoint caller = socket.remote_endpoint(error);
    if (error) {
        return; // has already disconnected
    }
    const ConnectionTable::Id id = service_.connections.add(network_of(caller.address()));
    try {
        if (const auto surplus = service_.connections.surplus()) {
            log::debug("connection closed in favour of a new one", {{"connection", *surplus}});
            cut(*surplus);
        }
        std::erase_if(exchanges_, [](const auto& entry) { return entry.second.expired(); });
        const auto exchange = std::make_shared<Exchange>(service_, id, std::move(socket));
        exchanges_[id] = exchange;
        exchange->begin(tls_ ? tls_->share() : nullptr);
    } catch (...) {
        service_.connections.remove(id);
        throw;
    }
}

void Endpoint::Impl::cut(ConnectionTable::Id id) {
    service_.connections.remove(id);
    const auto exchange = exchanges_[id].lock();
    if (exchange) {
        exchange->finish();
    }
}

Endpoint::Endpoint(const Listening& listening, const access::Gate& gate, std::vector<Route> routes,
                   const Limits& limits)
    : impl_(std::make_unique<Impl>(listening, gate, std::move(routes), limits)) {}

Endpoint::~Endpoint() = default;

int Endpoint::port() const {
    return impl_->port();
}

} // namespace fieldcast::web
