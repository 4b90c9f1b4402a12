#include "preprocess/mesh/obj_materials.h"
#include "tests/fuzz/fuzz_mesh.h"

using namespace splice;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return fuzz::run(data, size, [](std::string_view bytes) {
        const CompanionFiles none;
        SourceMesh materials_only;
        ObjMaterials(none).parse_library(bytes, materials_only);
        return parse_obj(bytes, "input", none);
    });
}
