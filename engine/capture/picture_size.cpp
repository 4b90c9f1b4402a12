#include "engine/capture/picture_size.h"

#include "preprocess/model_format/error.h"

#include <charconv>
#include <string_view>

namespace splice {

std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& text) {
    const auto fail = [&]() -> std::uint32_t {
        throw UsageError("--size: expected WIDTHxHEIGHT in pixels like 512x512, got \"" + text + "\"");
    };
    const std::size_t cross = text.find('x');
    if (cross == std::string::npos) fail();
    const auto side = [&](std::string_view digits) {
        std::uint32_t value = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        return error == std::errc() && end == digits.data() + digits.size() && value > 0 ? value : fail();
    };
    return {side(std::string_view(text).substr(0, cross)), side(std::string_view(text).substr(cross + 1))};
}

}  // namespace splice
