#include "engine/viewer/presenter.h"

#include "engine/passes/read_back_pass.h"
#include "engine/render_graph/executor/pass_context.h"

#include <algorithm>

namespace splice {

namespace {

constexpr VkClearColorValue kEmptyWindow{{0.16F, 0.17F, 0.19F, 1}};

// Blits must stay inside both images; the window may have shrunk since the pictures were laid out.
void blit(VkCommandBuffer commands, const ShownPicture& picture, VkImage window, VkExtent2D extent) {
    const PixelRect& from = picture.source;
    const PixelRect& to = picture.destination;
    const auto inside = [](std::int32_t value, std::uint32_t size) {
        return std::clamp(value, 0, static_cast<std::int32_t>(size));
    };
    VkImageBlit region{};
    region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.dstSubresource = region.srcSubresource;
    region.dstOffsets[0] = {inside(to.x, extent.width), inside(to.y, extent.height), 0};
    region.dstOffsets[1] = {inside(to.x + to.width, extent.width), inside(to.y + to.height, extent.height), 1};
    const bool scaled = from.width != to.width || from.height != to.height;
    const std::int32_t width = region.dstOffsets[1].x - region.dstOffsets[0].x;
    const std::int32_t height = region.dstOffsets[1].y - region.dstOffsets[0].y;
    if (width <= 0 || height <= 0) return;
    region.srcOffsets[0] = {from.x, from.y, 0};
    region.srcOffsets[1] = {from.x + (scaled ? from.width : width), from.y + (scaled ? from.height : height), 1};
    vkCmdBlitImage(commands, picture.image->handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, window,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, scaled ? VK_FILTER_LINEAR : VK_FILTER_NEAREST);
}

// Parts of an image to the same place in another of the same size.
void copy(VkCommandBuffer commands, const std::vector<PixelRect>& parts, VkImage from, VkImage to, VkExtent2D extent) {
    std::vector<VkImageCopy> regions;
    for (const PixelRect& part : parts) {
        if (part.x < 0 || part.y < 0 || part.width <= 0 || part.height <= 0) continue;
        VkImageCopy region{};
        region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.dstSubresource = region.srcSubresource;
        region.srcOffset = region.dstOffset = {part.x, part.y, 0};
        // The window may be smaller than when the panels were laid out.
        const auto inside = [](std::int32_t from_, std::int32_t size, std::uint32_t limit) {
            return static_cast<std::uint32_t>(std::clamp(static_cast<std::int32_t>(limit) - from_, 0, size));
        };
        region.extent = {inside(part.x, part.width, extent.width), inside(part.y, part.height, extent.height), 1};
        if (region.extent.width > 0 && region.extent.height > 0) regions.push_back(region);
    }
    if (regions.empty()) return;
    vkCmdCopyImage(commands, from, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                   static_cast<std::uint32_t>(regions.size()), regions.data());
}

// The acquire semaphore is waited for where copies begin.
constexpr graph::ExternalUse kAcquired{{VK_PIPELINE_STAGE_TRANSFER_BIT, 0}, VK_IMAGE_LAYOUT_UNDEFINED};

}  // namespace

Presenter::Presenter(gpu::Device& device, VkSurfaceKHR surface, gpu::PresentMode mode)
    : device_(device), swapchain_(device, surface), wanted_mode_(mode), executor_(device, {.timestamps = false}) {}

void Presenter::reserve_kept() {
    const VkExtent2D extent = swapchain_.extent();
    if (kept_.image && kept_.image.options().width == extent.width && kept_.image.options().height == extent.height)
        return;
    kept_ = KeptInterface();
    kept_.image = gpu::Image(device_, {.format = swapchain_.format(),
                                       .width = extent.width,
                                       .height = extent.height,
                                       .usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                       .name = "kept panels"});
}

void Presenter::keep(const ShownInterface& interface) {
    kept_.panels = interface.panels;
    kept_.revision.reset();
    if (interface.only_panels) kept_.revision = interface.revision;
}

graph::ImageHandle Presenter::declare(const std::vector<ShownPicture>& pictures, const ShownInterface& interface,
                                      graph::Bindings& bindings, std::uint32_t image) {
    graph_.clear();
    const bool keeps = reads_window();
    if (keeps) reserve_kept();
    const bool again =
        keeps && interface.only_panels && kept_.revision == interface.revision && kept_.panels == interface.panels;
    const VkExtent2D extent = swapchain_.extent();
    const graph::ImageDescription description{
        .format = swapchain_.format(), .width = extent.width, .height = extent.height};
    graph::ImageHandle window =
        graph_.import_image("window", description, {.before = kAcquired, .after = graph::external::present()});
    bindings.bind(window,
                  graph::BoundImage{swapchain_.image(image), swapchain_.view(image), swapchain_.view(image),
                                    VK_NULL_HANDLE, swapchain_.usage()},
                  description);

    graph::ImageHandle kept;
    if (keeps) {
        kept = graph_.import_image("kept panels", description,
                                   {.before = again ? graph::external::transfer_read() : graph::external::none(),
                                    .after = graph::external::transfer_read()});
        bindings.bind(kept, kept_.image);
    }

    graph::Pass show = graph_.add_pass("show", graph::PassKind::transfer);
    if (again) show.transfer_read(kept);
    window = show.transfer_write(window, graph::Contents::discard());
    show.record([window, kept, again, extent, &pictures, &interface](const graph::PassContext& context) {
        if (pictures.empty()) {
            const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
            vkCmdClearColorImage(context.commands, context.image(window), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                 &kEmptyWindow, 1, &all);
        }
        for (const ShownPicture& picture : pictures)
            blit(context.commands, picture, context.image(window), extent);
        if (again) copy(context.commands, interface.panels, context.image(kept), context.image(window), extent);
    });
    if (again) return window;

    graph::Pass draw = graph_.add_pass("interface", graph::PassKind::graphics);
    window = draw.colour_attachment(window, graph::Contents::keep());
    draw.record(interface.draw);
    if (!keeps) return window;

    graph::Pass keep_panels = graph_.add_pass("keep", graph::PassKind::transfer);
    keep_panels.transfer_read(window);
    kept = keep_panels.transfer_write(kept, graph::Contents::discard());
    keep_panels.record([window, kept, extent, &interface](const graph::PassContext& context) {
        copy(context.commands, interface.panels, context.image(window), context.image(kept), extent);
    });
    keep(interface);
    return window;
}

void Presenter::read_back(graph::ImageHandle image, graph::Bindings& bindings) {
    const VkExtent2D extent = swapchain_.extent();
    const std::uint64_t bytes = std::uint64_t{4} * extent.width * extent.height;
    if (!pixels_ || pixels_.size() != bytes)
        pixels_ = gpu::Buffer(device_, {.size = bytes,
                                        .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                        .memory = gpu::MemoryUse::readback,
                                        .name = "window pixels"});
    const graph::BufferHandle destination =
        graph_.import_buffer("pixels", {bytes}, {.after = graph::external::host_read()});
    bindings.bind(destination, pixels_);
    add_read_back(graph_, image, destination, extent.width, extent.height);
}

void Presenter::take_pixels(WindowPixels& pixels) const {
    pixels.width = swapchain_.extent().width;
    pixels.height = swapchain_.extent().height;
    pixels.rgba.resize(pixels_.size());
    const bool blue_first = swapchain_.format() == VK_FORMAT_B8G8R8A8_UNORM;
    const std::span<const std::byte> mapped = pixels_.mapped();
    for (std::size_t i = 0; i < mapped.size(); ++i)
        pixels.rgba[i] = i % 4 == 3 ? 255 : static_cast<std::uint8_t>(mapped[blue_first && i % 2 == 0 ? i ^ 2 : i]);
}

bool Presenter::present(VkExtent2D window, const std::vector<ShownPicture>& pictures, const ShownInterface& interface,
                        WindowPixels* pixels) {
    const bool same_mode = swapchain_.mode() == wanted_mode_;
    if (!swapchain_.fits(window) || !same_mode) {
        if (!swapchain_.recreate(window, wanted_mode_)) return false;
        wanted_mode_ = swapchain_.mode();
    }
    const std::optional<std::uint32_t> image = swapchain_.acquire();
    if (!image) return false;
    graph::Bindings bindings;
    const graph::ImageHandle shown = declare(pictures, interface, bindings, *image);
    const bool reads = pixels != nullptr && reads_window();
    if (reads) read_back(shown, bindings);
    device_.submit_and_wait([&](VkCommandBuffer commands) { executor_.execute(graph_, bindings, commands); },
                            swapchain_.semaphores(VK_PIPELINE_STAGE_TRANSFER_BIT));
    swapchain_.present();
    if (reads) take_pixels(*pixels);
    return pixels == nullptr || reads;
}

}  // namespace splice
