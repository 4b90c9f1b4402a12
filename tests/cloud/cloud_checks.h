// What the tests of the cloud readers share.
#pragma once

#include "preprocess/cloud/cloud_formats.h"
#include "preprocess/cloud/read_point_cloud.h"
#include "preprocess/model_format/error.h"
#include "tests/support/input_error.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <string>

namespace splice::test {

/// A point in the file's coordinates.
inline Vec3d source_point(const PointCloud& cloud, std::size_t point) {
    return cloud.origin + cloud.offsets.at(point).cast<double>();
}

inline std::uint32_t rgb(unsigned r, unsigned g, unsigned b) {
    return r | g << 8 | b << 16 | 0xff000000u;
}

/// A file of the fuzzers' seeds.
inline std::string seed(const std::string& name) {
    std::ifstream file(source_file("tests/fuzz/corpus/" + name), std::ios::binary);
    REQUIRE(file);
    return {std::istreambuf_iterator<char>(file), {}};
}

template <class T>
void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
void overwrite(std::string& bytes, std::size_t at, T value) {
    bytes.replace(at, sizeof value, reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace splice::test
