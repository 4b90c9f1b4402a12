#include "engine/bench/bench_models.h"

#include "preprocess/model_format/error.h"

#include <array>

namespace splice::bench {
namespace {
namespace fs = std::filesystem;

struct ThesisModel {
    const char* file;
    Published published;
};

constexpr std::array<ThesisModel, 5> kThesisModels{{
    {"bones.smf", {4204, 617, 43269, 1.72 + 14.13, 10.9, 63, 968}},
    {"cow.smf", {5804, 1533, 51731, 2.59 + 77.31, 11.2, 69, 906}},
    {"dragon-50000.smf", {50761, 9552, 145712, 24.42 + 132.63, 20.7, 29, 130}},
    {"bunny.smf", {69451, 13038, 308550, 30.58 + 182, 15.8, 17, 92}},
    {"crater.smf", {199114, 22517, 1070316, 81.61 + 555.73, 40.1, 2, 10}},
}};

constexpr const char* kDebianBunny = "/usr/share/glmark2/models/bunny.obj";

BenchModel describe(const fs::path& path) {
    for (const ThesisModel& known : kThesisModels)
        if (path.filename() == known.file) return {path, path.stem().string(), known.published};
    fs::path name = path.filename();
    if (name.extension() == ".gz") name = name.stem();
    return {path, name.string(), std::nullopt};
}

}  // namespace

std::vector<BenchModel> bench_models(const std::vector<fs::path>& files, const fs::path& folder) {
    std::vector<BenchModel> models;
    for (const fs::path& file : files) {
        if (!fs::is_regular_file(file)) throw UsageError(file.string() + ": no such file");
        models.push_back(describe(file));
    }
    if (!files.empty()) return models;
    for (const ThesisModel& known : kThesisModels)
        if (const fs::path file = folder / "meshes" / known.file; fs::is_regular_file(file))
            models.push_back(describe(file));
    if (fs::is_regular_file(kDebianBunny)) models.push_back(describe(kDebianBunny));
    if (models.empty())
        throw UsageError("no model given, none of the thesis's in " + folder.string() +
                         "/meshes, and no bunny of the package glmark2-data");
    return models;
}

}  // namespace splice::bench
