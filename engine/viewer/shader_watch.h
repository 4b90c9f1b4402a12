// Looks at a folder of shader sources and compiles them all when one changes. Those that do not compile leave the last
// that did.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace splice {

class ShaderWatch {
  public:
    /// By the name of the file: "triangle.vert".
    using Shaders = std::map<std::string, std::vector<std::uint32_t>>;

    /// A folder as shaders/glsl: sources, and include/. Throws SystemError where it has none.
    explicit ShaderWatch(std::filesystem::path folder);

    /// Looks at most twice a second; the first look counts as a change. True if sources changed: then there are new
    /// shaders, or an error.
    bool poll(double seconds);

    const Shaders& shaders() const { return shaders_; }
    const std::string& error() const { return error_; }  // of the last change
    std::string status() const;

  private:
    using Times = std::map<std::filesystem::path, std::filesystem::file_time_type>;
    Times look() const;
    void compile();

    std::filesystem::path folder_;
    double last_look_ = -1e9;
    Times times_;
    Shaders shaders_;
    std::string error_;
};

}  // namespace splice
