#include "preprocess/mesh/sniff_format.h"

#include "preprocess/mesh/text_scanner.h"
#include "preprocess/model_format/error.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>

namespace splice {
namespace {

constexpr const char* kSupported =
    "supported are OBJ, PLY, STL, OFF and SMF meshes and LAS, PCD, PLY, XYZ, PTS and PWN point clouds, each also "
    "gzipped";

/// The first token after blank lines, byte order mark and `#` comments.
std::string_view first_token(std::string_view bytes) {
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
    TextScanner text(bytes);
    for (;;) {
        text.skip_spaces();
        if (text.at_end()) return {};
        if (text.peek() != '#') return text.token();
        text.line();
    }
}

bool is_off_header(std::string_view token) {
    for (const std::string_view prefix : {"ST", "C", "N", "4", "n"}) {
        if (token.starts_with(prefix)) token.remove_prefix(prefix.size());
    }
    return token.starts_with("OFF");
}

struct Foreign {
    std::string_view magic, what;
};
constexpr std::array kForeign = {
    Foreign{"glTF", "a glTF binary"},        Foreign{"LASF", "a LAS point cloud"},
    Foreign{"# .PCD", "a PCD point cloud"},  Foreign{"II*\0", "a TIFF image"},
    Foreign{"MM\0*", "a TIFF image"},        Foreign{"\x89PNG", "a PNG image"},
    Foreign{"\xFF\xD8\xFF", "a JPEG image"}, Foreign{"PK\x03\x04", "a ZIP archive"},
    Foreign{"ISO-10303-21", "a STEP file"},  Foreign{"Kaydara FBX", "an FBX file"},
    Foreign{"\xFE\xFF", "UTF-16 text"},      Foreign{"\xFF\xFE", "UTF-16 text"},
    Foreign{"DRACO", "a Draco stream"},      Foreign{"SPLICE", "a splice model"},
};

void refuse_foreign(std::string_view bytes, const std::string& name) {
    for (const Foreign& foreign : kForeign) {
        if (bytes.starts_with(foreign.magic)) {
            throw InputError(name, "", "is " + std::string(foreign.what) + "; " + kSupported);
        }
    }
}

/// SMF and OBJ share `v` and `f`; these commands only SMF has.
bool has_smf_commands(std::string_view bytes) {
    constexpr std::size_t kEnoughToTell = 65536;
    TextScanner text(bytes.substr(0, kEnoughToTell));
    while (!text.at_end()) {
        const std::string_view command = text.token_on_line();
        text.line();
        if (command == "begin" || command == "bind" || command == "rot" || command == "mmult" || command == "mload") {
            return true;
        }
    }
    return false;
}

bool has_obj_commands(std::string_view bytes) {
    constexpr std::size_t kEnoughToTell = 65536;
    TextScanner text(bytes.substr(0, kEnoughToTell));
    while (!text.at_end()) {
        const std::string_view command = text.token_on_line();
        text.line();
        if (command == "v" || command == "mtllib" || command == "usemtl") return true;
    }
    return false;
}

}  // namespace

bool is_binary_stl(std::string_view bytes) {
    constexpr std::size_t kHeader = 84, kTriangle = 50;
    if (bytes.size() < kHeader) return false;
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof count);
    return bytes.size() == kHeader + kTriangle * std::size_t{count};
}

MeshFormat sniff_format(std::string_view bytes, std::string extension, const std::string& name) {
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (bytes.empty()) throw InputError(name, "", "is empty, expected a mesh");
    refuse_foreign(bytes, name);

    const std::string_view token = first_token(bytes);
    if (token == "ply") return MeshFormat::kPly;
    if (bytes.starts_with("#$SMF")) return MeshFormat::kSmf;
    if (is_off_header(token)) return MeshFormat::kOff;
    if (is_binary_stl(bytes)) return MeshFormat::kStl;
    if (token == "solid" && extension != ".obj" && extension != ".smf") return MeshFormat::kStl;

    if (extension == ".obj") return MeshFormat::kObj;
    if (extension == ".smf") return MeshFormat::kSmf;
    if (extension == ".stl") return MeshFormat::kStl;
    if (extension == ".ply") return MeshFormat::kPly;
    if (extension == ".off") return MeshFormat::kOff;
    if (has_smf_commands(bytes)) return MeshFormat::kSmf;
    if (has_obj_commands(bytes)) return MeshFormat::kObj;
    throw InputError(name, "", std::string("is no mesh that can be read; ") + kSupported);
}

}  // namespace splice
