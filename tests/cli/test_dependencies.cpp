// The preprocessor stands without Vulkan, and the model format without anything.
#include "tests/cli/spawn.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <regex>

using namespace splice;

namespace {

// Calls visit(file, included path, whether in quotes) for each #include under a folder of the source tree.
template <typename Visitor>
void for_each_include(const std::string& folder, const Visitor& visit) {
    static const std::regex include(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
    for (const auto& entry : std::filesystem::recursive_directory_iterator(test::source_file(folder))) {
        const auto extension = entry.path().extension();
        if (extension != ".h" && extension != ".cpp") continue;
        std::ifstream file(entry.path());
        std::smatch match;
        for (std::string line; std::getline(file, line);)
            if (std::regex_search(line, match, include))
                visit(entry.path().filename().string(), match[2].str(), match[1] == "\"");
    }
}

}  // namespace

TEST_CASE("splice-bake and splice-info link no Vulkan") {
    for (const char* program : {"splice-bake", "splice-info"}) {
        const test::Outcome outcome = test::run({"ldd", {test::program(program).string()}});
        REQUIRE(outcome.exit_code == 0);
        CHECK_THAT(outcome.out, Catch::Contains("libc.so") && !Catch::Contains("vulkan", Catch::CaseSensitive::No));
    }
}

TEST_CASE("nothing below preprocess includes the engine or Vulkan") {
    std::size_t includes = 0;
    for_each_include("preprocess", [&](const std::string& file, const std::string& path, bool) {
        INFO(file << " includes " << path);
        CHECK(!path.starts_with("engine/"));
        CHECK(path.find("vulkan") == std::string::npos);
        ++includes;
    });
    CHECK(includes > 100);
}

// And what reads compressed sections includes what decompresses them.
TEST_CASE("the model format includes the standard library and the operating system only") {
    for_each_include("preprocess/model_format", [](const std::string& file, const std::string& path, bool quoted) {
        INFO(file << " includes " << path);
        if (quoted)
            CHECK(path.starts_with("preprocess/model_format/"));
        else
            CHECK((path.find('.') == std::string::npos || path == "fcntl.h" || path == "unistd.h" ||
                   path.starts_with("sys/") || (path == "zstd.h" && file == "compressed_model.cpp")));
    });
}
