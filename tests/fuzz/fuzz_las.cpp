#include "tests/fuzz/fuzz_cloud.h"

using namespace splice;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return fuzz::run_cloud(data, size, [](std::string_view bytes) { return parse_las(bytes, "input"); });
}
