#include "preprocess/cloud/read_point_cloud.h"

#include "preprocess/cloud/cloud_formats.h"
#include "preprocess/cloud/number_lines.h"
#include "preprocess/mesh/ply_header.h"
#include "preprocess/mesh/text_scanner.h"
#include "preprocess/model_format/error.h"

#include <algorithm>
#include <array>

namespace splice {
namespace {

enum class CloudFormat { kNone, kPly, kText, kPcd, kLas };

bool is_ply_without_faces(const SourceFile& file) {
    try {
        bool vertices = false;
        for (const PlyElement& element : parse_ply_header(file.bytes, file.name).elements) {
            const bool faces = element.name == "face" || element.name == "tristrips";
            if (faces && element.count > 0) return false;
            vertices = vertices || (element.name == "vertex" && element.count > 0);
        }
        return vertices;
    } catch (const InputError&) {
        return false;  // the mesh reader says why
    }
}

// The first line that is neither empty nor a comment nor a heading nor a count has three numbers or more.
bool has_lines_of_numbers(std::string_view bytes) {
    constexpr std::size_t kEnoughToTell = 4096;
    TextScanner text(bytes.substr(0, kEnoughToTell));
    std::vector<double> numbers;
    while (!text.at_end()) {
        const std::string_view line = trimmed(text.line());
        numbers.clear();
        const bool clean = numbers_of_line(line, 3, numbers);
        if (numbers.size() >= 3) return true;
        if (!clean || numbers.size() > 1) return false;
    }
    return false;
}

CloudFormat format_of(const SourceFile& file) {
    const std::string_view bytes = file.bytes;
    if (bytes.starts_with("LASF")) return CloudFormat::kLas;
    if (bytes.starts_with("# .PCD") || file.extension == ".pcd") return CloudFormat::kPcd;
    if (bytes.starts_with("ply")) return is_ply_without_faces(file) ? CloudFormat::kPly : CloudFormat::kNone;
    constexpr std::array kText = {".xyz", ".xyzn", ".xyzrgb", ".pts", ".pwn", ".asc", ".csv", ".txt"};
    constexpr std::array kMesh = {".obj", ".off", ".stl", ".smf", ".ply"};
    const auto is_one_of = [&](const auto& endings) {
        return std::any_of(endings.begin(), endings.end(), [&](const char* e) { return file.extension == e; });
    };
    if (is_one_of(kText) && bytes.find('\0') == std::string_view::npos) return CloudFormat::kText;
    if (!is_one_of(kMesh) && has_lines_of_numbers(bytes)) return CloudFormat::kText;
    return CloudFormat::kNone;
}

}  // namespace

bool is_point_cloud(const SourceFile& file) {
    return format_of(file) != CloudFormat::kNone;
}

PointCloud parse_point_cloud(const SourceFile& file) {
    PointCloud cloud;
    switch (format_of(file)) {
        case CloudFormat::kPly:
            cloud = parse_ply_cloud(file.bytes, file.name);
            break;
        case CloudFormat::kText:
            cloud = parse_text_cloud(file.bytes, file.extension, file.name);
            break;
        case CloudFormat::kPcd:
            cloud = parse_pcd(file.bytes, file.name);
            break;
        case CloudFormat::kLas:
            cloud = parse_las(file.bytes, file.name);
            break;
        case CloudFormat::kNone:
            throw InputError(file.name, "", "is no point cloud");
    }
    if (cloud.offsets.empty()) {
        throw InputError(file.name, "",
                         cloud.source_points == 0 ? "has no points"
                                                  : "none of its " + std::to_string(cloud.source_points) +
                                                        " points has finite coordinates and is not withheld");
    }
    return cloud;
}

}  // namespace splice
