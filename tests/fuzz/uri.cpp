// SPDX-License-Identifier: Apache-2.0
#include "core/scene/uri.h"

#include "client/net/access.h"
#include "core/base/host_port.h"
#include "core/base/json_text.h"
#include "core/lightfield/view_grid.h"
#include "tests/fuzz/input.h"

#include <algorithm>

namespace fieldcast::fuzz {

namespace {

void expect_inside(const Decoded<std::string>& path) {
    if (!path) {
        FC_ASSERT(!path.error().message.empty(), "an error says what is wrong");
        return;
    }
    const std::filesystem::path parts(*path);
    FC_ASSERT(parts.is_relative() && std::ranges::find(parts, "..") == parts.end(), "a path stays in its folder");
    const auto again = scene::check_relative_path(*path);
    FC_ASSERT(again && *again == *path, "a path in its shortest form stays as it is");
}

void read_address(const std::string& text) {
    if (const auto address = parse_host_port(text)) {
        FC_ASSERT(address->port >= 0 && address->port <= 65535, "ports have 16 bits");
        FC_ASSERT(parse_host_port(to_text(*address)) == address, "an address survives writing and reading");
    }
    client::net::Access access;
    is_refused([&] { client::net::without_scheme(text, access); });
}

} // namespace

void uri(Bytes input) {
    const std::string text(as_text(input));
    if (scene::is_data_uri(text)) {
        const auto bytes = scene::decode_data_uri(text);
        FC_ASSERT(!bytes || bytes->size() <= text.size(), "decoding makes nothing longer");
    }
    expect_inside(scene::check_relative_path(text));
    expect_inside(scene::path_of_uri(text));
    read_address(text);
    static_cast<void>(parse_grid(text));
    FC_ASSERT(json_text(text).size() >= 2, "a JSON text has quotes");
}

} // namespace fieldcast::fuzz
