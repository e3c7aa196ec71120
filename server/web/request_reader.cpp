// SPDX-License-Identifier: Apache-2.0
// The only file that knows Boost.Beast's HTTP messages.
#include "server/web/request_reader.h"

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <sstream>

namespace fieldcast::web {

namespace {

namespace http = boost::beast::http;
using Message = http::request<http::string_body>;

constexpr unsigned kVersion = 11; // HTTP/1.1

tl::unexpected<Answer> refuse(int status, const std::string& problem) {
    return tl::unexpected(Answer{.status = status, .body = problem + "\n"});
}

tl::unexpected<Answer> refuse(const boost::system::error_code& error) {
    const bool is_body_too_large = error == http::error::body_limit;
    return refuse(is_body_too_large ? 413 : 400, "malformed request: " + error.message());
}

/// The parts of a complete request that routes use.
ReadRequest to_request(const Message& message) {
    const std::string target(message.target().data(), message.target().size());
    if (!target.starts_with('/')) {
        return refuse(400, "the target of a request must begin with '/'");
    }
    if (message.count(http::field::authorization) > 1) {
        return refuse(400, "a request must have at most one Authorization header");
    }
    Request request{.method = std::string(message.method_string().data(), message.method_string().size()),
                    .path = target.substr(0, target.find('?')),
                    .authorization = std::nullopt};
    const auto authorization = message.find(http::field::authorization);
    if (authorization != message.end()) {
        request.authorization = std::string(authorization->value().data(), authorization->value().size());
    }
    return request;
}

} // namespace

struct RequestReader::State {
    http::request_parser<http::string_body> parser;
    std::string waiting;    ///< received, but not parsed yet
    std::size_t parsed = 0; ///< parsed bytes so far
    std::size_t most_bytes; ///< limit of a whole request, including the overhead of chunks
};

RequestReader::RequestReader(const Limits& limits) : state_(std::make_unique<State>()) {
    state_->parser.header_limit(static_cast<std::uint32_t>(limits.head_bytes));
    state_->parser.body_limit(limits.body_bytes);
    state_->parser.eager(true);
    state_->most_bytes = limits.head_bytes + limits.body_bytes;
}

RequestReader::~RequestReader() = default;

std::optional<ReadRequest> RequestReader::put(std::string_view bytes) {
    State& state = *state_;
    state.waiting += bytes;
    boost::system::error_code error;
    while (!error && !state.parser.is_done() && !state.waiting.empty()) {
        const std::size_t count = state.parser.put(boost::asio::buffer(state.waiting), error);
        state.waiting.erase(0, count);
        state.parsed += count;
    }
    if (error && error != http::error::need_more) {
        return refuse(error);
    }
    const bool is_done = state.parser.is_done();
    if (state.parsed + (is_done ? 0 : state.waiting.size()) > state.most_bytes) {
        return refuse(413, "a request must have at most " + std::to_string(state.most_bytes) + " bytes");
    }
    return is_done ? std::optional(to_request(state.parser.get())) : std::nullopt;
}

std::string text_of(const Answer& answer, bool is_head) {
    http::response<http::string_body> message(http::int_to_status(static_cast<unsigned>(answer.status)), kVersion);
    message.set(http::field::content_type, answer.content_type);
    message.set("X-Content-Type-Options", "nosniff");
    if (answer.status == 401) {
        message.set(http::field::www_authenticate, "Bearer");
    }
    if (answer.status == 405) {
        message.set(http::field::allow, "GET, HEAD");
    }
    message.keep_alive(false);
    message.content_length(answer.body.size());
    if (!is_head) {
        message.body() = answer.body;
    }
    std::ostringstream text;
    text << message;
    return std::move(text).str();
}

} // namespace fieldcast::web
