#include "engine/viewer/compile_shader.h"

#include "preprocess/model_format/error.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>

namespace splice {

namespace {

// The library counts how often it is started and ended.
struct Library {
    Library() { glslang::InitializeProcess(); }
    ~Library() { glslang::FinalizeProcess(); }
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;
};

std::optional<std::string> text_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return std::nullopt;
    return std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
}

class Includer : public glslang::TShader::Includer {
  public:
    explicit Includer(std::filesystem::path folder) : folder_(std::move(folder)) {}

    IncludeResult* includeLocal(const char* name, const char*, std::size_t) override {
        const std::filesystem::path path = folder_ / name;
        std::optional<std::string> text = text_of(path);
        if (!text) return nullptr;
        auto* kept = new std::string(std::move(*text));  // the library hands it back to releaseInclude
        return new IncludeResult(name, kept->data(), kept->size(), kept);
    }
    void releaseInclude(IncludeResult* result) override {
        if (result == nullptr) return;
        delete static_cast<std::string*>(result->userData);
        delete result;
    }

  private:
    std::filesystem::path folder_;
};

EShLanguage stage_of(const std::filesystem::path& source) {
    const std::string extension = source.extension().string();
    if (extension == ".vert") return EShLangVertex;
    if (extension == ".frag") return EShLangFragment;
    return EShLangCompute;
}

std::string trimmed(std::string log) {
    while (!log.empty() && log.back() == '\n')
        log.pop_back();
    return log;
}

}  // namespace

std::vector<std::uint32_t> compile_shader(const std::filesystem::path& source,
                                          const std::filesystem::path& include_folder) {
    const Library library;
    const std::optional<std::string> text = text_of(source);
    if (!text) throw SystemError("cannot read " + source.string() + ": " + std::strerror(errno));
    const EShLanguage stage = stage_of(source);
    const std::string name = source.filename().string();
    const char* strings[] = {text->c_str()};
    const int lengths[] = {static_cast<int>(text->size())};
    const char* names[] = {name.c_str()};
    glslang::TShader shader(stage);
    shader.setStringsWithLengthsAndNames(strings, lengths, names, 1);
    shader.setEnvInput(glslang::EShSourceGlsl, stage, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_2);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_5);
    constexpr auto messages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
    Includer includer(include_folder);
    if (!shader.parse(GetDefaultResources(), 110, false, messages, includer))
        throw InputError(name, "", trimmed(shader.getInfoLog()));
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(messages)) throw InputError(name, "", trimmed(program.getInfoLog()));
    std::vector<std::uint32_t> words;
    glslang::GlslangToSpv(*program.getIntermediate(stage), words);
    return words;
}

}  // namespace splice
