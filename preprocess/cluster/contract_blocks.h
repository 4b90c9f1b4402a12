// The first part of phase one, where most merges are: clusters of a stretch of the space-filling curve are contracted
// by themselves, in memory that caches hold, many stretches at a time. What merges across stretches is left for later.
#pragma once

#include "preprocess/cluster/cluster_graph.h"
#include "preprocess/cluster/cluster_metric.h"

#include <cstdint>
#include <vector>

namespace splice {

/// Clusters between two parts of a contraction, in slots along the space-filling curve.
struct ClusterLevel {
    std::vector<Cluster> clusters;
    std::vector<std::uint8_t> rough;          // see FlatnessMetric
    std::vector<std::uint32_t> nodes;         // of the merge tree
    std::vector<FaceGraph::Link> links;       // ascending by slot[0], slot[1]
    std::vector<format::MergeNode> tree;      // merges so far
    std::vector<std::uint32_t> slot_of_face;  // by slot of FaceGraph
};

/// Contracts each run of `block` clusters by FlatnessMetric, as if the others were not there, while the cheapest pair
/// costs at most `threshold`. Clusters that are left are numbered by their lowest slots. The same for any number of
/// threads.
ClusterLevel contract_blocks(const ClusterLevel& level, const ClusterLimits& limits, float threshold,
                             std::uint32_t block);

}  // namespace splice
