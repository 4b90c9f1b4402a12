// LZF, the compression of LibLZF (Marc Lehmann), of which PCD files hold one stream.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace splice {

/// The most that `compressed` bytes can stand for: three bytes copy at most 264.
inline std::size_t largest_lzf_output(std::size_t compressed) {
    return compressed * 88;
}

/// Nothing if the stream is damaged or does not stand for exactly `size` bytes.
std::optional<std::string> decompress_lzf(std::string_view stream, std::size_t size);

}  // namespace splice
