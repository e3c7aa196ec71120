// SPDX-License-Identifier: Apache-2.0
#include "client/load/result_files.h"

#include "core/base/error.h"
#include "core/image/atomic_file.h"

#include <algorithm>
#include <span>
#include <system_error>

namespace fieldcast::client::load {
namespace {

void write(const std::filesystem::path& file, const std::string& text) {
    try {
        image::write_file_atomically(file, std::as_bytes(std::span(text)));
    } catch (const std::system_error& error) {
        throw UserError(file.string() + ": cannot be written: " + error.code().message());
    }
}

std::string as_file_name(std::string name) {
    std::ranges::replace_if(
        name,
        [](char c) {
            const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
            return !is_letter && !(c >= '0' && c <= '9') && c != '-' && c != '.';
        },
        '_');
    return name;
}

} // namespace

void write_json(const LoadResult& result, const std::filesystem::path& file) {
    write(file, to_json(result));
}

void write_html(const LoadResult& result, const std::filesystem::path& file) {
    write(file, to_html(result));
}

void write_hgrm(const LoadResult& result, const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        throw UserError(folder.string() + ": cannot be made: " + error.message());
    }
    for (const GroupResult& group : result.groups) {
        for (std::size_t i = 0; i < kStageCount; ++i) {
            if (group.tally.stages[i].count() > 0) {
                write(folder / (as_file_name(group.group.name) + "." + std::string(kStages[i].name) + ".hgrm"),
                      group.tally.stages[i].to_hgrm());
            }
        }
    }
}

} // namespace fieldcast::client::load
