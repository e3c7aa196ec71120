// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "client/load/load_result.h"

#include <filesystem>

namespace fieldcast::client::load {

// Files appear complete or not at all. The functions throw UserError if a file cannot be written.

void write_json(const LoadResult& result, const std::filesystem::path& file);
void write_html(const LoadResult& result, const std::filesystem::path& file);

/// GROUP.STAGE.hgrm for every stage that has values; characters of the group's name other than letters, digits, dots
/// and dashes become underscores.
void write_hgrm(const LoadResult& result, const std::filesystem::path& folder);

} // namespace fieldcast::client::load
