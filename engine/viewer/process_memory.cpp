#include "engine/viewer/process_memory.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace splice {

ProcessMemory process_memory() {
    ProcessMemory memory;
#ifdef __GLIBC__
    const struct mallinfo2 heap = mallinfo2();
    memory.heap_bytes = heap.uordblks + heap.hblkhd;
#endif
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        if (word != "VmRSS:") continue;
        status >> memory.resident_bytes;
        memory.resident_bytes *= 1024;
        break;
    }
    std::error_code unknown;
    for (std::filesystem::directory_iterator files("/proc/self/fd", unknown), end; !unknown && files != end;
         files.increment(unknown))
        ++memory.open_files;
    return memory;
}

}  // namespace splice
