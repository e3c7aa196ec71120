// SPDX-License-Identifier: Apache-2.0
// `fieldcast-bench report`: the report of `quality` from the folder of `quality --out`, including FLIP if it was added.
#include "bench/commands.h"
#include "bench/pages/quality_page.h"
#include "core/base/error.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace fieldcast::bench {

namespace {

using Json = nlohmann::ordered_json;

/// The last picture of each row, and its reference, as `quality` itself shows them.
ShownPictures read_pictures(const std::filesystem::path& folder, const Json& result) {
    const Json& last = result.at("pictures").back();
    const auto frame = last.at("frame").get<std::uint32_t>();
    const auto row = last.at("row").get<std::uint32_t>();
    const auto col = last.at("col").get<std::uint32_t>();
    ShownPictures shown{{frame, lattice_position(ViewGrid{}, row, col)}, {}};
    const auto add = [&](const std::string& name, const std::string& file) {
        shown.pictures.push_back({name, image::read_rgb_f32((folder / file).string() + ".exr", {})});
    };
    for (const Json& picture : result["pictures"]) {
        if (picture.at("frame") == frame && picture.at("row") == row && picture.at("col") == col) {
            add(picture.at("input").get<std::string>(), picture.at("file").get<std::string>());
        }
    }
    add(kReferenceName, last.at("reference").get<std::string>());
    return shown;
}

void run_report(const std::filesystem::path& folder, const std::string& html) {
    const std::filesystem::path file = folder / "quality.json";
    std::ifstream stream(file);
    try {
        const Json result = Json::parse(stream);
        quality_page(result, read_pictures(folder, result)).write(html);
    } catch (const Json::exception& error) {
        throw UserError(file.string() + ": not a result of `quality --out`: " + error.what());
    }
}

} // namespace

void add_report_command(CLI::App& app) {
    auto folder = std::make_shared<std::string>();
    auto html = std::make_shared<std::string>();
    CLI::App* command = app.add_subcommand("report", "Report of `quality` from its folder, including FLIP.");
    command->add_option("folder", *folder, "Folder that `quality --out FOLDER` wrote.")->required();
    command->add_option("--html", *html, "HTML file to write.")->required();
    command->callback([folder, html] { run_report(*folder, *html); });
}

} // namespace fieldcast::bench
