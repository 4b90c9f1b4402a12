#include "tests/render_graph/plan_checker.h"

#include "tests/render_graph/access_model.h"

#include <algorithm>
#include <utility>

namespace splice::test {
namespace {

using graph::AccessKind;
using graph::none;

/// What the accesses of the recorded passes say of a resource.
struct Use {
    uint32_t first_group = none, last_group = none;
    VkImageUsageFlags image_usage = 0;
    VkBufferUsageFlags buffer_usage = 0;
    bool only_attachment = true;
};

class PlanChecker {
  public:
    PlanChecker(const graph::Graph& graph, const graph::Plan& plan, const std::vector<graph::MemoryRequirement>& memory)
        : graph_(graph), plan_(plan), memory_(memory), uses_(plan.resources.size()) {}

    std::vector<std::string> check() {
        find_uses();
        for (uint32_t resource = 0; resource < uses_.size(); ++resource) {
            check_resource(resource);
            check_place(resource);
        }
        check_sharing();
        for (const graph::Group& group : plan_.groups) {
            if (group.render_pass != none) check_render_pass(plan_.render_passes[group.render_pass], group);
        }
        check_memoryless();
        return problems_;
    }

  private:
    void report(uint32_t resource, const std::string& problem) {
        problems_.push_back(graph::quote_resource(graph_, resource) + ": " + problem);
    }
    const graph::ResourceDeclaration& declared(uint32_t resource) const {
        return graph_.declaration().resources[resource];
    }

    void find_uses() {
        for (uint32_t group = 0; group < plan_.groups.size(); ++group) {
            for (const uint32_t pass : slice(plan_.order, plan_.groups[group].passes)) {
                for (const graph::Access& access : graph_.accesses(pass)) {
                    Use& use = uses_[access.resource];
                    if (use.first_group == none) use.first_group = group;
                    use.last_group = group;
                    use.only_attachment = use.only_attachment && used_as_attachment(access.kind);
                    if (declared(access.resource).kind == graph::ResourceKind::image) {
                        use.image_usage |= image_usage_of(access.kind, declared(access.resource).image.format);
                    } else {
                        use.buffer_usage |= buffer_usage_of(access.kind);
                    }
                }
            }
        }
    }

    void check_resource(uint32_t resource) {
        const graph::PlannedResource& planned = plan_.resources[resource];
        const Use& use = uses_[resource];
        if (planned.lifetime != graph::Lifetime{use.first_group, use.last_group}) {
            report(resource, "lives in other groups than those that use it");
        }
        if (planned.image_usage != use.image_usage) report(resource, "is created for other uses of an image");
        if (planned.buffer_usage != use.buffer_usage) report(resource, "is created for other uses of a buffer");
    }

    void check_place(uint32_t resource) {
        const graph::PlannedResource& planned = plan_.resources[resource];
        const bool transient = declared(resource).transient() && uses_[resource].first_group != none;
        if (planned.heap == none) {
            if (transient && !memory_.empty() && placed_any() && memory_[resource].size != 0) {
                report(resource, "has no place in a heap");
            }
            return;
        }
        if (!transient) report(resource, "is in a heap, although nothing or somebody else gives it memory");
        const graph::MemoryRequirement& need = memory_[resource];
        const graph::Heap& heap = plan_.heaps[planned.heap];
        if (planned.size != need.size) report(resource, "is planned with another size than it has");
        if (planned.offset % need.alignment != 0 || heap.alignment % need.alignment != 0) {
            report(resource, "is misaligned");
        }
        if (planned.offset + need.size > heap.size) report(resource, "ends beyond its heap");
        if (heap.memory_type_bits == 0 || (heap.memory_type_bits & ~need.memory_type_bits) != 0) {
            report(resource, "is in memory of a type that it cannot have");
        }
        if (heap.images != (declared(resource).kind == graph::ResourceKind::image)) {
            report(resource, "is in a heap of the other kind");
        }
    }
    bool placed_any() const { return !plan_.heaps.empty(); }

    void check_sharing() {
        const std::vector<std::vector<uint32_t>> sharers = find_sharers(plan_, memory_);
        for (uint32_t a = 0; a < sharers.size(); ++a) {
            for (const uint32_t b : sharers[a]) {
                const bool apart = uses_[a].last_group < uses_[b].first_group ||  //
                                   uses_[b].last_group < uses_[a].first_group;
                if (a < b && !apart) {
                    report(a, "shares bytes with " + graph::quote_resource(graph_, b) + " while both are alive");
                }
            }
        }
    }

