// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace fieldcast::service {

/// Redirects gRPC's own messages to this program's log for the whole process. At most 20 lines at once and one per
/// second on average are written, so that callers with failing handshakes cannot fill the disk.
void log_transport();

} // namespace fieldcast::service
