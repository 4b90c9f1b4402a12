#include "engine/vulkan/pipeline_statistics.h"

#include "engine/vulkan/query_pool.h"
#include "preprocess/model_format/error.h"

#include <string>

namespace splice::gpu {
namespace {

// The device writes them in the order of their bits, which is that of PipelineCounts.
constexpr VkQueryPipelineStatisticFlags kCounted = VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_VERTICES_BIT |
                                                   VK_QUERY_PIPELINE_STATISTIC_VERTEX_SHADER_INVOCATIONS_BIT |
                                                   VK_QUERY_PIPELINE_STATISTIC_CLIPPING_PRIMITIVES_BIT |
                                                   VK_QUERY_PIPELINE_STATISTIC_FRAGMENT_SHADER_INVOCATIONS_BIT;
static_assert(sizeof(PipelineCounts) == 4 * sizeof(uint64_t));

}  // namespace

PipelineStatistics::PipelineStatistics(const Device& device, uint32_t capacity)
    : device_(device.handle()), capacity_(capacity) {
    if (!device.features().pipeline_statistics) throw DeviceError("the Vulkan device has no pipeline statistics");
    pool_ = create_query_pool(device, VK_QUERY_TYPE_PIPELINE_STATISTICS, capacity, kCounted);
}

void PipelineStatistics::reset(VkCommandBuffer commands) {
    vkCmdResetQueryPool(commands, pool_.get(), 0, capacity_);
    count_ = 0;
}

void PipelineStatistics::begin(VkCommandBuffer commands) {
    if (count_ >= capacity_) throw DeviceError("more than " + std::to_string(capacity_) + " pipeline statistics");
    vkCmdBeginQuery(commands, pool_.get(), count_, 0);
}

void PipelineStatistics::end(VkCommandBuffer commands) {
    vkCmdEndQuery(commands, pool_.get(), count_++);
}

std::vector<PipelineCounts> PipelineStatistics::read() const {
    std::vector<PipelineCounts> counts(count_);
    if (count_ == 0) return counts;
    check(vkGetQueryPoolResults(device_, pool_.get(), 0, count_, counts.size() * sizeof(PipelineCounts), counts.data(),
                                sizeof(PipelineCounts), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "reading pipeline statistics");
    return counts;
}

}  // namespace splice::gpu
