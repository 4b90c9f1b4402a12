#include "engine/capture/graph_switches.h"

#include "preprocess/model_format/error.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string_view>

namespace splice {
namespace {

constexpr std::string_view kRandomOrder = "random-order=";

struct Switch {
    std::string_view name;
    bool graph::ExecutorOptions::*option;  // which it turns off
};
constexpr Switch kSwitches[] = {
    {"no-cull", &graph::ExecutorOptions::cull},
    {"no-merge", &graph::ExecutorOptions::merge},
    {"no-alias", &graph::ExecutorOptions::alias},
    {"one-barrier-per-access", &graph::ExecutorOptions::batch_barriers},
};

bool apply(std::string_view text, graph::ExecutorOptions& options) {
    for (const Switch& known : kSwitches) {
        if (text != known.name) continue;
        options.*known.option = false;
        return true;
    }
    if (!text.starts_with(kRandomOrder)) return false;
    const std::string_view digits = text.substr(kRandomOrder.size());
    std::uint64_t seed = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), seed);
    if (error != std::errc() || end != digits.data() + digits.size()) return false;
    options.random_order = seed;
    return true;
}

}  // namespace

void apply_graph_switches(const std::string& list, graph::ExecutorOptions& options) {
    for (std::size_t start = 0; start <= list.size();) {
        const std::size_t comma = std::min(list.find(',', start), list.size());
        const std::string_view one = std::string_view(list).substr(start, comma - start);
        if (!apply(one, options)) {
            throw UsageError("--graph-switch: expected some of " + graph_switch_help() +
                             ", separated by commas, got \"" + std::string(one) + "\"");
        }
        start = comma + 1;
    }
}

std::string graph_switch_help() {
    std::string help;
    for (const Switch& known : kSwitches)
        help += std::string(known.name) + ", ";
    return help + std::string(kRandomOrder) + "SEED";
}

}  // namespace splice
