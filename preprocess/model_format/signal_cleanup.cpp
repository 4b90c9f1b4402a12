#include "preprocess/model_format/signal_cleanup.h"

#include "preprocess/model_format/error.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <climits>

namespace splice {
namespace {

std::array<char, PATH_MAX> pending_name{};
std::atomic<bool> pending{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void remove_pending_and_die(int signal_number) {
    if (pending.exchange(false)) unlink(pending_name.data());
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);
}

}  // namespace

SignalCleanup::SignalCleanup(const std::filesystem::path& name) {
    const std::string text = std::filesystem::absolute(name).string();
    if (text.size() >= pending_name.size()) throw SystemError(name.string() + ": cannot create: the name is too long");
    std::ranges::copy(text, pending_name.begin());
    pending_name[text.size()] = '\0';
    pending = true;
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        sigaction(kSignals[i], nullptr, &previous_[i]);
        if (previous_[i].sa_handler == SIG_DFL) std::signal(kSignals[i], remove_pending_and_die);
    }
}

SignalCleanup::~SignalCleanup() {
    for (std::size_t i = 0; i < kSignals.size(); ++i)
        if (previous_[i].sa_handler == SIG_DFL) std::signal(kSignals[i], SIG_DFL);
    pending = false;
}

}  // namespace splice
