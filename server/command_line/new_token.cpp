// SPDX-License-Identifier: Apache-2.0
#include "server/command_line/new_token.h"

#include "core/base/error.h"
#include "server/access/token_list.h"

namespace fieldcast::command_line {

std::string new_token_text(const std::string& name, const std::string& role_word) {
    const auto role = access::parse_role(role_word);
    if (!access::is_token_name(name)) {
        throw UserError("--make-token: a name has 1 to 64 letters, digits, '.', '_' or '-'");
    }
    if (!role) {
        throw UserError("--make-token: a role is view, steer or admin");
    }
    const std::string token = access::make_token();
    const access::Identity identity{.name = name, .role = *role, .hash = access::hash_token(token)};
    return "# For the client: the file of --token-file, or FIELDCAST_TOKEN. It is kept nowhere else.\n" + token +
           "\n# For the server: a line of the file of --tokens.\n" + access::token_line(identity) + "\n";
}

} // namespace fieldcast::command_line
