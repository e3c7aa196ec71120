// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/timing/frame_timing.h"

#include <string>

// One row per frame and client. CSV has all columns of `csv_header`, `stages` as "name=ms;name=ms"; JSON lines have the
// same names, `stages` as an object. Times that are unknown are empty or null.
namespace fieldcast::timing {

std::string csv_header(); ///< with a line break, as the rows
std::string to_csv(const DeliveredFrame& frame);
std::string to_json_line(const DeliveredFrame& frame);

} // namespace fieldcast::timing
