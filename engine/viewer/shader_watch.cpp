#include "engine/viewer/shader_watch.h"

#include "engine/viewer/compile_shader.h"
#include "preprocess/model_format/error.h"

#include <utility>

namespace splice {

namespace {

constexpr double kSecondsBetweenLooks = 0.5;

bool is_shader(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    return extension == ".vert" || extension == ".frag" || extension == ".comp";
}

}  // namespace

ShaderWatch::ShaderWatch(std::filesystem::path folder) : folder_(std::move(folder)) {
    for (const auto& [path, time] : look())
        if (is_shader(path)) return;
    throw SystemError("--shaders " + folder_.string() + ": no folder with shaders (.vert, .frag, .comp)");
}

ShaderWatch::Times ShaderWatch::look() const {
    Times times;
    std::error_code status;
    for (const std::filesystem::path& folder : {folder_, folder_ / "include"})
        for (std::filesystem::directory_iterator entry(folder, status), end; !status && entry != end;
             entry.increment(status))
            if (const auto time = entry->last_write_time(status); !status) times[entry->path()] = time;
    return times;
}

bool ShaderWatch::poll(double seconds) {
    if (seconds - last_look_ < kSecondsBetweenLooks) return false;
    last_look_ = seconds;
    Times times = look();
    if (times == times_) return false;
    times_ = std::move(times);
    compile();
    return true;
}

void ShaderWatch::compile() {
    error_.clear();
    Shaders compiled;
    try {
        for (const auto& [path, time] : times_)
            if (is_shader(path)) compiled[path.filename().string()] = compile_shader(path, folder_ / "include");
        shaders_ = std::move(compiled);
    } catch (const Error& error) {
        error_ = error.what();
    }
}

std::string ShaderWatch::status() const {
    return error_.empty() ? "shaders from " + folder_.string() : "the last shaders that compiled";
}

}  // namespace splice
