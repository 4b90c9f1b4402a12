#include "preprocess/build_model/workers_aside.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#if defined(__linux__)
#include <sched.h>
#endif

namespace splice {
namespace {

#if defined(__linux__)

int current_processor() {
    return sched_getcpu();
}

void leave(int processor) {
    cpu_set_t allowed;
    if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;  // more processors than the set has room for
    cpu_set_t others = allowed;
    CPU_CLR(processor, &others);
    if (CPU_COUNT(&others) == 0) return;
    sched_setaffinity(0, sizeof others, &others);
    sched_setaffinity(0, sizeof allowed, &allowed);
}

#else

int current_processor() {
    return -1;
}
void leave(int) {}

#endif

}  // namespace

WorkersAside::WorkersAside()
    : processor_(current_processor()), moves_left_(tbb::this_task_arena::max_concurrency() - 1) {
    if (moves_left_ <= 0) return;
    observe(true);
    // Starts the workers.
    tbb::parallel_for(0, tbb::this_task_arena::max_concurrency(), [](int) {});
}

void WorkersAside::on_scheduler_entry(bool is_worker) {
    if (is_worker && processor_ >= 0 && current_processor() == processor_ && moves_left_-- > 0) leave(processor_);
}

}  // namespace splice