    void check_render_pass(const graph::RenderPass& render_pass, const graph::Group& group) {
        const auto attachments = slice(plan_.attachments, render_pass.attachments);
        const auto subpasses = slice(plan_.subpasses, render_pass.subpasses);
        const auto passes = slice(plan_.order, group.passes);
        if (subpasses.size() != passes.size()) {
            problems_.push_back("a subpass is missing");
            return;
        }
        std::vector<uint8_t> met(attachments.size(), 0);
        for (size_t i = 0; i < subpasses.size(); ++i) {
            if (subpasses[i].pass != passes[i]) problems_.push_back("subpasses are out of order");
            check_references(subpasses[i], attachments);
            check_first_uses(subpasses[i].pass, attachments, met);
            check_samples(render_pass, subpasses[i].pass);
        }
        for (size_t i = 0; i < attachments.size(); ++i) {
            const graph::Attachment& attachment = attachments[i];
            const graph::ImageDescription& image = declared(attachment.resource).image;
            if (!met[i]) report(attachment.resource, "is an attachment that no subpass uses");
            if (image.width != render_pass.width || image.height != render_pass.height ||
                image.layers != render_pass.layers) {
                report(attachment.resource, "has another size than the render pass");
            }
            if (has_stencil(image.format) &&
                (attachment.stencil_load != attachment.load || attachment.stencil_store != attachment.store)) {
                report(attachment.resource, "its stencil is not treated as its depth is");
            }
        }
    }

    /// Each subpass references what its pass declares: in the order of locations and indices, inputs with all aspects.
    void check_references(const graph::Subpass& planned, std::span<const graph::Attachment> attachments) {
        std::vector<std::pair<AccessKind, uint32_t>> wanted, found;
        for (const graph::Access& access : graph_.accesses(planned.pass)) {
            if (used_as_attachment(access.kind)) wanted.emplace_back(access.kind, access.resource);
        }
        const auto note = [&](graph::Range range, AccessKind kind) {
            for (const graph::AttachmentReference& reference : slice(plan_.references, range)) {
                const uint32_t resource = attachments[reference.attachment].resource;
                const bool read_only = reference.layout == VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
                const bool depth = kind == AccessKind::depth_stencil_attachment;
                found.emplace_back(depth && read_only ? AccessKind::depth_stencil_read : kind, resource);
                const VkImageAspectFlags aspects =
                    kind == AccessKind::input_attachment ? aspects_of(declared(resource).image.format) : 0;
                if (reference.aspects != aspects) report(resource, "is referenced with other aspects than it has");
            }
        };
        note(planned.colours, AccessKind::colour_attachment);
        note(planned.inputs, AccessKind::input_attachment);
        note(planned.depth_stencil, AccessKind::depth_stencil_attachment);
        const auto by_kind = [](const auto& a, const auto& b) { return a.first < b.first; };
        std::stable_sort(wanted.begin(), wanted.end(), by_kind);
        std::stable_sort(found.begin(), found.end(), by_kind);
        if (wanted != found) problems_.push_back("a subpass does not reference what its pass declares");
    }

    /// The first use of an attachment in the render pass says how it is loaded.
    void check_first_uses(uint32_t pass, std::span<const graph::Attachment> attachments, std::vector<uint8_t>& met) {
        const graph::PassDeclaration& declaration = graph_.declaration().passes[pass];
        for (uint32_t i = 0; i < declaration.access_count; ++i) {
            const uint32_t index = declaration.first_access + i;
            const graph::Access& access = graph_.declaration().accesses[index];
            if (!used_as_attachment(access.kind)) continue;
            size_t at = 0;
            while (at < attachments.size() && attachments[at].resource != access.resource)
                ++at;
            if (at == attachments.size()) return;  // reported as a wrong reference
            if (std::exchange(met[at], uint8_t{1}) != 0) continue;
            const graph::Attachment& attachment = attachments[at];
            const bool clears = access.contents == graph::ContentsKind::clear;
            const bool keeps = !writes(steps_of(access)) || access.contents == graph::ContentsKind::keep;
            const VkAttachmentLoadOp load = keeps    ? VK_ATTACHMENT_LOAD_OP_LOAD
                                            : clears ? VK_ATTACHMENT_LOAD_OP_CLEAR
                                                     : VK_ATTACHMENT_LOAD_OP_DONT_CARE;
            if (attachment.load != load) report(access.resource, "is loaded in another way than its first use needs");
            if (attachment.clear_access != (clears ? index : none)) {
                report(access.resource, "is cleared with the value of another use, or with none");
            }
        }
    }

    void check_samples(const graph::RenderPass& render_pass, uint32_t pass) {
        uint32_t target = none, input = none;
        for (const graph::Access& access : graph_.accesses(pass)) {
            if (!used_as_attachment(access.kind)) continue;
            (access.kind == AccessKind::input_attachment ? input : target) = access.resource;
        }
        const uint32_t decides = target != none ? target : input;
        if (decides != none && declared(decides).image.samples != render_pass.samples) {
            report(decides, "has another number of samples than the render pass");
        }
    }

