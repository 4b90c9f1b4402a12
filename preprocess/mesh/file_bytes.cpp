#include "preprocess/mesh/file_bytes.h"

#include "preprocess/large_vector.h"
#include "preprocess/model_format/error.h"
#include "preprocess/model_format/posix_open.h"

#include <tbb/parallel_for.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

namespace splice {

namespace {

/// A file open for reading.
class Descriptor {
  public:
    explicit Descriptor(const std::filesystem::path& path)
        : name_(path.string()), descriptor_(posix_open::open_for_reading(path.c_str())) {
        if (descriptor_ < 0) throw SystemError(name_ + ": cannot open: " + std::strerror(errno));
    }
    ~Descriptor() { close(descriptor_); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    void read(std::span<char> bytes, std::size_t offset) const {
        while (!bytes.empty()) {
            const ssize_t count = pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) throw SystemError(name_ + ": read error after " + std::to_string(offset) + " bytes");
            bytes = bytes.subspan(static_cast<std::size_t>(count));
            offset += static_cast<std::size_t>(count);
        }
    }

  private:
    std::string name_;
    int descriptor_;
};

}  // namespace

std::string read_file_bytes(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found) {
        throw InputError(path.string(), "", "no such file");
    }
    if (status.type() == std::filesystem::file_type::directory) {
        throw InputError(path.string(), "", "is a folder, expected a file");
    }
    if (error || !std::filesystem::is_regular_file(status)) {
        throw InputError(path.string(), "", "is not a regular file");
    }
    const auto size = std::filesystem::file_size(path, error);
    if (error) throw SystemError(path.string() + ": " + error.message());
    const Descriptor file(path);
    std::string bytes;
    bytes.reserve(size);
    populate(bytes.data(), size);
    bytes.resize(size);
    // Some threads copy faster from the kernel than one.
    constexpr std::size_t kPiece = std::size_t{8} << 20;
    tbb::parallel_for(std::size_t{0}, size, kPiece, [&](std::size_t begin) {
        file.read(std::span(bytes).subspan(begin, std::min(kPiece, size - begin)), begin);
    });
    return bytes;
}

bool is_gzip(std::string_view bytes) {
    return bytes.size() >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
}

namespace {

/// Owns the state that inflateInit2 allocates.
class Inflater {
  public:
    Inflater() {
        constexpr int kGzipOnly = 16 + MAX_WBITS;
        if (inflateInit2(&stream, kGzipOnly) != Z_OK) throw SystemError("zlib cannot be initialised");
    }
    ~Inflater() { inflateEnd(&stream); }
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    z_stream stream{};
};

}  // namespace

std::string gunzip(std::string_view bytes, const std::string& name) {
    constexpr std::size_t kAlwaysBelievable = std::size_t{64} << 20;
    constexpr std::size_t kBelievableRatio = 100;
    const std::size_t limit = std::max(kAlwaysBelievable, bytes.size() * kBelievableRatio);

    Inflater inflater;
    z_stream& stream = inflater.stream;
    std::string out;
    std::size_t consumed = 0, produced = 0;
    for (;;) {
        if (produced == out.size()) {
            if (produced >= limit) {
                throw InputError(name, "byte " + std::to_string(consumed),
                                 "gzip stream expands to more than " + std::to_string(limit) +
                                     " bytes, more than a mesh of this size can hold");
            }
            out.resize(std::min(limit, std::max<std::size_t>(out.size() * 2, bytes.size() * 4 + 4096)));
        }
        const auto chunk = [](std::size_t n) {
            return static_cast<uInt>(std::min<std::size_t>(n, std::numeric_limits<uInt>::max()));
        };
        const uInt in_chunk = chunk(bytes.size() - consumed);
        const uInt out_chunk = chunk(out.size() - produced);
        // zlib does not write through next_in.
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + consumed));
        stream.avail_in = in_chunk;
        stream.next_out = reinterpret_cast<Bytef*>(out.data() + produced);
        stream.avail_out = out_chunk;
        const int result = inflate(&stream, Z_NO_FLUSH);
        consumed += in_chunk - stream.avail_in;
        produced += out_chunk - stream.avail_out;
        if (result == Z_STREAM_END) {
            if (!is_gzip(bytes.substr(consumed))) break;  // padding may follow the last member
            inflateReset(&stream);
        } else if (result == Z_BUF_ERROR || (result == Z_OK && consumed == bytes.size() && produced < out.size())) {
            throw InputError(name, "byte " + std::to_string(consumed), "gzip stream is cut short");
        } else if (result != Z_OK) {
            throw InputError(name, "byte " + std::to_string(consumed),
                             std::string("damaged gzip stream (") + (stream.msg ? stream.msg : "unknown") + ")");
        }
    }
    out.resize(produced);
    return out;
}

}  // namespace splice
