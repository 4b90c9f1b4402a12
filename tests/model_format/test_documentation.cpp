// docs/model_format.md promises "byte by byte": its tables are held to the structs.
#include "preprocess/model_format/section_layout.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <map>
#include <regex>

using namespace splice;

namespace {

// The size that a field table's last row reaches, for each "### ..." heading of the page.
std::map<std::string, std::size_t> documented_sizes() {
    static const std::regex heading(R"(^### (?:\d+ )?(.*))");
    static const std::regex row(R"(^\| (\d+) \| (\d+) \| [^|]*\|[^|]*\|$)");
    std::ifstream page(test::source_file("docs/model_format.md"));
    std::map<std::string, std::size_t> sizes;
    std::string section;
    std::smatch match;
    for (std::string line; std::getline(page, line);) {
        if (std::regex_match(line, match, heading)) section = match[1];
        if (!std::regex_match(line, match, row)) continue;
        const std::size_t offset = std::stoul(match[1]);
        INFO(section << ", offset " << offset);
        CHECK(offset == sizes[section]);  // rows follow each other without gaps
        sizes[section] = offset + std::stoul(match[2]);
    }
    return sizes;
}

}  // namespace

TEST_CASE("the documented fields fill the structs") {
    const auto sizes = documented_sizes();
    CHECK(sizes.at("Header") == sizeof(format::FileHeader));
    CHECK(sizes.at("Section table entry") == sizeof(format::SectionEntry));
    CHECK(sizes.at("Model info") == sizeof(format::ModelInfo));
    CHECK(sizes.at("Vertices") == sizeof(format::Vertex));
    CHECK(sizes.at("Surfels") == sizeof(format::Surfel));
    CHECK(sizes.at("Patches") == sizeof(format::Patch));
    CHECK(sizes.at("Levels of detail") == sizeof(format::Lod));
    CHECK(sizes.at("Octree") == sizeof(format::OctreeNode));
    CHECK(sizes.at("Merge tree") == sizeof(format::MergeNode));
    CHECK(sizes.at("Materials") == sizeof(format::Material));
    CHECK(sizes.at("Textures") == sizeof(format::Texture));
    CHECK(sizes.at("Point tree") == sizeof(format::PackedPointNode));
    CHECK(sizes.at("Packed surfels") == sizeof(format::PackedSurfel));
}

TEST_CASE("the documented sections are the ones that are written") {
    std::ifstream page(test::source_file("docs/model_format.md"));
    const std::string text{std::istreambuf_iterator<char>(page), {}};
    ModelView view;
    format::for_each_section(view, [&]<typename T>(format::SectionKind kind, const char* title, std::span<const T>&) {
        const std::string row = "| " + std::to_string(static_cast<unsigned>(kind)) + " | " + title + " | " +
                                std::to_string(sizeof(T)) + " |";
        INFO(row);
        CHECK(text.find(row) != std::string::npos);
    });
}
