#include "engine/bench/graph/graph_layout.h"

#include <algorithm>
#include <cstdint>

namespace splice::bench {
namespace {

constexpr int kSweeps = 12;
constexpr double kBendWidth = 6;  // of a line in a layer that it only passes

/// A box, or the place where a line passes a layer.
struct Node {
    double width;
    double x = 0;
    std::vector<size_t> above, below;
};

class Layout {
  public:
    Layout(std::vector<LayoutBox>& boxes, std::vector<LayoutLine>& lines, double gap)
        : boxes_(boxes), lines_(lines), gap_(gap) {}

    double run() {
        assign_layers();
        make_nodes();
        for (int sweep = 0; sweep < kSweeps; ++sweep) {
            const bool down = sweep % 2 == 0;
            for (size_t i = 0; i < layers_.size(); ++i)
                sort_layer(down ? i : layers_.size() - 1 - i, down);
        }
        spread();
        for (int sweep = 0; sweep < kSweeps; ++sweep) {
            const bool down = sweep % 2 == 0;
            for (size_t i = 0; i < layers_.size(); ++i)
                pull_layer(down ? i : layers_.size() - 1 - i);
        }
        return hand_back();
    }

  private:
    /// As low as what they feed allows, so that a box stands near its readers.
    void assign_layers() {
        for (const LayoutLine& line : lines_)
            boxes_[line.to].layer = std::max(boxes_[line.to].layer, boxes_[line.from].layer + 1);
        std::vector<std::vector<size_t>> below(boxes_.size());
        for (const LayoutLine& line : lines_)
            below[line.from].push_back(line.to);
        for (size_t i = boxes_.size(); i-- > 0;) {
            size_t next = SIZE_MAX;
            for (const size_t reader : below[i])
                next = std::min(next, boxes_[reader].layer);
            if (next != SIZE_MAX) boxes_[i].layer = next - 1;
        }
    }

    void make_nodes() {
        for (const LayoutBox& box : boxes_) {
            layers_.resize(std::max(layers_.size(), box.layer + 1));
            layers_[box.layer].push_back(nodes_.size());
            nodes_.push_back({box.width, 0, {}, {}});
        }
        for (const LayoutLine& line : lines_) {
            size_t previous = line.from;
            for (size_t layer = boxes_[line.from].layer + 1; layer <= boxes_[line.to].layer; ++layer) {
                size_t next = line.to;
                if (layer < boxes_[line.to].layer) {
                    next = nodes_.size();
                    nodes_.push_back({kBendWidth, 0, {}, {}});
                    layers_[layer].push_back(next);
                }
                nodes_[previous].below.push_back(next);
                nodes_[next].above.push_back(previous);
                previous = next;
            }
        }
        for (const auto& layer : layers_) {
            for (size_t i = 0; i < layer.size(); ++i)
                nodes_[layer[i]].x = static_cast<double>(i);
        }
    }

    double mean(const std::vector<size_t>& neighbours, double otherwise) const {
        if (neighbours.empty()) return otherwise;
        double sum = 0;
        for (const size_t neighbour : neighbours)
            sum += nodes_[neighbour].x;
        return sum / static_cast<double>(neighbours.size());
    }

    /// Barycentres; x is the place within the layer, in 0..1.
    void sort_layer(size_t layer, bool by_above) {
        std::vector<std::pair<double, size_t>> keyed;
        for (const size_t node : layers_[layer])
            keyed.emplace_back(mean(by_above ? nodes_[node].above : nodes_[node].below, nodes_[node].x), node);
        std::stable_sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        for (size_t i = 0; i < keyed.size(); ++i) {
            layers_[layer][i] = keyed[i].second;
            nodes_[keyed[i].second].x = (static_cast<double>(i) + 0.5) / static_cast<double>(keyed.size());
        }
    }

    double distance(size_t left, size_t right) const { return (nodes_[left].width + nodes_[right].width) / 2 + gap_; }

    /// Every layer packed and centred around 0.
    void spread() {
        for (const auto& layer : layers_) {
            double x = 0;
            for (size_t i = 0; i < layer.size(); ++i) {
                if (i > 0) x += distance(layer[i - 1], layer[i]);
                nodes_[layer[i]].x = x;
            }
            for (const size_t node : layer)
                nodes_[node].x -= x / 2;
        }
    }

    /// Each node towards the middle of its neighbours, in order and without overlap: the mean of the leftmost and the
    /// rightmost arrangement that this allows.
    void pull_layer(size_t layer) {
        const std::vector<size_t>& order = layers_[layer];
        std::vector<double> wanted, left(order.size()), right(order.size());
        for (const size_t node : order) {
            std::vector<size_t> neighbours = nodes_[node].above;
            neighbours.insert(neighbours.end(), nodes_[node].below.begin(), nodes_[node].below.end());
            wanted.push_back(mean(neighbours, nodes_[node].x));
        }
        for (size_t i = 0; i < order.size(); ++i)
            right[i] = i == 0 ? wanted[i] : std::max(wanted[i], right[i - 1] + distance(order[i - 1], order[i]));
        for (size_t i = order.size(); i-- > 0;)
            left[i] =
                i + 1 == order.size() ? wanted[i] : std::min(wanted[i], left[i + 1] - distance(order[i], order[i + 1]));
        for (size_t i = 0; i < order.size(); ++i)
            nodes_[order[i]].x = (left[i] + right[i]) / 2;
    }

    double hand_back() {
        double least = 0, most = 0;
        for (const Node& node : nodes_) {
            least = std::min(least, node.x - node.width / 2);
            most = std::max(most, node.x + node.width / 2);
        }
        for (size_t i = 0; i < boxes_.size(); ++i)
            boxes_[i].x = nodes_[i].x - least;
        size_t bend = boxes_.size();  // in the order in which make_nodes() made them
        for (LayoutLine& line : lines_) {
            for (size_t layer = boxes_[line.from].layer + 1; layer < boxes_[line.to].layer; ++layer)
                line.x_between.push_back(nodes_[bend++].x - least);
        }
        return most - least;
    }

    std::vector<LayoutBox>& boxes_;
    std::vector<LayoutLine>& lines_;
    double gap_;
    std::vector<Node> nodes_;  // boxes first
    std::vector<std::vector<size_t>> layers_;
};

}  // namespace

double lay_out(std::vector<LayoutBox>& boxes, std::vector<LayoutLine>& lines, double gap) {
    return boxes.empty() ? 0 : Layout(boxes, lines, gap).run();
}

}  // namespace splice::bench
