// SPDX-License-Identifier: Apache-2.0
#include "tests/wire/other_jpeg.h"

#include <array>
#include <cstdio> // jpeglib.h needs FILE
#include <cstdlib>
#include <span>

#include <jpeglib.h>

namespace fieldcast::testing {

namespace {

void set_kind(jpeg_compress_struct& info, JpegKind kind) {
    static const std::array<jpeg_scan_info, 3> kThreeScans{
        jpeg_scan_info{1, {0}, 0, 63, 0, 0}, jpeg_scan_info{1, {1}, 0, 63, 0, 0}, jpeg_scan_info{1, {2}, 0, 63, 0, 0}};
    if (kind == JpegKind::kGrey) {
        jpeg_set_colorspace(&info, JCS_GRAYSCALE);
    } else if (kind == JpegKind::kRgb) {
        jpeg_set_colorspace(&info, JCS_RGB);
    }
    const int luma_factor = kind == JpegKind::kSubsampled ? 2 : 1;
    info.comp_info[0].h_samp_factor = info.comp_info[0].v_samp_factor = luma_factor;
    if (kind == JpegKind::kProgressive) {
        jpeg_simple_progression(&info);
    } else if (kind == JpegKind::kScanPerComponent) {
        info.scan_info = kThreeScans.data();
        info.num_scans = 3;
    } else if (kind == JpegKind::kArithmetic) {
        info.arith_code = TRUE;
    }
}

} // namespace

std::vector<std::byte> other_jpeg(const std::vector<std::byte>& rgb, std::uint32_t width_px, std::uint32_t height_px,
                                  JpegKind kind) {
    jpeg_compress_struct info{};
    jpeg_error_mgr errors{};
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    unsigned char* file = nullptr;
    unsigned long file_bytes = 0;
    jpeg_mem_dest(&info, &file, &file_bytes);
    info.image_width = width_px;
    info.image_height = height_px;
    info.input_components = 3;
    info.in_color_space = JCS_RGB;
    jpeg_set_defaults(&info);
    set_kind(info, kind);
    jpeg_start_compress(&info, TRUE);
    std::vector<JSAMPLE> row(std::size_t{3} * width_px);
    while (info.next_scanline < info.image_height) {
        for (std::size_t i = 0; i < row.size(); ++i) {
            row[i] = std::to_integer<JSAMPLE>(rgb[info.next_scanline * row.size() + i]);
        }
        JSAMPROW rows = row.data();
        jpeg_write_scanlines(&info, &rows, 1);
    }
    jpeg_finish_compress(&info);
    const auto bytes = std::as_bytes(std::span(file, file_bytes));
    std::vector<std::byte> result(bytes.begin(), bytes.end());
    jpeg_destroy_compress(&info);
    std::free(file);
    return result;
}

} // namespace fieldcast::testing
