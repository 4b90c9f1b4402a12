#include "preprocess/model_format/error.h"
#include "preprocess/model_format/model.h"
#include "preprocess/model_format/section_layout.h"
#include "tests/model_format/small_model.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <fstream>

using namespace splice;
using test::small_model;

namespace {

template <typename T>
bool same_bytes(std::span<const T> a, std::span<const T> b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

void check_equal(const ModelView& a, const ModelView& b) {
    CHECK(std::memcmp(a.info, b.info, sizeof(format::ModelInfo)) == 0);
    CHECK(same_bytes(a.vertices, b.vertices));
    CHECK(same_bytes(a.indices, b.indices));
    CHECK(same_bytes(a.surfels, b.surfels));
    CHECK(same_bytes(a.patches, b.patches));
    CHECK(same_bytes(a.lods, b.lods));
    CHECK(same_bytes(a.octree, b.octree));
    CHECK(same_bytes(a.merge_tree, b.merge_tree));
    CHECK(same_bytes(a.materials, b.materials));
    CHECK(same_bytes(a.textures, b.textures));
    CHECK(same_bytes(a.texels, b.texels));
    CHECK(same_bytes(a.point_tree, b.point_tree));
    CHECK(same_bytes(a.packed_surfels, b.packed_surfels));
}

std::vector<char> read_all(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t files_in(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

}  // namespace

TEST_CASE("a model survives the way through a file") {
    const Model model = small_model();
    const test::TemporaryFolder folder;
    const std::uint64_t size = write_model(view_of(model), folder / "small.splice");
    CHECK(size == std::filesystem::file_size(folder / "small.splice"));
    const ModelFile file(folder / "small.splice");
    check_equal(view_of(model), file.view());
}

TEST_CASE("the file and the bytes in memory are the same, and the same each time") {
    const Model model = small_model();
    const test::TemporaryFolder folder;
    write_model(view_of(model), folder / "a.splice");
    const std::vector<std::byte> bytes = serialise_model(view_of(model));
    CHECK(serialise_model(view_of(model)) == bytes);
    const std::vector<char> file = read_all(folder / "a.splice");
    REQUIRE(file.size() == bytes.size());
    CHECK(std::memcmp(file.data(), bytes.data(), bytes.size()) == 0);
}

TEST_CASE("sections lie at the alignment the GPU upload expects") {
    const std::vector<std::byte> bytes = serialise_model(view_of(small_model()));
    CHECK(bytes.size() % format::kSectionAlignment == 0);
    const ModelView view = parse_model(bytes, "bytes");
    format::for_each_section(view, [&](format::SectionKind, const char* title, const auto& elements) {
        INFO(title);
        const auto offset = reinterpret_cast<const std::byte*>(elements.data()) - bytes.data();
        CHECK(offset % static_cast<std::ptrdiff_t>(format::kSectionAlignment) == 0);
    });
}

TEST_CASE("writing replaces an existing model whole and leaves nothing beside it") {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "m.splice") << "something old";
    write_model(view_of(small_model()), folder / "m.splice");
    CHECK_NOTHROW(ModelFile(folder / "m.splice"));
    CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("writing through a symbolic link keeps the link") {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "target.splice") << "something old";
    std::filesystem::create_symlink("target.splice", folder / "link.splice");
    write_model(view_of(small_model()), folder / "link.splice");
    CHECK(std::filesystem::is_symlink(folder / "link.splice"));
    CHECK_NOTHROW(ModelFile(folder / "target.splice"));
    CHECK(files_in(folder.path()) == 2);
}

TEST_CASE("a written model can be read by whom the umask allows") {
    const test::TemporaryFolder folder;
    const mode_t before = umask(022);
    write_model(view_of(small_model()), folder / "m.splice");
    write_model(view_of(small_model()), folder / "m.splice");  // the way of replacing
    umask(before);
    struct stat status {};
    REQUIRE(stat((folder / "m.splice").c_str(), &status) == 0);
    CHECK((status.st_mode & 0777) == 0644);
}

TEST_CASE("writing where it cannot be done says so and leaves nothing") {
    const test::TemporaryFolder folder;
    const Model model = small_model();
    CHECK_THROWS_AS(write_model(view_of(model), folder / "absent/m.splice"), SystemError);
    std::filesystem::create_directory(folder / "folder.splice");
    CHECK_THROWS_AS(write_model(view_of(model), folder / "folder.splice"), SystemError);
    CHECK_THROWS_AS(write_model(view_of(model), "/dev/null"), SystemError);
    CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("reading what is no model file says so") {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "empty.splice");
    std::ofstream(folder / "text.splice") << std::string(100, 'x');
    CHECK_THROWS_AS(ModelFile(folder / "empty.splice"), InputError);
    CHECK_THROWS_AS(ModelFile(folder / "text.splice"), InputError);
    CHECK_THROWS_AS(ModelFile(folder / "absent.splice"), SystemError);
    CHECK_THROWS_AS(ModelFile(folder.path()), InputError);
    REQUIRE(mkfifo((folder / "pipe.splice").c_str(), 0600) == 0);
    CHECK_THROWS_AS(ModelFile(folder / "pipe.splice"), InputError);  // and does not wait for a writer
}

TEST_CASE("a model file can be moved") {
    const Model model = small_model();
    const test::TemporaryFolder folder;
    write_model(view_of(model), folder / "small.splice");
    ModelFile first(folder / "small.splice");
    ModelFile second(std::move(first));
    check_equal(view_of(model), second.view());
    ModelFile third(folder / "small.splice");
    third = std::move(second);
    check_equal(view_of(model), third.view());
}
