// Removes a file when SIGINT, SIGTERM or SIGHUP ends the process.
#pragma once

#include <array>
#include <csignal>
#include <filesystem>

namespace splice {

/// While it lives, those of the three signals that would end the process remove `name` first. Signals that are ignored
/// (as nohup does) or handled already are left alone. One at a time in a process, since a signal handler can reach
/// nothing but statics.
class SignalCleanup {
  public:
    explicit SignalCleanup(const std::filesystem::path& name);  // throws SystemError
    ~SignalCleanup();
    SignalCleanup(const SignalCleanup&) = delete;
    SignalCleanup& operator=(const SignalCleanup&) = delete;

  private:
    static constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};
    std::array<struct sigaction, kSignals.size()> previous_{};
};

}  // namespace splice
