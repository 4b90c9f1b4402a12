#include "engine/render_graph/executor/compiled_frame.h"

#include <algorithm>
#include <string>
#include <utility>

namespace splice::graph {
namespace {

std::string text_of(const ImageDescription& image) {
    return std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels of format " +
           std::to_string(image.format) + " with " + std::to_string(image.layers) + " layers, " +
           std::to_string(image.mip_levels) + " levels and " + std::to_string(image.samples) + " samples";
}

bool has_lazy_memory(const gpu::Device& device) {
    VkPhysicalDeviceMemoryProperties properties;
    vkGetPhysicalDeviceMemoryProperties(device.physical(), &properties);
    for (uint32_t type = 0; type < properties.memoryTypeCount; ++type) {
        if ((properties.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT) != 0) return true;
    }
    return false;
}

}  // namespace

CompiledFrame::CompiledFrame(gpu::Device& device, RenderPassCache& render_passes, const ExecutorOptions& options,
                             const Graph& graph, uint64_t id)
    : device_(&device),
      id_(id),
      lazy_memory_(has_lazy_memory(device)),
      key_(graph.key()),
      declaration_(graph.declaration()) {
    CompileOptions compile_options;
    compile_options.max_colour_attachments = device.limits().maxColorAttachments;
    compile_options.max_input_attachments = device.limits().maxPerStageDescriptorInputAttachments;
    compile_options.cull = options.cull;
    compile_options.merge = options.merge;
    compile_options.alias = options.alias;
    compile_options.batch_barriers = options.batch_barriers;
    compile_options.random_order = options.random_order;
    compile_options.memory = [this](uint32_t resource, const PlannedResource& planned) {
        return requirement(resource, planned);
    };
    plan_ = compile(graph, compile_options);

    for (const Heap& heap : plan_.heaps) {
        heaps_.push_back(device.memory().allocate({heap.size, heap.alignment, heap.memory_type_bits},
                                                  gpu::MemoryUse::device, heap.images));
        transient_bytes_ += heap.size;
    }
    bound_.resize(declaration_.resources.size());
    needs_binding_.assign(declaration_.resources.size(), 0);
    for (uint32_t resource = 0; resource < declaration_.resources.size(); ++resource) {
        const ResourceDeclaration& declared = declaration_.resources[resource];
        if (plan_.resources[resource].lifetime.first_group == none) continue;
        if (declared.imported) {
            needs_binding_[resource] = 1;
        } else if (declared.history != HistoryRole::none) {
            continue;  // both halves together, below
        } else if (declared.kind == ResourceKind::image) {
            create_image(graph, resource);
        } else {
            create_buffer(graph, resource);
        }
    }
    for (uint32_t resource = 0; resource < declaration_.resources.size(); ++resource) {
        if (declaration_.resources[resource].history == HistoryRole::previous) create_history(graph, resource);
    }
    for (const ImageBarrier& barrier : slice(plan_.image_barriers, plan_.final_barriers.images)) {
        needs_binding_[barrier.resource] = 1;  // only imported resources are handed over
    }
    for (const RenderPass& render_pass : plan_.render_passes) {
        render_passes_.push_back(render_passes.get(declaration_, plan_, render_pass));
    }
    framebuffers_.resize(plan_.render_passes.size());
    fill_in_barriers();
    for (const Attachment& attachment : plan_.attachments)
        views_.push_back(bound_[attachment.resource].image.view);
    clear_values_.resize(plan_.attachments.size());
    find_moving();
    bound_by_.assign(bound_.size(), 0);
    wanted_bindings_ = static_cast<size_t>(std::count(needs_binding_.begin(), needs_binding_.end(), uint8_t{1}));
}

void CompiledFrame::fill_in_barriers() {
    for (const ImageBarrier& planned : plan_.image_barriers) {
        VkImageMemoryBarrier2 barrier{};
        barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
        barrier.srcStageMask = planned.source.stages;
        barrier.srcAccessMask = planned.source.access;
        barrier.dstStageMask = planned.destination.stages;
        barrier.dstAccessMask = planned.destination.access;
        barrier.oldLayout = planned.old_layout;
        barrier.newLayout = planned.new_layout;
        barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        const VkFormat format = declaration_.resources[planned.resource].image.format;
        barrier.image = bound_[planned.resource].image.image;
        barrier.subresourceRange = {gpu::format_aspects(format), 0, VK_REMAINING_MIP_LEVELS, 0,
                                    VK_REMAINING_ARRAY_LAYERS};
        image_barriers_.push_back(barrier);
    }
    for (const BufferBarrier& planned : plan_.buffer_barriers) {
        VkBufferMemoryBarrier2 barrier{};
        barrier.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2;
        barrier.srcStageMask = planned.source.stages;
        barrier.srcAccessMask = planned.source.access;
        barrier.dstStageMask = planned.destination.stages;
        barrier.dstAccessMask = planned.destination.access;
        barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.buffer = bound_[planned.resource].buffer;
        barrier.size = VK_WHOLE_SIZE;
        buffer_barriers_.push_back(barrier);
    }
}

void CompiledFrame::find_moving() {
    const auto collect = [&](const auto& planned, std::vector<uint32_t>& moving) {
        for (uint32_t i = 0; i < planned.size(); ++i) {
            if (!declaration_.resources[planned[i].resource].transient()) moving.push_back(i);
        }
    };
    collect(plan_.image_barriers, moving_image_barriers_);
    collect(plan_.buffer_barriers, moving_buffer_barriers_);
    collect(plan_.attachments, moving_attachments_);
}

void CompiledFrame::update() {
    if (!std::exchange(changed_, false)) return;
    ++bindings_;
    for (const uint32_t i : moving_image_barriers_)
        image_barriers_[i].image = bound_[plan_.image_barriers[i].resource].image.image;
    for (const uint32_t i : moving_buffer_barriers_)
        buffer_barriers_[i].buffer = bound_[plan_.buffer_barriers[i].resource].buffer;
    for (const uint32_t i : moving_attachments_)
        views_[i] = bound_[plan_.attachments[i].resource].image.view;
}

const VkClearValue* CompiledFrame::clear_values(const Graph& graph, uint32_t render_pass) {
    const Range range = plan_.render_passes[render_pass].attachments;
    for (uint32_t i = range.first; i < range.first + range.count; ++i) {
        const uint32_t access = plan_.attachments[i].clear_access;
        if (access != none) clear_values_[i] = graph.clear_value(access);
    }
    return clear_values_.data() + range.first;
}

VkImageCreateInfo CompiledFrame::image_info(uint32_t resource, const PlannedResource& planned) const {
    const ImageDescription& image = declaration_.resources[resource].image;
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = image.format;
    info.extent = {image.width, image.height, 1};
    info.mipLevels = image.mip_levels;
    info.arrayLayers = image.layers;
    info.samples = image.samples;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = planned.image_usage;
    if (planned.memoryless && lazy_memory_) info.usage |= VK_IMAGE_USAGE_TRANSIENT_ATTACHMENT_BIT;
    info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
    info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    return info;
}

VkBufferCreateInfo CompiledFrame::buffer_info(uint32_t resource, const PlannedResource& planned) const {
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = declaration_.resources[resource].buffer.size;
    info.usage = planned.buffer_usage;
    info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
    return info;
}

MemoryRequirement CompiledFrame::requirement(uint32_t resource, const PlannedResource& planned) const {
    VkMemoryRequirements2 requirements{};
    requirements.sType = VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2;
    if (declaration_.resources[resource].kind == ResourceKind::image) {
        if (planned.memoryless && lazy_memory_) return {};
        const VkImageCreateInfo info = image_info(resource, planned);
        VkDeviceImageMemoryRequirements query{};
        query.sType = VK_STRUCTURE_TYPE_DEVICE_IMAGE_MEMORY_REQUIREMENTS;
        query.pCreateInfo = &info;
        vkGetDeviceImageMemoryRequirements(device_->handle(), &query, &requirements);
    } else {
        const VkBufferCreateInfo info = buffer_info(resource, planned);
        VkDeviceBufferMemoryRequirements query{};
        query.sType = VK_STRUCTURE_TYPE_DEVICE_BUFFER_MEMORY_REQUIREMENTS;
        query.pCreateInfo = &info;
        vkGetDeviceBufferMemoryRequirements(device_->handle(), &query, &requirements);
    }
    const VkMemoryRequirements& memory = requirements.memoryRequirements;
    return {memory.size, memory.alignment, memory.memoryTypeBits};
}

void CompiledFrame::create_image(const Graph& graph, uint32_t resource) {
    const PlannedResource& planned = plan_.resources[resource];
    const VkImageCreateInfo info = image_info(resource, planned);
    const gpu::Memory* memory = planned.heap == none ? nullptr : &heaps_[planned.heap];
    bound_[resource].image =
        make_image(graph.resource_name(resource), info, memory, planned.offset, gpu::MemoryUse::lazy);
}

void CompiledFrame::create_buffer(const Graph& graph, uint32_t resource) {
    const PlannedResource& planned = plan_.resources[resource];
    bound_[resource].buffer = make_buffer(graph.resource_name(resource), buffer_info(resource, planned),
                                          &heaps_[planned.heap], planned.offset);
}

/// Two resources that take turns in both roles, with memory of their own.
void CompiledFrame::create_history(const Graph& graph, uint32_t previous) {
    const PlannedResource &a = plan_.resources[previous], &b = plan_.resources[previous + 1];
    if (a.lifetime.first_group == none && b.lifetime.first_group == none) return;
    PlannedResource both;
    both.image_usage = a.image_usage | b.image_usage | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    both.buffer_usage = a.buffer_usage | b.buffer_usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    BoundResource sides[2];
    for (uint32_t side = 0; side < 2; ++side) {
        const std::string name = graph.resource_name(previous + 1) + " (" + std::to_string(side) + ")";
        if (declaration_.resources[previous].kind == ResourceKind::image) {
            sides[side].image = make_image(name, image_info(previous, both), nullptr, 0, gpu::MemoryUse::device);
        } else {
            sides[side].buffer = make_buffer(name, buffer_info(previous, both), nullptr, 0);
        }
    }
    histories_.add(previous, sides[0], sides[1]);
}

BoundImage CompiledFrame::make_image(const std::string& name, const VkImageCreateInfo& info, const gpu::Memory* memory,
                                     uint64_t offset, gpu::MemoryUse own_use) {
    const VkDevice device = device_->handle();
    VkImage handle = VK_NULL_HANDLE;
    TransientImage transient;
    gpu::check(vkCreateImage(device, &info, nullptr, &handle), "creating the image '" + name + "'");
    transient.image = gpu::UniqueImage(device, handle);
    device_->set_name(VK_OBJECT_TYPE_IMAGE, handle, name);
    if (!memory) {
        VkMemoryRequirements requirements;
        vkGetImageMemoryRequirements(device, handle, &requirements);
        memory = &own_memory_.emplace_back(device_->memory().allocate(requirements, own_use, true));
    }
    gpu::check(vkBindImageMemory(device, handle, memory->handle(), memory->offset() + offset),
               "binding the memory of '" + name + "'");
    BoundImage bound;
    bound.image = handle;
    bound.usage = info.usage;
    constexpr VkImageUsageFlags viewable =
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
    ++created_;
    if ((info.usage & viewable) != 0) {
        const VkImageAspectFlags aspects = gpu::format_aspects(info.format);
        const auto view_of = [&](VkImageAspectFlags wanted) {
            ++created_;
            return gpu::create_image_view(*device_, handle, info.format, wanted, info.arrayLayers);
        };
        transient.view = view_of(aspects);
        bound.view = bound.depth_view = bound.stencil_view = transient.view.get();
        if (aspects == (VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT)) {
            transient.depth_view = view_of(VK_IMAGE_ASPECT_DEPTH_BIT);
            transient.stencil_view = view_of(VK_IMAGE_ASPECT_STENCIL_BIT);
            bound.depth_view = transient.depth_view.get();
            bound.stencil_view = transient.stencil_view.get();
        }
    }
    images_.push_back(std::move(transient));
    return bound;
}

VkBuffer CompiledFrame::make_buffer(const std::string& name, const VkBufferCreateInfo& info, const gpu::Memory* memory,
                                    uint64_t offset) {
    const VkDevice device = device_->handle();
    VkBuffer handle = VK_NULL_HANDLE;
    gpu::check(vkCreateBuffer(device, &info, nullptr, &handle), "creating the buffer '" + name + "'");
    buffers_.emplace_back(device, handle);
    device_->set_name(VK_OBJECT_TYPE_BUFFER, handle, name);
    if (!memory) {
        VkMemoryRequirements requirements;
        vkGetBufferMemoryRequirements(device, handle, &requirements);
        memory = &own_memory_.emplace_back(device_->memory().allocate(requirements, gpu::MemoryUse::device, false));
    }
    gpu::check(vkBindBufferMemory(device, handle, memory->handle(), memory->offset() + offset),
               "binding the memory of '" + name + "'");
    ++created_;
    return handle;
}

void CompiledFrame::bind(const Graph& graph, const Bindings& bindings) {
    ++bind_calls_;
    size_t missing = wanted_bindings_;
    for (const Bindings::Entry& entry : bindings.entries()) {
        if (entry.resource >= declaration_.resources.size() || !declaration_.resources[entry.resource].imported) {
            const bool known = entry.resource < declaration_.resources.size();
            throw GraphError("a binding names " +
                             (known ? quote_resource(graph, entry.resource)
                                    : "resource " + std::to_string(entry.resource) + " of " +
                                          std::to_string(declaration_.resources.size())) +
                             ", which the graph does not import; bind what import_image or import_buffer returned");
        }
        const ResourceDeclaration& declared = declaration_.resources[entry.resource];
        const PlannedResource& planned = plan_.resources[entry.resource];
        const auto name = [&] { return quote_resource(graph, entry.resource); };
        if (declared.kind == ResourceKind::image) {
            if (entry.bound.image.image == VK_NULL_HANDLE || !(entry.image == declared.image)) {
                throw GraphError(name() + ": what is bound, " + text_of(entry.image) +
                                 ", differs from the declaration, " + text_of(declared.image) +
                                 "; declare it as it is");
            }
            if ((planned.image_usage & ~entry.bound.image.usage) != 0) {
                throw GraphError(name() + ": what is bound was created without a usage that the passes need");
            }
        } else if (entry.bound.buffer == VK_NULL_HANDLE || entry.buffer.size < declared.buffer.size) {
            throw GraphError(name() + ": what is bound is smaller than the " + std::to_string(declared.buffer.size) +
                             " bytes declared");
        }
        BoundResource& bound = bound_[entry.resource];
        changed_ = changed_ || bound.image.image != entry.bound.image.image ||
                   bound.image.view != entry.bound.image.view || bound.buffer != entry.bound.buffer;
        bound = entry.bound;
        if (needs_binding_[entry.resource] && bound_by_[entry.resource] != bind_calls_) --missing;
        bound_by_[entry.resource] = bind_calls_;
    }
    for (uint32_t resource = 0; missing > 0; ++resource) {
        if (needs_binding_[resource] && bound_by_[resource] != bind_calls_) {
            throw GraphError(quote_resource(graph, resource) + ": is imported but not bound; add it to the bindings");
        }
    }
}

VkFramebuffer CompiledFrame::framebuffer(uint32_t render_pass) {
    const RenderPass& planned = plan_.render_passes[render_pass];
    Framebuffer& cached = framebuffers_[render_pass];
    const std::span<const Attachment> attachments = slice(plan_.attachments, planned.attachments);
    if (cached.checked == bindings_) return cached.handle.get();
    cached.checked = bindings_;
    bool fits = static_cast<bool>(cached.handle);
    for (size_t i = 0; fits && i < attachments.size(); ++i) {
        fits = cached.usages[i] == bound_[attachments[i].resource].image.usage;
    }
    if (fits) return cached.handle.get();

    // Without images: swapchain images come and go, the framebuffer stays.
    cached.usages.clear();
    std::vector<VkFramebufferAttachmentImageInfo> infos;
    for (const Attachment& attachment : attachments) {
        const ImageDescription& image = declaration_.resources[attachment.resource].image;
        cached.usages.push_back(bound_[attachment.resource].image.usage);
        VkFramebufferAttachmentImageInfo info{};
        info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_ATTACHMENT_IMAGE_INFO;
        info.usage = cached.usages.back();
        info.width = image.width;
        info.height = image.height;
        info.layerCount = image.layers;
        info.viewFormatCount = 1;
        info.pViewFormats = &image.format;
        infos.push_back(info);
    }
    VkFramebufferAttachmentsCreateInfo images{};
    images.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_ATTACHMENTS_CREATE_INFO;
    images.attachmentImageInfoCount = static_cast<uint32_t>(infos.size());
    images.pAttachmentImageInfos = infos.data();
    VkFramebufferCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    create.pNext = &images;
    create.flags = VK_FRAMEBUFFER_CREATE_IMAGELESS_BIT;
    create.renderPass = render_passes_[render_pass]->get();
    create.attachmentCount = static_cast<uint32_t>(infos.size());
    create.width = planned.width;
    create.height = planned.height;
    create.layers = planned.layers;
    VkFramebuffer handle = VK_NULL_HANDLE;
    gpu::check(vkCreateFramebuffer(device_->handle(), &create, nullptr, &handle), "creating a framebuffer");
    cached.handle = gpu::UniqueFramebuffer(device_->handle(), handle);
    ++created_;
    return handle;
}

}  // namespace splice::graph
