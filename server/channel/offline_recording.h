// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/channel/offline.h"
#include "server/channel/record_job.h"

namespace fieldcast::channel {

/// Renders the frames of `job` in order and writes them to a recording. False: `progress` returned true; the
/// frames recorded so far are complete. Throws UserError if the scene is not usable or the file cannot be written.
bool record_offline(const gpu::Device& device, const Settings& settings, const RecordJob& job,
                    const OfflineProgress& progress);

} // namespace fieldcast::channel
