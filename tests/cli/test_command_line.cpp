#include "preprocess/build_model/program_main.h"
#include "preprocess/model_format/error.h"

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>

#include <optional>
#include <string>
#include <vector>

using namespace splice;

namespace {

struct Numbers {
    double ranged = 0, unlimited = 0;
    std::optional<double> optional;
    std::vector<double> list;
    float single = 0;
    std::string file;
    double of_command = 0;
};

Numbers parse(std::vector<const char*> arguments) {
    Numbers numbers;
    CLI::App app;
    app.add_option("--ranged", numbers.ranged)->check(CLI::Range(0.0, 1.0));
    app.add_option("--unlimited", numbers.unlimited);
    app.add_option("--optional", numbers.optional)->check(CLI::Range(0.0, 1.0));
    app.add_option("--list", numbers.list)->delimiter(',')->check(CLI::Range(0.0, 8.0));
    app.add_option("--single", numbers.single)->option_text("PX");
    app.add_option("--file", numbers.file);
    app.add_subcommand("command")->add_option("--of-command", numbers.of_command)->check(CLI::Range(0.0, 1.0));
    arguments.insert(arguments.begin(), "program");
    parse_command_line(app, static_cast<int>(arguments.size()), arguments.data());
    return numbers;
}

}  // namespace

TEST_CASE("no option of any program takes what is not a finite number for one") {
    for (const char* option : {"--ranged", "--unlimited", "--optional", "--list", "--single"})
        for (const char* value : {"nan", "NaN", "-nan", "inf", "-inf", "infinity", "1e999"}) {
            INFO(option << ' ' << value);
            CHECK_THROWS_AS(parse({option, value}), UsageError);
        }
    CHECK_THROWS_AS(parse({"--list", "1,nan"}), UsageError);
    CHECK_THROWS_AS(parse({"command", "--of-command", "nan"}), UsageError);
    CHECK_THROWS_WITH(parse({"--ranged", "nan"}), Catch::Contains("--ranged: 'nan' is not a finite number"));
}

TEST_CASE("finite numbers pass, and files may be called anything") {
    const Numbers numbers = parse({"--ranged", "0.5", "--unlimited", "-1e300", "--optional", "1", "--list", "1,2.5",
                                   "--single", "3", "--file", "nan", "command", "--of-command", "1"});
    CHECK(numbers.ranged == 0.5);
    CHECK(numbers.unlimited == -1e300);
    CHECK(numbers.optional == 1.0);
    CHECK(numbers.list == std::vector<double>{1, 2.5});
    CHECK(numbers.single == 3.0F);
    CHECK(numbers.file == "nan");
    CHECK(numbers.of_command == 1.0);
}
