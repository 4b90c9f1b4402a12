#include "engine/bench/report_files.h"

#include "engine/capture/prepare_scene.h"
#include "preprocess/model_format/atomic_file.h"
#include "preprocess/model_format/error.h"

namespace splice::bench {

std::vector<NamedFile> named_files(const std::string& name, const std::vector<std::filesystem::path>& paths) {
    std::vector<NamedFile> files;
    for (const std::filesystem::path& path : paths)
        files.push_back({name, path});
    return files;
}

std::vector<NamedFile> files_of_scenes(const std::string& name, const std::vector<std::filesystem::path>& paths) {
    std::vector<NamedFile> files;
    for (const std::filesystem::path& path : paths) {
        if (!std::filesystem::is_regular_file(path)) throw UsageError(path.string() + ": no such file");
        for (const std::filesystem::path& part : files_of_scene(path))
            files.push_back({part == path ? name : "the scene's model", part});
    }
    return files;
}

void check_report_files(std::vector<NamedFile> inputs, std::vector<NamedFile> outputs) {
    for (auto* files : {&inputs, &outputs})
        std::erase_if(*files, [](const NamedFile& file) { return file.path.empty(); });
    check_distinct_files(inputs, outputs);
    for (const NamedFile& output : outputs)
        check_output_path(output.path);
}

}  // namespace splice::bench
