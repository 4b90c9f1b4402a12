// From bytes to views: header, section table and checksum here, what the sections say in validate_model.cpp.
#include "preprocess/model_format/checksum.h"
#include "preprocess/model_format/error.h"
#include "preprocess/model_format/model.h"
#include "preprocess/model_format/section_layout.h"
#include "preprocess/model_format/validate_model.h"

#include <algorithm>
#include <cstring>
#include <sstream>
#include <stdexcept>

namespace splice {
namespace {

using namespace format;

class Parser {
  public:
    Parser(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    ModelView parse() {
        read_header();
        read_table();
        check_checksum();
        ModelView view;
        std::size_t section = 0;
        for_each_section(view, [&]<typename T>(SectionKind kind, const char* title, std::span<const T>& elements) {
            elements = section_elements<T>(section++, kind, title);
        });
        if (round_up_to_alignment(file_position_) != bytes_.size())
            fail(file_position_, "the last section ends here, but the file has ", bytes_.size(), " bytes");
        check_padding(file_position_, bytes_.size());
        if (view.info == nullptr)
            fail(sizeof(FileHeader) + offsetof(SectionEntry, count), "model info: 0 elements, expected 1");
        return view;
    }

  private:
    template <typename... Parts>
    [[noreturn]] void fail(std::uint64_t offset, const Parts&... parts) const {
        std::ostringstream problem;
        (problem << ... << parts);
        throw InputError(name_, "byte " + std::to_string(offset), problem.str());
    }

    void read_header() {
        if (bytes_.size() < sizeof(FileHeader))
            fail(0, "a model file has at least ", sizeof(FileHeader), " bytes, found ", bytes_.size());
        std::memcpy(&header_, bytes_.data(), sizeof(header_));
        if (std::memcmp(header_.magic, kMagic, sizeof(kMagic)) != 0)
            fail(0, "not a model file (wrong first eight bytes)");
        if (header_.version >= 1 && header_.version < kVersion)
            fail(offsetof(FileHeader, version), "format version ", header_.version, ", this program reads version ",
                 kVersion, ": bake the model again from its source with splice-bake");
        if (header_.version == kCompressedVersion)
            fail(offsetof(FileHeader, version), "a compressed model inside another file, expected a plain one");
        if (header_.version != kVersion)
            fail(offsetof(FileHeader, version), "format version ", header_.version, ", this program reads version ",
                 kVersion);
        if (header_.file_bytes != bytes_.size())
            fail(offsetof(FileHeader, file_bytes), "the file should have ", header_.file_bytes, " bytes, found ",
                 bytes_.size());
        if (header_.section_count != kSectionCount)
            fail(offsetof(FileHeader, section_count), header_.section_count, " sections, expected ", kSectionCount);
        if (header_.table_offset != sizeof(FileHeader))
            fail(offsetof(FileHeader, table_offset), "section table at ", header_.table_offset, ", expected ",
                 sizeof(FileHeader));
        if (std::ranges::any_of(header_.reserved, [](std::uint64_t word) { return word != 0; }))
            fail(offsetof(FileHeader, reserved), "reserved bytes are not 0");
    }

    void read_table() {
        const std::uint64_t end = sizeof(FileHeader) + sizeof(table_);
        if (bytes_.size() < end) fail(bytes_.size(), "the file ends inside the section table");
        std::memcpy(table_.data(), bytes_.data() + sizeof(FileHeader), sizeof(table_));
        file_position_ = end;
    }

    void check_checksum() const {
        FileHeader without = header_;
        without.checksum = 0;
        Checksum checksum;
        checksum.add(std::as_bytes(std::span(&without, 1)));
        checksum.add(bytes_.subspan(sizeof(FileHeader)));
        if (checksum.value() != header_.checksum)
            fail(offsetof(FileHeader, checksum), "checksum does not match: the file is damaged");
    }

    void check_padding(std::uint64_t begin, std::uint64_t end) const {
        const auto padding = bytes_.subspan(begin, end - begin);
        if (std::ranges::any_of(padding, [](std::byte byte) { return byte != std::byte{0}; }))
            fail(begin, "padding between sections is not 0");
    }

    // Sections lie in table order without gaps beyond the alignment, so they can neither overlap nor hide bytes.
    template <typename T>
    std::span<const T> section_elements(std::size_t index, SectionKind kind, const char* title) {
        const SectionEntry& entry = table_[index];
        const std::uint64_t at = sizeof(FileHeader) + index * sizeof(SectionEntry);
        if (entry.kind != kind)
            fail(at + offsetof(SectionEntry, kind), "section kind ", static_cast<std::uint32_t>(entry.kind),
                 ", expected ", static_cast<std::uint32_t>(kind), " (", title, ")");
        if (entry.stride != sizeof(T))
            fail(at + offsetof(SectionEntry, stride), title, ": ", entry.stride, " bytes an element, expected ",
                 sizeof(T));
        if (entry.reserved != 0) fail(at + offsetof(SectionEntry, reserved), title, ": reserved bytes are not 0");
        const std::uint64_t expected = round_up_to_alignment(file_position_);
        if (entry.offset != expected)
            fail(at + offsetof(SectionEntry, offset), title, ": section at byte ", entry.offset, ", expected ",
                 expected);
        if (entry.offset > bytes_.size() || entry.count > (bytes_.size() - entry.offset) / sizeof(T))
            fail(at + offsetof(SectionEntry, count), title, ": ", entry.count, " elements do not fit into the file");
        check_padding(file_position_, entry.offset);
        file_position_ = entry.offset + entry.count * sizeof(T);
        return {reinterpret_cast<const T*>(bytes_.data() + entry.offset), entry.count};
    }

    std::span<const std::byte> bytes_;
    const std::string& name_;
    FileHeader header_{};
    std::array<SectionEntry, kSectionCount> table_{};
    std::uint64_t file_position_ = 0;  // end of what has been accounted for
};

}  // namespace

ModelView parse_model(std::span<const std::byte> bytes, const std::string& name) {
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % alignof(ModelInfo) != 0)
        throw std::invalid_argument("parse_model: the bytes must be aligned as the structs are");
    const ModelView view = Parser(bytes, name).parse();
    validate_model(view, bytes.data(), name);
    return view;
}

}  // namespace splice
