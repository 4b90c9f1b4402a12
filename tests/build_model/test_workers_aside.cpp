#include "preprocess/build_model/workers_aside.h"

#include <catch2/catch.hpp>

#if defined(__linux__)
#include <sched.h>

#include <thread>

using namespace splice;

namespace {

cpu_set_t allowed_processors() {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    sched_getaffinity(0, sizeof allowed, &allowed);
    return allowed;
}

/// What a worker may run on after it was sent aside, and whether it moved. On a thread of its own: the test's may run
/// where it could before.
struct Outcome {
    bool moved = false;
    cpu_set_t allowed;
};
Outcome send_aside(const cpu_set_t& allowed) {
    Outcome outcome;
    std::thread([&] {
        sched_setaffinity(0, sizeof allowed, &allowed);
        // The system may move the thread in between, and back.
        for (int attempt = 0; attempt < 100 && !outcome.moved; ++attempt) {
            WorkersAside workers;
            const int before = sched_getcpu();
            workers.on_scheduler_entry(true);
            outcome.moved = sched_getcpu() != before;
        }
        outcome.allowed = allowed_processors();
    }).join();
    return outcome;
}

}  // namespace

TEST_CASE("A worker on the processor of the thread it helps moves away and may run anywhere afterwards") {
    const cpu_set_t all = allowed_processors();
    if (CPU_COUNT(&all) < 2) {
        WARN("one processor only: nowhere to move to");
        return;
    }
    const Outcome outcome = send_aside(all);
    CHECK(outcome.moved);
    CHECK(CPU_EQUAL(&outcome.allowed, &all) != 0);
}

TEST_CASE("A worker that may run on one processor only stays there") {
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(sched_getcpu(), &one);
    const Outcome outcome = send_aside(one);
    CHECK_FALSE(outcome.moved);
    CHECK(CPU_EQUAL(&outcome.allowed, &one) != 0);
}
#endif