    /// Memory is needed by whatever outlives its render pass, or is more than an attachment.
    void check_memoryless() {
        std::vector<uint8_t> expected(uses_.size(), 0);
        for (const graph::Attachment& attachment : plan_.attachments) {
            const Use& use = uses_[attachment.resource];
            expected[attachment.resource] =
                declared(attachment.resource).transient() && use.only_attachment && use.first_group == use.last_group &&
                attachment.load != VK_ATTACHMENT_LOAD_OP_LOAD && attachment.store == VK_ATTACHMENT_STORE_OP_DONT_CARE;
        }
        for (uint32_t resource = 0; resource < uses_.size(); ++resource) {
            if (plan_.resources[resource].memoryless != (expected[resource] != 0)) {
                report(resource, expected[resource] != 0 ? "needs no memory and is said to" : "needs memory");
            }
        }
    }

    const graph::Graph& graph_;
    const graph::Plan& plan_;
    const std::vector<graph::MemoryRequirement>& memory_;
    std::vector<Use> uses_;  // one a resource
    std::vector<std::string> problems_;
};

}  // namespace

std::vector<std::string> find_flaws(const graph::Graph& graph, const graph::Plan& plan,
                                    const std::vector<graph::MemoryRequirement>& memory) {
    return PlanChecker(graph, plan, memory).check();
}

std::vector<std::string> find_disorder(const graph::Graph& graph, const graph::Plan& plan) {
    std::vector<std::string> problems;
    const auto& passes = graph.declaration().passes;
    const auto report = [&](uint32_t pass, const char* problem) {
        problems.push_back("pass '" + graph.pass_name(pass) + "' " + problem);
    };
    std::vector<int> seen(passes.size(), 0), culled(passes.size(), 0);
    uint32_t side_effect = 0;
    for (const uint32_t pass : plan.order) {
        ++seen[pass];
        if (!passes[pass].side_effect) continue;
        if (pass < side_effect) problems.emplace_back("side effects out of order");
        side_effect = pass;
    }
    for (const graph::CulledPass& each : plan.culled)
        ++culled[each.pass];
    for (uint32_t pass = 0; pass < passes.size(); ++pass) {
        if (seen[pass] + culled[pass] != 1) report(pass, "is not exactly once in the order or culled");
        if (culled[pass] != 0 && passes[pass].side_effect) report(pass, "has a side effect and was culled");
    }
    size_t next = 0;
    bool tiled = true;
    for (const graph::Group& group : plan.groups) {
        tiled = tiled && group.passes.first == next;
        next = size_t{group.passes.first} + group.passes.count;
    }
    if (!tiled || next != plan.order.size()) problems.emplace_back("groups do not tile the order");
    return problems;
}

std::vector<std::vector<uint32_t>> find_sharers(const graph::Plan& plan,
                                                const std::vector<graph::MemoryRequirement>& memory) {
    std::vector<std::vector<uint32_t>> sharers(plan.resources.size());
    for (uint32_t i = 0; i < plan.resources.size(); ++i) {
        const graph::PlannedResource& a = plan.resources[i];
        if (a.heap == none) continue;
        for (uint32_t j = 0; j < i; ++j) {
            const graph::PlannedResource& b = plan.resources[j];
            if (b.heap != a.heap) continue;
            if (a.offset >= b.offset + memory[j].size || b.offset >= a.offset + memory[i].size) continue;
            sharers[i].push_back(j);
            sharers[j].push_back(i);
        }
    }
    return sharers;
}

std::set<uint32_t> needed_passes(const graph::Graph& graph) {
    const graph::Declaration& declaration = graph.declaration();
    std::set<uint32_t> needed;
    std::set<std::pair<uint32_t, uint32_t>> wanted;  // resource, version
    std::vector<uint32_t> last_version(declaration.resources.size(), 0);
    for (const graph::Access& access : declaration.accesses) {
        if (graph::is_write(access.kind)) last_version[access.resource] = access.version + 1;
    }
    for (uint32_t resource = 0; resource < last_version.size(); ++resource) {
        const graph::ResourceDeclaration& declared = declaration.resources[resource];
        if (declared.imported && declaration.import_of(resource).wanted)
            wanted.insert({resource, last_version[resource]});
    }
    for (bool grew = true; grew;) {
        grew = false;
        for (uint32_t pass = 0; pass < declaration.passes.size(); ++pass) {
            if (needed.count(pass) != 0) continue;
            bool take = declaration.passes[pass].side_effect;
            for (const graph::Access& access : graph.accesses(pass)) {
                take =
                    take || (graph::is_write(access.kind) && wanted.count({access.resource, access.version + 1}) != 0);
            }
            if (!take) continue;
            needed.insert(pass);
            grew = true;
            for (const graph::Access& access : graph.accesses(pass)) {
                if (!graph::is_write(access.kind) || access.contents == graph::ContentsKind::keep) {
                    wanted.insert({access.resource, access.version});
                    if (declaration.resources[access.resource].history == graph::HistoryRole::previous) {
                        wanted.insert({access.resource + 1, last_version[access.resource + 1]});
                    }
                }
            }
        }
    }
    return needed;
}

}  // namespace splice::test
