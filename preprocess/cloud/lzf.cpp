#include "preprocess/cloud/lzf.h"

#include <cstring>

namespace splice {

// A control byte below 32 says that it + 1 bytes follow as they are. Otherwise its upper three bits are the length of a
// copy less two (7: one more byte is added to it), its lower five and the next byte how far back the copy begins, less
// one. A copy may reach into what it writes.
std::optional<std::string> decompress_lzf(std::string_view stream, std::size_t size) {
    if (size > largest_lzf_output(stream.size())) return std::nullopt;
    std::string output(size, '\0');
    std::size_t in = 0, out = 0;
    const auto byte = [&] { return static_cast<std::size_t>(static_cast<unsigned char>(stream[in++])); };
    while (in < stream.size()) {
        const std::size_t control = byte();
        if (control < 32) {
            const std::size_t length = control + 1;
            if (length > stream.size() - in || length > size - out) return std::nullopt;
            std::memcpy(output.data() + out, stream.data() + in, length);
            in += length;
            out += length;
            continue;
        }
        std::size_t length = (control >> 5) + 2;
        if (length == 9) {
            if (in == stream.size()) return std::nullopt;
            length += byte();
        }
        if (in == stream.size()) return std::nullopt;
        const std::size_t back = ((control & 31) << 8) + byte() + 1;
        if (back > out || length > size - out) return std::nullopt;
        for (; length > 0; --length, ++out)
            output[out] = output[out - back];
    }
    if (out != size) return std::nullopt;
    return output;
}

}  // namespace splice
