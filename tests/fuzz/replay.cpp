// Runs a fuzz target over a folder of seeds and over deterministic mutations of each, without a fuzzer: what once went
// wrong stays right, under every compiler and sanitizer. Usage: PROGRAM FOLDER
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

void run(const std::string& bytes) {
    // A copy of exactly this size, so that a sanitizer sees the first byte read beyond it.
    const std::vector<std::uint8_t> exact(bytes.begin(), bytes.end());
    LLVMFuzzerTestOneInput(exact.data(), exact.size());
}

void run_truncated(const std::string& seed) {
    constexpr std::size_t kCuts = 60;
    const std::size_t step = std::max<std::size_t>(1, seed.size() / kCuts);
    for (std::size_t size = 0; size < seed.size(); size += step)
        run(seed.substr(0, size));
}

void run_mutated(const std::string& seed, std::mt19937& random) {
    if (seed.empty()) return;
    constexpr int kMutations = 240;
    static constexpr char kTelling[] = {'\0', '\xff', '\x7f', '\x80', '-', '9', ' ', '\n', '\r', '.', 'e', '/'};
    const auto below = [&random](std::size_t n) { return random() % n; };
    for (int i = 0; i < kMutations; ++i) {
        std::string bytes = seed;
        for (std::size_t edits = 1 + below(4); edits > 0 && !bytes.empty(); --edits) {
            const std::size_t at = below(bytes.size());
            switch (below(5)) {
                case 0:
                    bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
                    break;
                case 1:
                    bytes[at] = static_cast<char>(below(256));
                    break;
                case 2:
                    bytes[at] = kTelling[below(std::size(kTelling))];
                    break;
                case 3:
                    bytes.erase(at, 1 + below(16));
                    break;
                default:
                    bytes.insert(below(bytes.size() + 1), bytes.substr(at, 1 + below(16)));
                    break;
            }
        }
        run(bytes);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
        return 2;
    }
    std::vector<std::filesystem::path> seeds;
    for (const auto& entry : std::filesystem::directory_iterator(argv[1]))
        seeds.push_back(entry.path());
    std::sort(seeds.begin(), seeds.end());
    if (seeds.empty()) {
        std::fprintf(stderr, "%s: no seeds\n", argv[1]);
        return 1;
    }
    std::mt19937 random(20);
    for (const auto& seed : seeds) {
        std::ifstream file(seed, std::ios::binary);
        const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
        run(bytes);
        run_truncated(bytes);
        run_mutated(bytes, random);
    }
    std::printf("%zu seeds\n", seeds.size());
    return 0;
}
