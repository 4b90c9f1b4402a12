#include "tests/fuzz/fuzz_mesh.h"

using namespace splice;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return fuzz::run(data, size, [](std::string_view bytes) { return parse_ply(bytes, "input", CompanionFiles()); });
}
