#include "engine/vulkan/timestamps.h"

#include "engine/vulkan/query_pool.h"
#include "preprocess/model_format/error.h"

namespace splice::gpu {

Timestamps::Timestamps(const Device& device, uint32_t capacity)
    : device_(device.handle()), capacity_(capacity), ms_per_tick_(double{device.limits().timestampPeriod} * 1e-6) {
    if (!device.features().timestamps) throw DeviceError("the Vulkan device has no timestamps");
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device.physical(), &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device.physical(), &count, families.data());
    valid_bits_ = families[device.queue_family()].timestampValidBits;
    pool_ = create_query_pool(device, VK_QUERY_TYPE_TIMESTAMP, capacity);
}

void Timestamps::reset(VkCommandBuffer commands) {
    vkCmdResetQueryPool(commands, pool_.get(), 0, capacity_);
    count_ = 0;
}

uint32_t Timestamps::write(VkCommandBuffer commands) {
    if (count_ >= capacity_) throw DeviceError("more than " + std::to_string(capacity_) + " timestamps");
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_.get(), count_);
    return count_++;
}

std::vector<double> Timestamps::read_ms() const {
    if (count_ == 0) return {};
    std::vector<uint64_t> ticks(count_);
    check(vkGetQueryPoolResults(device_, pool_.get(), 0, count_, ticks.size() * sizeof(uint64_t), ticks.data(),
                                sizeof(uint64_t), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "reading timestamps");
    const uint64_t mask = valid_bits_ >= 64 ? UINT64_MAX : (uint64_t{1} << valid_bits_) - 1;
    std::vector<double> times;
    times.reserve(ticks.size());
    for (const uint64_t tick : ticks)
        times.push_back(static_cast<double>((tick - ticks[0]) & mask) * ms_per_tick_);
    return times;
}

}  // namespace splice::gpu
