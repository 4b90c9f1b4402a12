// Where the threads of a bake run. Linux wakes a thread on the processor it ran on last, even if that is busy and
// another idle, where the two are halves of one core: a worker then waits for up to 3 ms, which is half of clustering a
// small mesh, or takes turns with the thread it should help.
#pragma once

#include <tbb/task_scheduler_observer.h>

#include <atomic>

namespace splice {

/// While it lives, workers of the calling thread's arena that start on the processor that this thread was on move to
/// another one, and may run anywhere again afterwards: as many moves as there are workers, because the thread may
/// itself move in time. Has no effect but on speed, and none but on Linux.
class WorkersAside final : public tbb::task_scheduler_observer {
  public:
    WorkersAside();
    WorkersAside(const WorkersAside&) = delete;
    WorkersAside& operator=(const WorkersAside&) = delete;
    ~WorkersAside() override { observe(false); }
    void on_scheduler_entry(bool is_worker) override;

  private:
    int processor_;  // of the thread that made it
    std::atomic<int> moves_left_;
};

}  // namespace splice
