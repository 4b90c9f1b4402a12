// Which passes must finish before which: a read after the write it sees, a write after the reads of what it replaces, a
// write after a write, and side effects in the order of their declaration. At most two edges an access, amortised.
#include "engine/render_graph/compile/compilation.h"

namespace splice::graph {
namespace {

/// The passes that read the current contents of each resource, as linked lists in one array.
class Readers {
  public:
    Readers(size_t resources, size_t accesses) : heads_(resources, none) { nodes_.reserve(accesses); }
    void add(uint32_t resource, uint32_t pass) {
        nodes_.push_back({pass, heads_[resource]});
        heads_[resource] = static_cast<uint32_t>(nodes_.size() - 1);
    }
    bool any(uint32_t resource) const { return heads_[resource] != none; }
    template <typename Function>
    void take(uint32_t resource, const Function& function) {
        for (uint32_t node = heads_[resource]; node != none; node = nodes_[node].next)
            function(nodes_[node].pass);
        heads_[resource] = none;
    }

  private:
    struct Node {
        uint32_t pass, next;
    };
    std::vector<uint32_t> heads_;
    std::vector<Node> nodes_;
};

}  // namespace

void find_dependencies(Compilation& compilation) {
    const Declaration& declaration = compilation.declaration;
    compilation.predecessors.assign(declaration.passes.size(), {});
    std::vector<uint32_t> last_writer(declaration.resources.size(), none);
    Readers readers(declaration.resources.size(), declaration.accesses.size());
    uint32_t last_side_effect = none;
    compilation.edges.reserve(declaration.accesses.size());
    std::pmr::vector<Edge>& edges = compilation.edges;
    for (uint32_t pass = 0; pass < declaration.passes.size(); ++pass) {
        const auto first = static_cast<uint32_t>(edges.size());
        if (compilation.kept[pass]) {
            for (const Access& access : compilation.graph.accesses(pass)) {
                const uint32_t resource = access.resource;
                const uint32_t writer = last_writer[resource];
                if (!is_write(access.kind)) {
                    if (writer != none) edges.push_back({writer, resource, is_attachment(access.kind)});
                    readers.add(resource, pass);
                    continue;
                }
                if (readers.any(resource)) {
                    readers.take(resource, [&](uint32_t reader) {
                        edges.push_back({reader, resource, is_attachment(access.kind)});
                    });
                } else if (writer != none) {
                    edges.push_back({writer, resource, is_attachment(access.kind)});
                }
                last_writer[resource] = pass;
            }
            if (declaration.passes[pass].side_effect) {
                if (last_side_effect != none) edges.push_back({last_side_effect, none, false});
                last_side_effect = pass;
            }
        }
        compilation.predecessors[pass] = {first, static_cast<uint32_t>(edges.size()) - first};
    }
}

}  // namespace splice::graph
