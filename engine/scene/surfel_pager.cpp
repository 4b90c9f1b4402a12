#include "engine/scene/surfel_pager.h"

#include <algorithm>
#include <utility>

namespace splice {

SurfelPager::SurfelPager(std::uint64_t bytes, std::uint64_t limit, Read read)
    : bytes_(bytes),
      capacity_(std::max<std::uint64_t>(limit / kBlockBytes, 1)),
      read_(std::move(read)),
      place_((bytes + kBlockBytes - 1) / kBlockBytes, kNowhere),
      thread_([this] { run(); }) {}

SurfelPager::~SurfelPager() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    work_.notify_one();
    thread_.join();
}

void SurfelPager::want(std::vector<std::uint32_t> blocks) {
    if (blocks.size() > capacity_) blocks.resize(capacity_);
    {
        const std::lock_guard lock(mutex_);
        ++calls_;
        for (const std::uint32_t block : blocks)
            if (place_[block] != kNowhere) slots_[place_[block]].wanted = calls_;
        wanted_ = std::move(blocks);
    }
    work_.notify_one();
}

void SurfelPager::wait() {
    std::unique_lock lock(mutex_);
    done_.wait(lock, [&] { return failure_ || next_missing() == kNowhere; });
    if (failure_) std::rethrow_exception(failure_);
}

std::span<const std::byte> SurfelPager::find(std::uint32_t block) const {
    const std::lock_guard lock(mutex_);
    if (place_[block] == kNowhere || slots_[place_[block]].wanted != calls_) return {};
    return {slots_[place_[block]].bytes.get(), size_of(block)};
}

bool SurfelPager::is_reading() const {
    const std::lock_guard lock(mutex_);
    return !failure_ && next_missing() != kNowhere;
}

std::uint64_t SurfelPager::resident_bytes() const {
    const std::lock_guard lock(mutex_);
    return slots_.size() * kBlockBytes;
}

std::uint64_t SurfelPager::blocks_read() const {
    const std::lock_guard lock(mutex_);
    return blocks_read_;
}

std::uint64_t SurfelPager::size_of(std::uint32_t block) const {
    return std::min(kBlockBytes, bytes_ - block * kBlockBytes);
}

std::uint32_t SurfelPager::next_missing() const {
    const auto missing = std::ranges::find_if(wanted_, [&](std::uint32_t block) { return place_[block] == kNowhere; });
    return missing == wanted_.end() ? kNowhere : *missing;
}

// A slot whose block nobody looks at: no frame reads what it did not want.
std::uint32_t SurfelPager::make_room() {
    if (slots_.size() < capacity_) {
        slots_.push_back({std::make_unique<std::byte[]>(kBlockBytes)});
        return static_cast<std::uint32_t>(slots_.size() - 1);
    }
    const auto oldest = std::ranges::min_element(slots_, {}, &Slot::wanted);
    if (oldest->block != kNowhere) place_[oldest->block] = kNowhere;
    oldest->block = kNowhere;
    return static_cast<std::uint32_t>(oldest - slots_.begin());
}

void SurfelPager::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        work_.wait(lock, [&] { return stop_ || (!failure_ && next_missing() != kNowhere); });
        if (stop_) return;
        const std::uint32_t block = next_missing(), place = make_room();
        std::byte* const bytes = slots_[place].bytes.get();
        lock.unlock();
        std::exception_ptr failure;
        try {
            read_(block * kBlockBytes, {bytes, size_of(block)});
        } catch (...) {
            failure = std::current_exception();
        }
        lock.lock();
        failure_ = failure;
        if (!failure_) {
            ++blocks_read_;
            slots_[place].block = block;
            slots_[place].wanted = std::ranges::count(wanted_, block) != 0 ? calls_ : 0;
            place_[block] = place;
        }
        done_.notify_all();
    }
}

}  // namespace splice
