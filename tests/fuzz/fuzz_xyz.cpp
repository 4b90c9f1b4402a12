#include "tests/fuzz/fuzz_cloud.h"

using namespace splice;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    for (const char* extension : {".xyz", ".pts", ".pwn"})
        fuzz::run_cloud(data, size,
                        [&](std::string_view bytes) { return parse_text_cloud(bytes, extension, "input"); });
    return 0;
}
