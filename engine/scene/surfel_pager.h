// Surfels of a model that is larger than the memory it may take: blocks of its file's records, read by a thread of
// their own when frames want them, and given up when room is needed for others. Frames never wait for the thread unless
// they say so: they draw what is there, and nodes of the point tree, which is always there, in place of what is not.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

namespace splice {

class SurfelPager {
  public:
    static constexpr std::uint64_t kBlockBytes = std::uint64_t{256} << 10;

    /// Fills `bytes`, which begin at `first` of all records. Called by the pager's thread alone.
    using Read = std::function<void(std::uint64_t first, std::span<std::byte> bytes)>;

    /// Of records of `bytes` in all, no more than `limit` are held at a time, but at least one block.
    SurfelPager(std::uint64_t bytes, std::uint64_t limit, Read read);
    ~SurfelPager();
    SurfelPager(const SurfelPager&) = delete;
    SurfelPager& operator=(const SurfelPager&) = delete;

    std::uint32_t blocks() const { return static_cast<std::uint32_t>(place_.size()); }
    /// Blocks that fit into the limit.
    std::size_t capacity() const { return capacity_; }

    /// What the next frame needs, the most important first, each block once; of more than capacity() the last are left
    /// out. They are read in this order, and stay until the next call.
    void want(std::vector<std::uint32_t> blocks);

    /// Returns when all that was last wanted is there. Throws what reading threw.
    void wait();

    /// Of a block that was last wanted; empty if it is not there yet. Holds until the next want().
    std::span<const std::byte> find(std::uint32_t block) const;

    /// Whether there is still something to read of what was last wanted.
    bool is_reading() const;
    std::uint64_t resident_bytes() const;
    std::uint64_t blocks_read() const;

  private:
    static constexpr std::uint32_t kNowhere = 0xffffffffu;
    struct Slot {
        std::unique_ptr<std::byte[]> bytes;
        std::uint32_t block = kNowhere;
        std::uint64_t wanted = 0;  // by which call of want(), the last one
    };

    void run();
    std::uint32_t next_missing() const;
    std::uint32_t make_room();
    std::uint64_t size_of(std::uint32_t block) const;

    const std::uint64_t bytes_;
    const std::size_t capacity_;
    const Read read_;
    mutable std::mutex mutex_;
    std::condition_variable work_, done_;
    std::vector<std::uint32_t> place_;  // of each block: its slot
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> wanted_;
    std::uint64_t calls_ = 0, blocks_read_ = 0;
    std::exception_ptr failure_;
    bool stop_ = false;
    std::thread thread_;  // last: it uses all of the above
};

}  // namespace splice
