// Memory for vectors of megabytes. All threads get it from the system together, as for one that touches page after page
// it is a tenth of a point cloud's bake; and a program may keep what it no longer needs for what it needs next.
#pragma once

#include <malloc.h>
#include <sys/mman.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace splice {

/// Has no effect but on speed, and none where the kernel cannot do it (before Linux 5.14).
inline void populate([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_POPULATE_WRITE
    constexpr std::size_t kPiece = std::size_t{4} << 20;
    const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + page - 1) / page * page,
               end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / page * page;
    if (end < begin + kPiece) return;
    tbb::parallel_for(begin, end, kPiece, [&](std::uintptr_t piece) {
        madvise(reinterpret_cast<void*>(piece), std::min(kPiece, end - piece), MADV_POPULATE_WRITE);
    });
#endif
}

/// For a whole program, before it needs memory: what is freed is used again instead of going back to the kernel, which
/// would clear every page anew. Only with glibc.
inline void keep_freed_memory() {
#ifdef M_MMAP_THRESHOLD
    mallopt(M_MMAP_THRESHOLD, INT_MAX);
    mallopt(M_TRIM_THRESHOLD, INT_MAX);
#endif
}

/// Of `size` elements, as they are by default.
template <class T>
std::vector<T> large_vector(std::size_t size) {
    std::vector<T> vector;
    vector.reserve(size);
    populate(vector.data(), size * sizeof(T));
    vector.resize(size);
    return vector;
}

}  // namespace splice
