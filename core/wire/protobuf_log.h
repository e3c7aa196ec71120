// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace fieldcast::wire {

/// Redirects the log of the protobuf library to ours, at level debug. Otherwise the library would write to standard
/// error, and peers can cause any number of its messages. Applies to the whole process; may be called again.
void take_protobuf_log();

} // namespace fieldcast::wire
