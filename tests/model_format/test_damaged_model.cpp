// Files that are cut, bent or forged: all must be refused with an InputError, none may be followed out of the file.
#include "preprocess/model_format/checksum.h"
#include "preprocess/model_format/error.h"
#include "preprocess/model_format/model.h"
#include "tests/model_format/small_model.h"

#include <catch2/catch.hpp>

#include <cstring>
#include <functional>
#include <limits>
#include <random>

using namespace splice;
using namespace splice::format;
using test::small_model;

namespace {

// A forger's file: damaged, but with a checksum that fits.
void forge_checksum(std::vector<std::byte>& bytes) {
    FileHeader header;
    std::memcpy(&header, bytes.data(), sizeof(header));
    header.checksum = 0;
    std::memcpy(bytes.data(), &header, sizeof(header));
    Checksum checksum;
    checksum.add(bytes);
    header.checksum = checksum.value();
    std::memcpy(bytes.data(), &header, sizeof(header));
}

std::string refusal(const std::vector<std::byte>& bytes) {
    try {
        parse_model(bytes, "m.splice");
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

// What the reader says of the small model after a change.
std::string refusal_after(const std::function<void(Model&)>& change) {
    Model model = small_model();
    change(model);
    return refusal(serialise_model(view_of(model)));
}

std::string refusal_of_header(const std::function<void(FileHeader&)>& change) {
    std::vector<std::byte> bytes = serialise_model(view_of(small_model()));
    FileHeader header;
    std::memcpy(&header, bytes.data(), sizeof(header));
    change(header);
    std::memcpy(bytes.data(), &header, sizeof(header));
    forge_checksum(bytes);
    return refusal(bytes);
}

std::string refusal_of_entry(std::size_t index, const std::function<void(SectionEntry&)>& change) {
    std::vector<std::byte> bytes = serialise_model(view_of(small_model()));
    std::byte* const place = bytes.data() + sizeof(FileHeader) + index * sizeof(SectionEntry);
    SectionEntry entry;
    std::memcpy(&entry, place, sizeof(entry));
    change(entry);
    std::memcpy(place, &entry, sizeof(entry));
    forge_checksum(bytes);
    return refusal(bytes);
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

using Catch::Matchers::Contains;

}  // namespace

TEST_CASE("a file cut anywhere is refused") {
    const std::vector<std::byte> bytes = serialise_model(view_of(small_model()));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
        INFO(size);
        REQUIRE(refusal(cut) != "accepted");
    }
}

TEST_CASE("a file with something behind it is refused") {
    std::vector<std::byte> bytes = serialise_model(view_of(small_model()));
    bytes.resize(bytes.size() + 64);
    CHECK_THAT(refusal(bytes), Contains("should have"));
}

TEST_CASE("every flipped bit is noticed") {
    std::vector<std::byte> bytes = serialise_model(view_of(small_model()));
    for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
        bytes[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
        if (refusal(bytes) == "accepted") FAIL("bit " << bit);
        bytes[bit / 8] ^= static_cast<std::byte>(1u << (bit % 8));
    }
}

TEST_CASE("a forged checksum does not get a bent header through") {
    CHECK_THAT(refusal_of_header([](FileHeader& h) { h.magic[6] = '\n'; }), Contains("byte 0: not a model file"));
    CHECK_THAT(refusal_of_header([](FileHeader& h) { h.version = kVersion - 1; }),
               Contains("byte 8: format version 5") && Contains("bake the model again"));
    CHECK_THAT(refusal_of_header([](FileHeader& h) { h.section_count = 0xffffffffu; }), Contains("byte 12"));
    CHECK_THAT(refusal_of_header([](FileHeader& h) { h.section_count = 0; }), Contains("byte 12"));
    CHECK_THAT(refusal_of_header([](FileHeader& h) { h.file_bytes = ~0ull; }), Contains("byte 16"));
    CHECK_THAT(refusal_of_header([](FileHeader& h) { h.table_offset = ~0ull; }), Contains("byte 32"));
    CHECK_THAT(refusal_of_header([](FileHeader& h) { h.reserved[2] = 1; }), Contains("reserved"));
}

TEST_CASE("a forged checksum does not get a bent section table through") {
    for (std::size_t i = 0; i < 13; ++i) {
        INFO(i);
        CHECK_THAT(refusal_of_entry(i, [](SectionEntry& e) { e.kind = SectionKind{99}; }), Contains("section kind 99"));
        CHECK_THAT(refusal_of_entry(i, [](SectionEntry& e) { e.stride = 0; }), Contains("0 bytes an element"));
        CHECK_THAT(refusal_of_entry(i, [](SectionEntry& e) { e.offset += 64; }), Contains("section at byte"));
        CHECK_THAT(refusal_of_entry(i, [](SectionEntry& e) { e.offset -= 64; }), Contains("section at byte"));
        CHECK_THAT(refusal_of_entry(i, [](SectionEntry& e) { e.offset = ~0ull - 63; }), Contains("section at byte"));
        CHECK_THAT(refusal_of_entry(i, [](SectionEntry& e) { e.reserved = 1; }), Contains("reserved"));
        CHECK(refusal_of_entry(i, [](SectionEntry& e) { --e.count; }) != "accepted");
        CHECK_THAT(refusal_of_entry(i, [](SectionEntry& e) { e.count = ~0ull; }), Contains("do not fit"));
        // counts whose size in bytes overflows 64 bits to something small
        CHECK(refusal_of_entry(i, [](SectionEntry& e) { e.count = ~0ull / e.stride + 2; }) != "accepted");
    }
}

TEST_CASE("model info that contradicts the tables is refused") {
    CHECK_THAT(refusal_after([](Model& m) { m.info.source_scale = 0; }), Contains("scale"));
    CHECK_THAT(refusal_after([](Model& m) { m.info.source_scale = kNan; }), Contains("scale"));
    CHECK_THAT(refusal_after([](Model& m) { m.info.source_offset[1] = kInfinity; }), Contains("offset"));
    CHECK_THAT(refusal_after([](Model& m) { m.info.bounds_min[2] = kNan; }), Contains("bounds"));
    CHECK_THAT(refusal_after([](Model& m) { m.info.bounds_max[0] = 0.5f; }), Contains("bounds"));
    CHECK_THAT(refusal_after([](Model& m) { m.info.flags = 1u << 31; }), Contains("flags"));
    CHECK_THAT(refusal_after([](Model& m) { m.info.lod_levels = 1; }), Contains("levels"));
    CHECK_THAT(refusal_after([](Model& m) { m.info.source_triangles = 7; }), Contains("source triangles"));
    CHECK_THAT(refusal_after([](Model& m) { m.info.source_triangles = ~0ull; }), Contains("32-bit"));
    CHECK_THAT(refusal_after([](Model& m) { m.info.drawn_triangles = 6; }), Contains("drawn triangles"));
    CHECK_THAT(refusal_after([](Model& m) { m.info.max_surfel_radius = 0.1f; }), Contains("radius"));
    CHECK_THAT(refusal_after([](Model& m) { m.info.median_surfel_radius = -1; }), Contains("radius"));
}

TEST_CASE("vertices and indices that cannot be drawn are refused") {
    CHECK_THAT(refusal_after([](Model& m) { m.vertices[3].position[1] = kNan; }), Contains("position"));
    CHECK_THAT(refusal_after([](Model& m) { m.vertices[3].uv[0] = kInfinity; }), Contains("uv"));
    CHECK_THAT(refusal_after([](Model& m) { m.indices[5] = 8; }), Contains("vertex index 8 of 8"));
    CHECK_THAT(refusal_after([](Model& m) { m.indices.back() = 0xffffffffu; }), Contains("vertex index"));
    CHECK_THAT(refusal_after([](Model& m) { m.vertices.clear(); }), Contains("vertex index"));
}

TEST_CASE("surfels that leave their patch's limits are refused") {
    CHECK_THAT(refusal_after([](Model& m) { m.surfels[0].position[0] = kNan; }), Contains("position"));
    CHECK_THAT(refusal_after([](Model& m) { m.surfels[0].radius = 0xbc00; }), Contains("radius"));
    CHECK_THAT(refusal_after([](Model& m) { m.surfels[0].radius = 0x7e00; }), Contains("radius"));
    CHECK_THAT(refusal_after([](Model& m) { m.surfels[1].extent = 63u << 10; }), Contains("epsilon"));
    CHECK_THAT(refusal_after([](Model& m) { m.surfels[1].patch = 0; }), Contains("names patch 0"));
    CHECK_THAT(refusal_after([](Model& m) { m.surfels.pop_back(); }), Contains("surfels"));
    CHECK_THAT(refusal_after([](Model& m) { m.packed_surfels.resize(2); }), Contains("packed surfels"));
    CHECK_THAT(refusal_after([](Model& m) { m.surfels.push_back(m.surfels[0]); }), Contains("surfels"));
}

TEST_CASE("patches whose ranges or numbers are wrong are refused") {
    const auto patch = [](auto change) { return refusal_after([=](Model& m) { change(m.patches[1]); }); };
    CHECK_THAT(patch([](Patch& p) { p.bounds_max[0] = 2; }), Contains("bounds"));
    CHECK_THAT(patch([](Patch& p) { p.bounds_min[0] = kNan; }), Contains("bounds"));
    CHECK_THAT(patch([](Patch& p) { p.representation = Representation{2}; }), Contains("representation 2"));
    CHECK_THAT(patch([](Patch& p) { p.representation = Representation::kTriangles; }), Contains("surfels"));
    CHECK_THAT(patch([](Patch& p) { p.material = 2; }), Contains("material index 2 of 2"));
    CHECK_THAT(patch([](Patch& p) { p.cone_axis[2] = 0; }), Contains("axis"));
    CHECK_THAT(patch([](Patch& p) { p.cone_axis[0] = kNan; }), Contains("axis"));
    CHECK_THAT(patch([](Patch& p) { p.cone_cos = 1.5f; }), Contains("cosine"));
    CHECK_THAT(patch([](Patch& p) { p.first_surfel = 1; }), Contains("start at 1"));
    CHECK_THAT(patch([](Patch& p) { p.surfel_count = 0xffffffffu; }), Contains("are left"));
    CHECK_THAT(patch([](Patch& p) { p.first_lod = 1; }), Contains("start at 1"));
    CHECK_THAT(patch([](Patch& p) { p.lod_count = 0; }), Contains("levels"));
    CHECK_THAT(patch([](Patch& p) { p.lod_count = 0xffffffffu; }), Contains("are left"));
    CHECK_THAT(patch([](Patch& p) { p.area = -1; }), Contains("area"));
    CHECK_THAT(patch([](Patch& p) { p.max_surfel_radius = kInfinity; }), Contains("radius"));
    CHECK_THAT(patch([](Patch& p) { p.max_surfel_epsilon = kNan; }), Contains("epsilon"));
    CHECK_THAT(patch([](Patch& p) { p.roughness = kNan; }), Contains("roughness"));
    CHECK_THAT(patch([](Patch& p) { p.merge_root = 10; }), Contains("merge root"));
    CHECK_THAT(patch([](Patch& p) { p.reserved = 1; }), Contains("reserved"));
    CHECK(refusal_after([](Model& m) { m.patches.clear(); }) != "accepted");
}

TEST_CASE("levels of detail outside the indices are refused") {
    const auto lod = [](std::size_t i, auto change) { return refusal_after([=](Model& m) { change(m.lods[i]); }); };
    CHECK_THAT(lod(1, [](Lod& l) { l.first_index = ~0ull - 3; }), Contains("leaves"));
    CHECK_THAT(lod(1, [](Lod& l) { l.index_count = 9; }), Contains("leaves"));
    CHECK_THAT(lod(1, [](Lod& l) { l.index_count = 5; }), Contains("whole triangles"));
    CHECK_THAT(lod(1, [](Lod& l) { l.error = kNan; }), Contains("error"));
    CHECK_THAT(lod(0, [](Lod& l) { l.error = 0.5f; }), Contains("error"));
    CHECK_THAT(lod(2, [](Lod& l) { l.first_index = 9; }), Contains("starts at index 9"));
    CHECK_THAT(refusal_after([](Model& m) { m.lods.push_back(m.lods[0]); }), Contains("levels"));
}

TEST_CASE("octrees with cycles, gaps or lies are refused") {
    const auto node = [](std::size_t i, auto change) { return refusal_after([=](Model& m) { change(m.octree[i]); }); };
    CHECK_THAT(node(0, [](OctreeNode& n) { n.first_child = 0; }), Contains("children start at 0"));
    CHECK_THAT(node(0, [](OctreeNode& n) { n.first_child = 2; }), Contains("children start at 2"));
    CHECK_THAT(node(0, [](OctreeNode& n) { n.child_count = 8; }), Contains("beyond"));
    CHECK_THAT(node(0, [](OctreeNode& n) { n.child_count = 0xffffffffu; }), Contains("children"));
    CHECK_THAT(node(0, [](OctreeNode& n) { n.patch_count = 1; }), Contains("root"));
    CHECK_THAT(node(0, [](OctreeNode& n) { n.bounds_max[0] = 0.75f; }), Contains("bounds"));
    CHECK_THAT(node(1, [](OctreeNode& n) { n.first_child = 1; }), Contains("leaf with a child"));
    CHECK_THAT(node(1, [](OctreeNode& n) { n.first_patch = 1; }), Contains("divide"));
    CHECK_THAT(node(1, [](OctreeNode& n) { n.patch_count = 0; }), Contains("divide"));
    CHECK_THAT(refusal_after([](Model& m) {
                   m.octree[0].child_count = 3;
                   m.octree.push_back(m.octree[2]);
                   m.octree[3].first_patch = 2;
                   m.octree[3].patch_count = 0;
               }),
               Contains("without patches"));
    CHECK_THAT(node(2, [](OctreeNode& n) { n.patch_count = 0xffffffffu; }), Contains("divide"));
    CHECK_THAT(node(2, [](OctreeNode& n) { n.bounds_min[0] = 0.75f; }), Contains("bound"));
    CHECK_THAT(node(2, [](OctreeNode& n) { n.first_lod = 1; }), Contains("without levels names one"));
    CHECK_THAT(node(2, [](OctreeNode& n) { n.lod_count = 1; }), Contains("levels start at 0, expected 3"));
    const auto with_level = [&](auto change) {
        return refusal_after([=](Model& m) {
            m.lods.push_back({0, 6, 0.25f});
            m.octree[2].first_lod = 3;
            m.octree[2].lod_count = 1;
            change(m);
        });
    };
    CHECK_THAT(with_level([](Model& m) { m.octree[2].lod_count = 2; }),
               Contains("2 levels in an octree node, 1 are left"));
    CHECK_THAT(with_level([](Model& m) { m.lods.back().index_count = 7; }), Contains("no whole triangles"));
    CHECK_THAT(with_level([](Model& m) { m.lods.back().first_index = 1u << 30; }), Contains("leaves the"));
    // Many levels of the same triangles.
    CHECK_THAT(with_level([](Model& m) {
                   while (m.lods.size() < 40)
                       m.lods.push_back(m.lods.back());
                   m.octree[2].lod_count = 37;
               }),
               Contains("octree nodes' levels have more than"));
    CHECK_THAT(with_level([](Model& m) {
                   std::swap(m.octree[0].lod_count, m.octree[2].lod_count);
                   std::swap(m.octree[0].first_lod, m.octree[2].first_lod);
                   m.materials.push_back(m.materials.front());
                   m.patches[1].material = m.patches[0].material == 0 ? 1 : 0;
               }),
               Contains("several materials"));
    CHECK_THAT(refusal_after([](Model& m) { m.octree.push_back(m.octree[2]); }), Contains("reached"));
    CHECK_THAT(refusal_after([](Model& m) { m.octree.clear(); }), Contains("root"));
}

TEST_CASE("merge trees that are no trees are refused") {
    const auto merge = [](std::size_t i, auto change) {
        return refusal_after([=](Model& m) { change(m.merge_tree[i]); });
    };
    CHECK_THAT(merge(0, [](MergeNode& n) { n.child[0] = 6; }), Contains("before"));
    CHECK_THAT(merge(1, [](MergeNode& n) { n.child[1] = 0xffffffffu; }), Contains("before"));
    CHECK_THAT(merge(1, [](MergeNode& n) { n.child[1] = 2; }), Contains("two parents"));
    CHECK_THAT(merge(3, [](MergeNode& n) { n.child[0] = 0; }), Contains("two parents"));
    CHECK_THAT(merge(2, [](MergeNode& n) { n.cost = kNan; }), Contains("cost"));
    CHECK_THAT(merge(2, [](MergeNode& n) { n.phase = 3; }), Contains("phase"));
}

TEST_CASE("materials and textures outside their tables are refused") {
    CHECK_THAT(refusal_after([](Model& m) { m.materials.clear(); }), Contains("material"));
    CHECK_THAT(refusal_after([](Model& m) { m.materials[1].texture = 1; }), Contains("texture index 1 of 1"));
    const auto texture = [](auto change) { return refusal_after([=](Model& m) { change(m.textures[0]); }); };
    CHECK_THAT(texture([](Texture& t) { t.width = 0; }), Contains("texture of 0 x 2"));
    CHECK_THAT(texture([](Texture& t) { t.mip_levels = 3; }), Contains("mip levels"));
    CHECK_THAT(texture([](Texture& t) { t.first_byte = 4; }), Contains("starts at"));
    CHECK_THAT(texture([](Texture& t) { t.byte_count = 24; }), Contains("bytes"));
    CHECK_THAT(texture([](Texture& t) { t.reserved = 1; }), Contains("reserved"));
    CHECK_THAT(texture([](Texture& t) {
                   t.width = t.height = 0x80000000u;
                   t.mip_levels = 32;
               }),
               Contains("larger than the texels"));
    CHECK_THAT(refusal_after([](Model& m) { m.texels.pop_back(); }), Contains("texels"));
    CHECK_THAT(refusal_after([](Model& m) { m.texels.resize(32); }), Contains("texel bytes"));
}

// What the named cases do not think of: any outcome but a crash (under the sanitizers) is right.
TEST_CASE("random damage under a forged checksum never crashes the reader") {
    const std::vector<std::byte> original = serialise_model(view_of(small_model()));
    std::mt19937 random(7);
    std::size_t refused = 0;
    constexpr std::size_t rounds = 20000;
    for (std::size_t round = 0; round < rounds; ++round) {
        std::vector<std::byte> bytes = original;
        for (int changes = 1 + static_cast<int>(random() % 3); changes > 0; --changes) {
            const std::size_t place = random() % (bytes.size() / 4) * 4;
            constexpr std::uint32_t extremes[] = {0,           1,           0x7fffffffu, 0x80000000u,
                                                  0xffffffffu, 0x7fc00000u, 0x7f800000u};
            const std::uint32_t value =
                random() % 2 == 0 ? extremes[random() % std::size(extremes)] : static_cast<std::uint32_t>(random());
            std::memcpy(bytes.data() + place, &value, sizeof(value));
        }
        forge_checksum(bytes);
        refused += refusal(bytes) != "accepted";
    }
    CHECK(refused > rounds / 2);
}
