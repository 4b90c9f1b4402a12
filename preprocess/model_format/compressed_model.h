// Model files whose sections are compressed (docs/model_format.md, Compressed files): format version 5, otherwise as
// version 4. They are expanded to version 4 in memory before anything looks at them, so nothing else knows of them.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace splice {

/// Whether this build has zstd.
bool can_compress_models();

/// From the bytes of a whole file of version 4. Deterministic with one version of zstd. Throws UsageError without zstd.
std::vector<std::byte> compress_model(std::span<const std::byte> plain);

bool is_compressed_model(std::span<const std::byte> bytes);

/// Back to the same bytes. Checks header, table and checksum; no size is believed: no more memory is asked for than
/// kMostExpansion times the file's bytes. `name` is for messages. Throws InputError with the byte offset.
std::vector<std::byte> expand_model(std::span<const std::byte> bytes, const std::string& name);

/// A section that would shrink further is left as it is.
inline constexpr std::size_t kMostExpansion = 256;

}  // namespace splice
