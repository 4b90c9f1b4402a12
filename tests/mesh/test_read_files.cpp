// What all formats share: gzip, telling formats apart, refusing what is no mesh.
#include "preprocess/mesh/file_bytes.h"
#include "preprocess/mesh/sniff_format.h"
#include "tests/mesh/mesh_checks.h"
#include "tests/support/test_files.h"

#include <zlib.h>

#include <fstream>

using namespace splice;
using namespace splice::test;

namespace {

void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

std::string gzipped(const std::string& text) {
    z_stream stream{};
    constexpr int kGzip = 16 + MAX_WBITS;
    REQUIRE(deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzip, 9, Z_DEFAULT_STRATEGY) == Z_OK);
    std::string out(deflateBound(&stream, text.size()) + 64, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string kOff = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement "
    "face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kStl =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    "endsolid a\n";
const std::string kSmf = "begin\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nend\n";

}  // namespace

TEST_CASE("Every format is read gzipped and plain, by whatever name") {
    const TemporaryFolder folder;
    for (const std::string& text : {kObj, kOff, kPly, kStl, kSmf}) {
        for (const char* name : {"mesh.bin", "mesh.gz", "mesh"}) {
            write(folder / name, text);
            CHECK(polygons(read_mesh_file(folder / name)) == 1);
            write(folder / name, gzipped(text));
            CHECK(polygons(read_mesh_file(folder / name)) == 1);
        }
    }
    write(folder / "wrong.stl", kPly);
    CHECK(polygons(read_mesh_file(folder / "wrong.stl")) == 1);
}

TEST_CASE("Format by content first, by the name's ending second") {
    CHECK(sniff_format(kPly, ".obj", "x") == MeshFormat::kPly);
    CHECK(sniff_format(kOff, ".PLY", "x") == MeshFormat::kOff);
    CHECK(sniff_format(kSmf, ".obj", "x") == MeshFormat::kObj);  // `begin` is a free-form statement there
    CHECK(sniff_format("#$SMF 1.0\n" + kObj, ".obj", "x") == MeshFormat::kSmf);
    CHECK(sniff_format(kObj, ".smf", "x") == MeshFormat::kSmf);
    CHECK(sniff_format("# comment\n" + kObj, "", "x") == MeshFormat::kObj);
    CHECK(sniff_format("solid names may start an OBJ too\n" + kObj, ".OBJ", "x") == MeshFormat::kObj);
    for (const char* header : {"OFF", "COFF", "NOFF", "STOFF", "STCN4nOFF"}) {
        CHECK(sniff_format(header + std::string("\n"), "", "x") == MeshFormat::kOff);
    }
}

TEST_CASE("What is no readable mesh is refused with the list of formats") {
    for (const std::string& bytes :
         {std::string("glTF\2\0\0\0", 8), std::string("LASF"), std::string("# .PCD v0.7\n"), std::string("II*\0", 4),
          std::string("1 2 3\n4 5 6\n"), std::string("\xFE\xFF\0v", 4)}) {
        CHECK_THAT(input_error([&] { sniff_format(bytes, ".xyz", "file"); }),
                   Catch::Contains("OBJ, PLY, STL, OFF and SMF"));
    }
    CHECK_THAT(input_error([] { sniff_format("", ".obj", "file"); }), Catch::Contains("empty"));
}

TEST_CASE("Files without faces say so") {
    const TemporaryFolder folder;
    write(folder / "points.obj", "v 0 0 0\nv 1 0 0\n");
    CHECK_THAT(input_error([&] { read_mesh_file(folder / "points.obj"); }), Catch::Contains("no faces, only 2 points"));
    write(folder / "nothing.obj", "# nothing\n");
    CHECK_THAT(input_error([&] { read_mesh_file(folder / "nothing.obj"); }),
               Catch::Contains("no faces and no vertices"));
}

TEST_CASE("What is no file is refused") {
    const TemporaryFolder folder;
    CHECK_THAT(input_error([&] { read_mesh_file(folder / "absent.obj"); }), Catch::Contains("no such file"));
    CHECK_THAT(input_error([&] { read_mesh_file(folder.path()); }), Catch::Contains("is a folder"));
}

TEST_CASE("gzip: several members, padding, damage, truncation, and bombs") {
    const std::string zipped = gzipped(kObj);
    CHECK(gunzip(zipped, "x") == kObj);
    CHECK(gunzip(zipped + zipped, "x") == kObj + kObj);
    CHECK(gunzip(zipped + std::string(512, '\0'), "x") == kObj);
    for (std::size_t size = 2; size < zipped.size(); size += 3) {
        CHECK_THROWS_AS(gunzip(zipped.substr(0, size), "x"), InputError);
    }
    std::string damaged = zipped;
    damaged[zipped.size() / 2] = static_cast<char>(damaged[zipped.size() / 2] ^ 0x55);
    CHECK_THROWS_AS(gunzip(damaged, "x"), InputError);
    const std::string bomb = gzipped(std::string(std::size_t{80} << 20, ' '));
    CHECK_THAT(input_error([&] { gunzip(bomb, "x"); }), Catch::Contains("expands to more than"));
}

TEST_CASE("Images that promise more than their bytes can hold are refused") {
    std::string problem;
    CHECK_FALSE(decode_image("P6\n60000 60000\n255\nabc", problem).has_value());
    CHECK_THAT(problem, Catch::Contains("60000 x 60000"));
    CHECK_FALSE(decode_image("P6\n20 20\n255\nabc", problem).has_value());
    CHECK_FALSE(decode_image("no image", problem).has_value());
    CHECK_FALSE(decode_image("", problem).has_value());
}
