// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace fieldcast::service {

/// From now on what gRPC itself reports goes to our log, at most 20 lines at once and one per second on average:
/// strangers who cannot shake hands must not fill the disk. For the whole process.
void log_transport();

} // namespace fieldcast::service
