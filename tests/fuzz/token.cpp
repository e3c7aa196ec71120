// SPDX-License-Identifier: Apache-2.0
// A server's list of tokens, and a client's file with one.
#include "server/access/token_list.h"

#include "core/base/bearer_token.h"
#include "core/base/error.h"
#include "tests/fuzz/input.h"

#include <algorithm>

namespace fieldcast::fuzz {

namespace {

void read_list(std::string_view text) {
    FC_ASSERT(!access::TokenList::parse(text, "tokens").find(text), "no text is a token of its own file");
}

void read_token(Bytes input) {
    const std::string token = read_bearer_token(scratch_file("token.txt", input), "", "--token-file");
    const auto is_visible = [](char c) { return c > ' ' && c < 0x7F; };
    FC_ASSERT(!token.empty() && std::ranges::all_of(token, is_visible), "tokens go into a header as they are");
}

} // namespace

void token(Bytes input) {
    is_refused([&] { read_list(as_text(input)); });
    is_refused([&] { read_token(input); });
}

} // namespace fieldcast::fuzz
