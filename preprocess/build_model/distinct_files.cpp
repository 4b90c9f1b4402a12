#include "preprocess/build_model/distinct_files.h"

#include "preprocess/model_format/error.h"

#include <sys/stat.h>

#include <map>
#include <optional>
#include <utility>

namespace splice {
namespace {

namespace fs = std::filesystem;

// Writing through a link creates what the link names, even if that does not exist yet.
fs::path without_dangling_links(fs::path path) {
    constexpr int kMostLinks = 40;  // as many as Linux follows
    std::error_code error;
    for (int i = 0; i < kMostLinks && fs::is_symlink(path, error) && !fs::exists(path, error); ++i)
        path = path.parent_path() / fs::read_symlink(path, error);
    return path;
}

std::string canonical_name(const fs::path& path) {
    std::error_code error;
    const fs::path absolute = fs::absolute(without_dangling_links(path), error);
    const fs::path canonical = fs::weakly_canonical(absolute, error);
    return (error ? absolute.lexically_normal() : canonical).string();
}

using Identity = std::pair<dev_t, ino_t>;

// Hard links have names of their own.
std::optional<Identity> identity(const fs::path& path) {
    struct stat status {};
    if (stat(path.c_str(), &status) != 0) return std::nullopt;
    return Identity{status.st_dev, status.st_ino};
}

class KnownFiles {
  public:
    /// The first file that `file` is the same as, or null: then `file` is known from now on.
    const NamedFile* same_or_add(const NamedFile& file) {
        const auto [named, new_name] = by_name_.emplace(canonical_name(file.path), &file);
        if (!new_name) return named->second;
        const std::optional<Identity> id = identity(file.path);
        if (!id) return nullptr;
        const auto [identified, new_identity] = by_identity_.emplace(*id, &file);
        return new_identity ? nullptr : identified->second;
    }

  private:
    std::map<std::string, const NamedFile*> by_name_;
    std::map<Identity, const NamedFile*> by_identity_;
};

}  // namespace

void check_distinct_files(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs) {
    KnownFiles known;
    for (const NamedFile& input : inputs)
        known.same_or_add(input);
    for (const NamedFile& output : outputs) {
        const NamedFile* other = known.same_or_add(output);
        if (!other) continue;
        throw UsageError(output.name + " " + output.path.string() + " would overwrite " + other->name + " " +
                         other->path.string());
    }
}

}  // namespace splice
