// SPDX-License-Identifier: Apache-2.0
#include "server/recording/recorded_form.h"

#include "core/base/error.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

namespace fieldcast::recording {

namespace {

std::vector<std::string> words_of(const std::string& text) {
    std::vector<std::string> words;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(':', begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return words;
}

/// Reads a plane set, which means mode SCENE, or a delivery mode. False: neither, or a mode that needs a plane set.
bool read_content(const std::string& word, RecordedForm& form) {
    if (const auto set = from_word<PlaneSet>(word)) {
        form.mode = DeliveryMode::kScene;
        form.set = *set;
        return true;
    }
    const auto mode = from_word<DeliveryMode>(word);
    form.mode = mode.value_or(form.mode);
    return mode && !row_of(*mode).planes.empty(); // else a plane set names it
}

/// Codecs that carry at least one of the planes of `form`.
std::vector<Codec> codecs_for(const RecordedForm& form) {
    const std::vector<PlaneSemantic> planes = planes_of(form.mode, form.set, kAll<WarpPlane>);
    std::vector<Codec> codecs(kAll<Codec>.begin(), kAll<Codec>.end());
    std::erase_if(codecs, [&](Codec codec) {
        return std::ranges::none_of(planes, [&](PlaneSemantic plane) { return carries(codec, usual_format(plane)); });
    });
    return codecs;
}

bool read_codec(const std::string& word, RecordedForm& form) {
    const auto codec = from_word<Codec>(word);
    const std::vector<Codec> fitting = codecs_for(form);
    form.codec = codec.value_or(form.codec);
    return codec && std::ranges::find(fitting, *codec) != fitting.end();
}

bool read_quality(const std::string& word, RecordedForm& form) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), form.quality);
    return error == std::errc{} && end == word.data() + word.size() && form.quality >= 1 &&
           form.quality <= kMaxQuality && is_lossy(form.codec);
}

codec::Encoding encoding_of(const RecordedForm& form, const feed::ChannelInfo& channel) {
    const std::uint8_t quality = form.quality != 0 ? form.quality : channel.lossy_quality;
    return {.codec = form.codec, .quality = is_lossy(form.codec) ? quality : std::uint8_t{0}};
}

/// The codec of `form` where it fits; depth, normals and ids stay lossless.
feed::PlaneSelection plane_selection(const RecordedForm& form, const feed::ChannelInfo& channel) {
    constexpr std::array kExtra{WarpPlane::kResidual};
    feed::PlaneSelection selection;
    for (const PlaneSemantic semantic : planes_of(form.mode, form.set, kExtra)) {
        const bool has_codec = is_picture(semantic) && carries(form.codec, usual_format(semantic));
        selection.choices.push_back(
            {.semantic = semantic, .encoding = has_codec ? encoding_of(form, channel) : codec::Encoding{}});
    }
    return selection;
}

} // namespace

std::optional<RecordedForm> parse_form(const std::string& text) {
    const std::vector<std::string> words = words_of(text);
    RecordedForm form;
    if (!read_content(words[0], form)) {
        return std::nullopt;
    }
    std::size_t next = 1;
    if (!is_made_by_client(form.mode) && next < words.size()) {
        if (const auto grid = parse_grid(words[next])) {
            form.grid = grid;
            ++next;
            form.size_px = next < words.size() ? parse_size(words[next]) : std::nullopt;
            next += form.size_px ? 1 : 0;
        }
    }
    if (next < words.size() && read_codec(words[next], form)) {
        ++next;
        if (next < words.size() && read_quality(words[next], form)) {
            ++next;
        }
    }
    return next == words.size() ? std::optional(form) : std::nullopt;
}

std::string form_syntax() {
    std::string others;
    const auto add = [&others](std::string_view word) {
        others += others.empty() ? "" : ", ";
        others += word;
    };
    for (const PlaneSet set : kAll<PlaneSet>) {
        add(word_of(set));
    }
    for (const DeliveryMode mode : kAll<DeliveryMode>) {
        if (is_made_by_client(mode) && !row_of(mode).planes.empty()) {
            add(word_of(mode));
        }
    }
    return "write views[:RxC[:WxH]][:CODEC[:QUALITY]], or " + others + " with [:CODEC[:QUALITY]]; codecs: " +
           alternatives<Codec>();
}

feed::Selection selection_of(const RecordedForm& form, const feed::ChannelInfo& channel) {
    const std::string place = "recording of channel '" + channel.name + "': ";
    if (row_of(form.mode).needs_one_source && channel.source_count != 1) {
        throw UserError(place + std::string(word_of(form.mode)) + " needs one source, the channel has " +
                        std::to_string(channel.source_count));
    }
    if (is_made_by_client(form.mode)) {
        return plane_selection(form, channel);
    }
    ViewGrid grid = form.grid.value_or(channel.largest_grid);
    grid.geometry = channel.largest_grid.geometry;
    const glm::uvec2 source(channel.source_width_px, channel.source_height_px);
    const glm::uvec2 size = form.size_px.value_or(source);
    if (const auto problem = grid_problem(grid)) {
        throw UserError(place + *problem);
    }
    if (size.x == 0 || size.y == 0 || size.x > source.x || size.y > source.y) {
        throw UserError(place + "views of " + std::to_string(size.x) + "x" + std::to_string(size.y) +
                        " pixels asked; 1x1 to " + std::to_string(source.x) + "x" + std::to_string(source.y) +
                        " (the source's) allowed");
    }
    return feed::ViewSelection{.format = {.geometry = grid.geometry,
                                      .fovy_rad = channel.fovy_rad,
                                      .width_px = size.x,
                                      .height_px = size.y,
                                      .encoding = encoding_of(form, channel)},
                           .grid = grid};
}

} // namespace fieldcast::recording
