#include "preprocess/model_format/compressed_model.h"
#include "preprocess/model_format/error.h"
#include "preprocess/model_format/model.h"
#include "preprocess/model_format/posix_open.h"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace splice {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path) {
    throw SystemError(path.string() + ": cannot read: " + std::strerror(errno));
}

// Closes on every way out; a mapping outlives its descriptor.
struct Descriptor {
    int number;
    ~Descriptor() {
        if (number >= 0) close(number);
    }
};

std::span<const std::byte> map_file(const std::filesystem::path& path) {
    const Descriptor file{posix_open::open_for_reading(path.c_str())};
    struct stat status {};
    if (file.number < 0 || fstat(file.number, &status) != 0) fail(path);
    if (!S_ISREG(status.st_mode)) throw InputError(path.string(), "", "not a regular file");
    const auto size = static_cast<std::size_t>(status.st_size);
    if (size == 0) return {};  // an empty mapping is an error to mmap; the parser says what is wrong
    void* memory = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.number, 0);
    if (memory == MAP_FAILED) fail(path);
    madvise(memory, size, MADV_WILLNEED);
    return {static_cast<const std::byte*>(memory), size};
}

void unmap(std::span<const std::byte> bytes) {
    if (!bytes.empty()) munmap(const_cast<std::byte*>(bytes.data()), bytes.size());
}

}  // namespace

ModelFile::ModelFile(const std::filesystem::path& path) : bytes_(map_file(path)) {
    try {
        if (is_compressed_model(bytes_)) expanded_ = expand_model(bytes_, path.string());
        view_ = parse_model(is_compressed() ? expanded_ : bytes_, path.string());
    } catch (...) {
        unmap(bytes_);
        throw;
    }
}

ModelFile::ModelFile(ModelFile&& other) noexcept
    : bytes_(std::exchange(other.bytes_, {})),
      expanded_(std::exchange(other.expanded_, {})),
      view_(std::exchange(other.view_, {})) {}

ModelFile& ModelFile::operator=(ModelFile&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    std::swap(expanded_, other.expanded_);
    std::swap(view_, other.view_);
    return *this;
}

void ModelFile::release(std::span<const std::byte> part) const {
    // What is expanded cannot be read again.
    if (is_compressed()) return;
    // Whole pages, so that nothing beside the part goes.
    const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    const auto begin = (reinterpret_cast<std::uintptr_t>(part.data()) + page - 1) / page * page;
    const auto end = reinterpret_cast<std::uintptr_t>(part.data() + part.size()) / page * page;
    if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED);
}

ModelFile::~ModelFile() {
    unmap(bytes_);
}

}  // namespace splice
