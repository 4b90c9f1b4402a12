// What this process holds, as its operating system and its allocator count. Numbers that are not known are 0.
#pragma once

#include <cstdint>

namespace splice {

struct ProcessMemory {
    std::uint64_t heap_bytes = 0;      // allocated and not freed
    std::uint64_t resident_bytes = 0;  // in memory, files and device memory on a software device included
    std::uint64_t open_files = 0;      // descriptors
};

ProcessMemory process_memory();

}  // namespace splice
