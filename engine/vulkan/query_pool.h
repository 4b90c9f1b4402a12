// Query pools: of timestamps, of pipeline statistics.
#pragma once

#include "engine/vulkan/device.h"
#include "engine/vulkan/handle.h"

namespace splice::gpu {

/// `statistics`: what queries of pipeline statistics count. Throws DeviceError.
inline UniqueQueryPool create_query_pool(const Device& device, VkQueryType type, uint32_t capacity,
                                         VkQueryPipelineStatisticFlags statistics = 0) {
    VkQueryPoolCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    create.queryType = type;
    create.queryCount = capacity;
    create.pipelineStatistics = statistics;
    VkQueryPool handle = VK_NULL_HANDLE;
    check(vkCreateQueryPool(device.handle(), &create, nullptr, &handle), "creating a query pool");
    return UniqueQueryPool(device.handle(), handle);
}

}  // namespace splice::gpu
