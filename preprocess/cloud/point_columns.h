// Every format with records of fixed size, and every table of numbers, is a set of columns: from those to a PointCloud,
// in parallel, the result the same for any thread count.
#pragma once

#include "preprocess/cloud/point_cloud.h"
#include "preprocess/mesh/ply_header.h"

#include <bit>
#include <cstring>
#include <optional>

namespace splice {

/// One number of each record, in the file's bytes.
struct ScalarColumn {
    const char* first = nullptr;  // of record 0; nullptr: no such column
    std::size_t stride = 0;       // bytes from record to record
    PlyType type = PlyType::kFloat64;
    bool big_endian = false;
    double scale = 1, shift = 0;  // value = stored * scale + shift

    explicit operator bool() const { return first != nullptr; }
    double operator[](std::size_t record) const {
        const char* at = first + record * stride;
        return stored(at) * scale + shift;
    }

  private:
    template <class T>
    double load(const char* at) const {
        char bytes[sizeof(T)];
        if (big_endian) {
            for (std::size_t i = 0; i < sizeof(T); ++i)
                bytes[i] = at[sizeof(T) - 1 - i];
        } else {
            std::memcpy(bytes, at, sizeof(T));
        }
        T value;
        std::memcpy(&value, bytes, sizeof(T));
        return static_cast<double>(value);
    }
    double stored(const char* at) const {
        switch (type) {
            case PlyType::kInt8:
                return load<std::int8_t>(at);
            case PlyType::kUint8:
                return load<std::uint8_t>(at);
            case PlyType::kInt16:
                return load<std::int16_t>(at);
            case PlyType::kUint16:
                return load<std::uint16_t>(at);
            case PlyType::kInt32:
                return load<std::int32_t>(at);
            case PlyType::kUint32:
                return load<std::uint32_t>(at);
            case PlyType::kFloat32:
                return load<float>(at);
            case PlyType::kFloat64:
                return load<double>(at);
        }
        return 0;
    }
};

struct PointColumns {
    std::size_t records = 0;
    ScalarColumn position[3];
    ScalarColumn normal[3];    // all three or none
    ScalarColumn colour[3];    // values of 0..1; all three or none
    ScalarColumn packed_rgb;   // 0x00RRGGBB, instead of `colour`
    ScalarColumn flags;        // a record is withheld ...
    unsigned withheld_if = 0;  // ... where flags & withheld_if is not 0
};

/// The caller has checked that every column lies in memory.
PointCloud gather_points(const PointColumns& columns);

/// A PointColumns' column for column `index` of a table of doubles with `width` columns.
inline ScalarColumn table_column(const std::vector<double>& table, std::size_t width, std::size_t index,
                                 double scale = 1) {
    // An empty table has no memory to point into.
    return {table.empty() ? "" : reinterpret_cast<const char*>(table.data() + index),
            width * sizeof(double),
            PlyType::kFloat64,
            false,
            scale,
            0};
}

}  // namespace splice
