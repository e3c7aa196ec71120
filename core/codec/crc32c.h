// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace fieldcast::codec {

/// CRC-32C (Castagnoli: reflected polynomial 0x82F63B78, initial value and final xor 0xFFFFFFFF).
/// `previous` continues from the CRC of the bytes before; 0 starts anew.
std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t previous = 0);

/// CRC of two byte strings one after the other, from their CRCs. Constant time: used to give each client the CRC of
/// its own selection of shared strips.
std::uint32_t crc32c_combine(std::uint32_t first, std::uint32_t second, std::uint64_t second_bytes);

} // namespace fieldcast::codec
