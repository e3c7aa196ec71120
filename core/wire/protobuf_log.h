// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace fieldcast::wire {

/// Sends what the protobuf library says to our log, at level debug: peers make it speak as often as they like, and it
/// would write straight to standard error. For the whole process; may be called again.
void take_protobuf_log();

} // namespace fieldcast::wire
