// SPDX-License-Identifier: Apache-2.0
// libjpeg reports errors by calling a function that must not return. It jumps back to where the call into the library
// was made; no object with a destructor lives in a function that is jumped out of.
#include "core/codec/jpeg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdio> // jpeglib.h needs FILE
#include <cstdlib>

#include <jpeglib.h>

namespace fieldcast::codec {

namespace {

struct ErrorHandler {
    jpeg_error_mgr library{}; ///< first: the library hands its address around
    std::jmp_buf jump{};
    std::array<char, JMSG_LENGTH_MAX> message{};

    ErrorHandler() {
        jpeg_std_error(&library);
        library.error_exit = [](j_common_ptr info) {
            auto* const self = reinterpret_cast<ErrorHandler*>(info->err);
            self->library.format_message(info, self->message.data());
            std::longjmp(self->jump, 1);
        };
        library.output_message = [](j_common_ptr) {}; // warnings are counted
    }
};

struct Compressor {
    ErrorHandler errors;
    jpeg_compress_struct info{};
    unsigned char* file = nullptr;
    unsigned long file_bytes = 0;

    Compressor() = default;
    Compressor(const Compressor&) = delete;
    Compressor& operator=(const Compressor&) = delete;
    ~Compressor() {
        jpeg_destroy_compress(&info);
        std::free(file);
    }
};

struct Decompressor {
    ErrorHandler errors;
    jpeg_decompress_struct info{};
    const char* refusal = nullptr; ///< why a file that the library could read is refused

    Decompressor() = default;
    Decompressor(const Decompressor&) = delete;
    Decompressor& operator=(const Decompressor&) = delete;
    ~Decompressor() { jpeg_destroy_decompress(&info); }
};

void set_table(jpeg_compress_struct& info, int table, double step, double growth) {
    std::array<unsigned, DCTSIZE2> steps{};
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const double frequency = std::hypot(static_cast<double>(i / DCTSIZE), static_cast<double>(i % DCTSIZE));
        steps[i] = static_cast<unsigned>(std::max(1.0, std::round(step * (1.0 + growth * frequency))));
    }
    jpeg_add_quant_table(&info, table, steps.data(), 100, TRUE); // TRUE: at most 255, as baseline decoders want
}

void set_quality(jpeg_compress_struct& info, JpegQuality quality) {
    const double q = std::clamp<int>(quality.quality, 1, 100);
    const double scale = q < 50.0 ? 50.0 / q : 2.0 - 0.02 * q;
    const double step = std::max(1.0, quality.step_at_quality_50 * scale);
    set_table(info, 0, step, quality.step_growth);
    set_table(info, 1, step * quality.chroma_coarseness, quality.step_growth);
    for (int c = 0; c < info.num_components; ++c) {
        info.comp_info[c].h_samp_factor = info.comp_info[c].v_samp_factor = 1;
    }
    info.optimize_coding = TRUE;
    info.dct_method = JDCT_ISLOW;
}

bool compress(Compressor& c, const std::byte* rgb, RgbSize size, JpegQuality quality) {
    c.info.err = &c.errors.library;
    if (setjmp(c.errors.jump) != 0) {
        return false;
    }
    jpeg_create_compress(&c.info);
    jpeg_mem_dest(&c.info, &c.file, &c.file_bytes);
    c.info.image_width = size.width_px;
    c.info.image_height = size.row_count;
    c.info.input_components = 3;
    c.info.in_color_space = JCS_RGB;
    jpeg_set_defaults(&c.info);
    set_quality(c.info, quality);
    jpeg_start_compress(&c.info, TRUE);
    while (c.info.next_scanline < c.info.image_height) {
        const std::byte* row = rgb + std::size_t{3} * size.width_px * c.info.next_scanline;
        auto* samples = const_cast<JSAMPROW>(reinterpret_cast<const JSAMPLE*>(row)); // is only read
        jpeg_write_scanlines(&c.info, &samples, 1);
    }
    jpeg_finish_compress(&c.info);
    return true;
}

/// Reason why a file with this header is refused; null if it is accepted.
const char* problem_of(jpeg_decompress_struct& info, RgbSize size) {
    if (info.image_width != size.width_px || info.image_height != size.row_count) {
        return "another size than the strip";
    }
    if (info.num_components != 3 || info.jpeg_color_space != JCS_YCbCr || info.data_precision != 8) {
        return "not three components of 8 bits, Y, Cb, Cr";
    }
    for (int c = 0; c < 3; ++c) {
        if (info.comp_info[c].h_samp_factor != 1 || info.comp_info[c].v_samp_factor != 1) {
            return "components are subsampled";
        }
    }
    if (info.progressive_mode != FALSE || info.arith_code != FALSE || jpeg_has_multiple_scans(&info) != FALSE) {
        return "not baseline in one scan";
    }
    return nullptr;
}

bool decompress(Decompressor& d, const std::byte* file, std::size_t file_bytes, RgbSize size, std::byte* rgb) {
    d.info.err = &d.errors.library;
    if (setjmp(d.errors.jump) != 0) {
        d.refusal = d.errors.message.data();
        return false;
    }
    jpeg_create_decompress(&d.info);
    jpeg_mem_src(&d.info, reinterpret_cast<const unsigned char*>(file), static_cast<unsigned long>(file_bytes));
    jpeg_read_header(&d.info, TRUE);
    d.refusal = problem_of(d.info, size);
    if (d.refusal != nullptr) {
        return false;
    }
    d.info.out_color_space = JCS_RGB;
    d.info.dct_method = JDCT_ISLOW;
    jpeg_start_decompress(&d.info);
    while (d.info.output_scanline < d.info.output_height) {
        auto* row = reinterpret_cast<JSAMPLE*>(rgb + std::size_t{3} * size.width_px * d.info.output_scanline);
        jpeg_read_scanlines(&d.info, &row, 1);
    }
    jpeg_finish_decompress(&d.info);
    if (d.errors.library.num_warnings != 0) {
        d.refusal = "damaged";
    } else if (d.info.src->bytes_in_buffer != 0) {
        d.refusal = "bytes after the end";
    }
    return d.refusal == nullptr;
}

} // namespace

std::vector<std::byte> encode_jpeg(std::span<const std::byte> rgb, RgbSize size, JpegQuality quality) {
    FC_ASSERT(rgb.size() == size.bytes() && !rgb.empty(), "rows of another size");
    Compressor compressor;
    if (!compress(compressor, rgb.data(), size, quality)) {
        throw std::runtime_error(std::string("libjpeg: ") + compressor.errors.message.data());
    }
    const auto file = std::as_bytes(std::span(compressor.file, compressor.file_bytes));
    return {file.begin(), file.end()};
}

Decoded<void> decode_jpeg(std::span<const std::byte> file, RgbSize size, std::span<std::byte> rgb) {
    FC_ASSERT(rgb.size() == size.bytes() && !rgb.empty(), "rows of another size");
    Decompressor decompressor;
    if (!decompress(decompressor, file.data(), file.size(), size, rgb.data())) {
        return decode_error(std::string("strip: JPEG: ") + decompressor.refusal);
    }
    return {};
}

} // namespace fieldcast::codec
