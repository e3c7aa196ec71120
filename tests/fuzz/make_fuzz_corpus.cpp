// SPDX-License-Identifier: Apache-2.0
// Usage: make_fuzz_corpus FOLDER. Writes the inputs of binary targets that are made from our own messages and files;
// the others in corpus/ were written by hand or found by libFuzzer.
#include "core/scene/bundle.h"
#include "server/recording/record.h"
#include "server/session/server_session.h"
#include "tests/fuzz/input.h"
#include "tests/scene/draco_builder.h"
#include "tests/server/synthetic.h"
#include "tests/server/synthetic_recording.h"

#include <draco/compression/config/compression_shared.h>
#include <fstream>
#include <tuple>

namespace {

using namespace fieldcast;
using namespace std::chrono_literals;
namespace fs = std::filesystem;

void write(const fs::path& file, std::string_view bytes) {
    fs::create_directories(file.parent_path());
    std::ofstream stream(file, std::ios::binary);
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

v1::Configure configure(v1::DeliveryMode mode, v1::Codec codec) {
    v1::Configure wanted;
    wanted.set_request_id(1);
    wanted.add_modes(mode);
    wanted.mutable_grid()->set_rows(1);
    wanted.mutable_grid()->set_cols(2);
    wanted.set_view_width_px(16);
    wanted.set_view_height_px(9);
    wanted.set_planes(v1::PLANE_SET_WITH_G_BUFFER);
    wanted.set_keeps_key_frames(true);
    for (const auto semantic : {v1::PLANE_SEMANTIC_COLOUR, v1::PLANE_SEMANTIC_DIFFUSE, v1::PLANE_SEMANTIC_SPECULAR}) {
        v1::CodecPreference& preference = *wanted.add_codecs();
        preference.set_semantic(semantic);
        preference.add_codecs(codec);
        preference.add_codecs(v1::CODEC_RAW);
    }
    return wanted;
}

/// What a client sends, and what a server answers.
struct Record {
    std::string steps;    ///< input of client_message
    std::string messages; ///< input of server_message
    std::string chunks;   ///< input of frame
};

/// Two frames of a session, the second of which repeats the first.
class Recording {
public:
    Recording() {
        info_.source_width_px = 16;
        info_.source_height_px = 9;
        feed_ = std::make_shared<feed::Feed>(info_);
    }

    Record run(const v1::Configure& wanted) {
        session::ServerSession session(
            {feed_}, {}, [&](const feed::FramePtr& frame) { session_->on_frame(frame, now_); }, now_);
        session_ = &session;
        record_.messages = wanted.modes(0) == v1::DELIVERY_MODE_SCENE ? '\1' : '\0';
        v1::ClientMessage message;
        *message.mutable_configure() = wanted;
        send(message);
        for (const std::uint64_t frame_id : {1, 2}) {
            record_.steps += '\5'; // a frame, 20 ms later
            now_ += 20ms;
            feed_->publish(test::synthetic_frame(info_, feed_->demand(now_), frame_id, pool_, 1), now_);
            drain();
            message.mutable_frame_ack()->set_frame_id(frame_id);
            message.mutable_frame_ack()->set_epoch(1);
            send(message);
        }
        message.mutable_time_sync()->set_client_send_ns(1'000'000'000);
        send(message);
        return record_;
    }

private:
    void send(const v1::ClientMessage& message) {
        record_.steps += '\0' + fuzz::as_piece(message.SerializeAsString());
        session_->on_message(message, now_);
        drain();
    }

    void drain() {
        while (const auto chunk = session_->next(now_)) {
            record_.messages += fuzz::as_piece(wire::joined(*chunk));
            v1::ServerMessage message;
            if (message.ParseFromString(wire::joined(*chunk)) && message.has_frame_chunk()) {
                record_.chunks += fuzz::as_piece(message.frame_chunk().SerializeAsString());
            }
        }
    }

    feed::ChannelInfo info_ = test::synthetic_info();
    std::shared_ptr<feed::Feed> feed_;
    WorkerPool pool_{1};
    session::TimePoint now_{1h};
    session::ServerSession* session_ = nullptr;
    Record record_;
};

void write_sessions(const fs::path& folder) {
    struct Kind {
        const char* name;
        v1::DeliveryMode mode;
        v1::Codec codec;
    };
    for (const Kind& kind : {Kind{"views_zstd", v1::DELIVERY_MODE_VIEWS, v1::CODEC_ZSTD_FILTERED},
                             Kind{"views_jpeg", v1::DELIVERY_MODE_VIEWS, v1::CODEC_JPEG},
                             Kind{"views_h264", v1::DELIVERY_MODE_VIEWS, v1::CODEC_H264},
                             Kind{"scene_raw", v1::DELIVERY_MODE_SCENE, v1::CODEC_RAW},
                             Kind{"scene_jpeg", v1::DELIVERY_MODE_SCENE, v1::CODEC_JPEG}}) {
        const Record record = Recording().run(configure(kind.mode, kind.codec));
        write(folder / "client_message" / kind.name, record.steps);
        write(folder / "server_message" / kind.name, record.messages);
        write(folder / "frame" / kind.name, record.chunks);
    }
}

/// A recording as the target takes it apart: records without their heads, and without the index.
std::string records_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::uint64_t file_bytes = fs::file_size(file);
    std::string records;
    for (std::uint64_t offset = recording::kMagic.size();;) {
        const auto head = recording::read_head(stream, offset, file_bytes);
        if (!head || head->kind == recording::RecordKind::kIndex) {
            return records;
        }
        const auto content = recording::read_content(stream, offset, *head);
        records += static_cast<char>(head->kind) + fuzz::as_piece(fuzz::as_text(*content));
        offset += recording::kRecordHeadBytes + content->size();
    }
}

void write_recordings(const fs::path& folder) {
    feed::ChannelInfo info = test::synthetic_info("hall");
    info.source_width_px = 16;
    info.source_height_px = 9;
    info.bundle = std::make_shared<const std::vector<std::byte>>(40);
    struct Kind {
        const char* name;
        std::vector<std::string> forms;
    };
    const scene::TempFolder files;
    const fs::path file = files.write("a.fcrec", std::string());
    for (const Kind& kind : {Kind{"views", {"views:1x2", "views:2x2:8x4:jpeg:50"}}, Kind{"planes", {"illumination:jpeg"}},
                             Kind{"both", {"views:1x1:raw", "g-buffer"}}}) {
        test::write_synthetic_recording(file, kind.forms, 2, info);
        write(folder / "recording" / kind.name, '\1' + records_of(file));
        write(folder / "recording" / (std::string(kind.name) + "_unfinished"), '\2' + records_of(file));
    }
    std::ifstream whole(file, std::ios::binary);
    write(folder / "recording/file", '\0' + std::string(std::istreambuf_iterator<char>(whole), {}));
}

/// A triangle with material, texture, light, camera and animation.
scene::GltfBuilder scene_with_everything() {
    scene::GltfBuilder builder;
    builder.add_triangle();
    const int texture = builder.add_texture();
    builder.add("materials", {{"normalTexture", {{"index", texture}}}, {"emissiveFactor", {1, 1, 1}}});
    builder.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
    builder.add_node({{"camera", 0}, {"name", "LightField"}, {"extras", {{"fieldcast", {{"spacing_m", 0.02}}}}}});
    builder.json["extensionsUsed"] = {"KHR_lights_punctual"};
    builder.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", nlohmann::json::object()}, {"intensity", 3}}};
    const int lamp = builder.add_node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const int times = builder.add_floats({0.0F, 1.0F}, "SCALAR");
    const int values = builder.add_floats({0.0F, 0.0F, 0.0F, 1.0F, 2.0F, 3.0F}, "VEC3");
    builder.add("animations",
                {{"samplers", {{{"input", times}, {"output", values}, {"interpolation", "LINEAR"}}}},
                 {"channels", {{{"sampler", 0}, {"target", {{"node", lamp}, {"path", "translation"}}}}}}});
    return builder;
}

void write_scenes(const fs::path& folder) {
    const scene::GltfBuilder everything = scene_with_everything();
    static_cast<void>(everything.load()); // throws if it is refused: then it would be of little use
    write(folder / "gltf/everything.gltf", everything.gltf());
    write(folder / "gltf/everything.glb", fuzz::as_text(everything.glb()));
    scene::GltfBuilder triangle;
    triangle.add_triangle();
    write(folder / "gltf/triangle.glb", fuzz::as_text(triangle.glb()));
    const auto sheet = scene::draco_mesh(scene::draco_sheet(2));
    for (const auto& [name, method, speed] : {std::tuple("draco_valence.glb", draco::MESH_EDGEBREAKER_ENCODING, 0),
                                              std::tuple("draco_edgebreaker.glb", draco::MESH_EDGEBREAKER_ENCODING, 5),
                                              std::tuple("draco_sequential.glb", draco::MESH_SEQUENTIAL_ENCODING, 5)}) {
        const scene::DracoBuilder compressed(scene::draco_encode(*sheet, method, speed));
        static_cast<void>(compressed.load());
        write(folder / "gltf" / name, fuzz::as_text(compressed.glb()));
    }

    const scene::TempFolder files;
    triangle.add("materials", {{"normalTexture", {{"index", 0}}}});
    triangle.add("textures", {{"source", 0}});
    triangle.add("images", {{"uri", "maps/n.png"}});
    triangle.json["buffers"] = {{{"byteLength", triangle.binary.size()}, {"uri", "data.bin"}}};
    files.write("data.bin", triangle.binary);
    files.write("maps/n.png", scene::small_png(2, 2));
    const fs::path main = files.write("scene.gltf", triangle.gltf());
    scene::LoadOptions options;
    options.environment = files.write("sky.hdr", std::string("not looked at when it is unpacked"));
    write(folder / "bundle/environment", fuzz::as_text(scene::make_bundle(main, options)));
    write(folder / "bundle/files", fuzz::as_text(scene::make_bundle(main, {})));
    const fs::path tiny = files.write("tiny.gltf", std::string(R"({"asset":{"version":"2.0"}})"));
    write(folder / "bundle/tiny", fuzz::as_text(scene::make_bundle(tiny, {})));
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        return 2;
    }
    write_sessions(argv[1]);
    write_recordings(argv[1]);
    write_scenes(argv[1]);
    return 0;
}
