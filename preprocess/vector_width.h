// Which of the processor's vectors a loop may use. Whoever offers a choice gives the same results for each.
#pragma once

namespace splice {

enum class VectorWidth { k128, k256 };

/// AVX2; asked of the processor once.
inline bool has_256_bit_vectors() {
#if defined(__x86_64__) && defined(__GNUC__)
    static const bool has = __builtin_cpu_supports("avx2") != 0;
    return has;
#else
    return false;
#endif
}

}  // namespace splice
