// A deferred renderer. Lights read the G-buffer at their own pixel, so they merge with the pass that draws it, although
// the shadow maps are declared in between; what looks around a pixel (occlusion, bloom) cannot.
#include "engine/bench/graph/deferred.h"
#include "engine/bench/graph/family_declaration.h"

namespace splice::bench {
namespace {

using graph::Contents;

constexpr VkPipelineStageFlags kFragment = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;

class ViewBuilder {
  public:
    ViewBuilder(FamilyBuilder& builder, uint32_t view, bool numbered)
        : builder_(builder),
          prefix_(numbered ? "view " + std::to_string(view) + " " : ""),
          size_(builder.description(VK_FORMAT_UNDEFINED)) {}

    void declare(const DeferredView& view) {
        draw_geometry();
        for (uint32_t light = 0; light < view.lights; ++light)
            add_light(light);
        add_occlusion(view.blur_occlusion);
        add_ambient(view.lights == 0);
        add_bloom(view.bloom_levels);
        map_tones();
    }

  private:
    graph::ImageHandle image(const std::string& name, VkFormat format, uint32_t level = 0) {
        graph::ImageDescription description = size_;
        description.format = format;
        description.width = std::max(size_.width >> level, 1U);
        description.height = std::max(size_.height >> level, 1U);
        return builder_.image(prefix_ + name, description);
    }

    void draw_geometry() {
        albedo_ = image("albedo", VK_FORMAT_R8G8B8A8_UNORM);
        normal_ = image("normal", VK_FORMAT_R16G16B16A16_SFLOAT);
        depth_ = image("depth", VK_FORMAT_D32_SFLOAT);
        graph::Pass pass = builder_.pass(prefix_ + "g-buffer");
        albedo_ = pass.colour_attachment(albedo_, Contents::clear(graph::clear_colour(0, 0, 0, 0)));
        normal_ = pass.colour_attachment(normal_, Contents::clear(graph::clear_colour(0, 0, 0, 0)));
        depth_ = pass.depth_stencil_attachment(depth_, Contents::clear(graph::clear_depth_stencil(0, 0)));
        builder_.finish(pass);
        light_ = image("light", VK_FORMAT_R16G16B16A16_SFLOAT);
    }

    void add_light(uint32_t light) {
        const std::string number = std::to_string(light);
        const uint32_t side = std::min(kShadowMapSize, size_.width);
        auto shadow = builder_.image(prefix_ + "shadow " + number,
                                     {.format = VK_FORMAT_D16_UNORM, .width = side, .height = side});
        graph::Pass caster = builder_.pass(prefix_ + "shadow " + number);
        shadow = caster.depth_stencil_attachment(shadow, Contents::clear(graph::clear_depth_stencil(0, 0)));
        builder_.finish(caster);

        graph::Pass pass = builder_.pass(prefix_ + "light " + number);
        pass.input_attachment(albedo_);
        pass.input_attachment(normal_);
        pass.input_attachment(depth_);
        pass.sampled(shadow, kFragment);
        light_ = pass.colour_attachment(
            light_, light == 0 ? Contents::clear(graph::clear_colour(0, 0, 0, 0)) : Contents::keep());
        builder_.finish(pass);
    }

    void add_occlusion(bool blur) {
        occlusion_ = builder_.filter(prefix_ + "occlusion", {depth_, normal_}, image("occlusion", VK_FORMAT_R8_UNORM));
        if (!blur) return;
        occlusion_ =
            builder_.filter(prefix_ + "blur occlusion", {occlusion_}, image("blurred occlusion", VK_FORMAT_R8_UNORM));
    }

    void add_ambient(bool first_light) {
        graph::Pass pass = builder_.pass(prefix_ + "ambient");
        pass.input_attachment(albedo_);
        pass.sampled(occlusion_, kFragment);
        light_ = pass.colour_attachment(
            light_, first_light ? Contents::clear(graph::clear_colour(0, 0, 0, 0)) : Contents::keep());
        builder_.finish(pass);
    }

    /// Half the size each level down; on the way up each level is added to the next larger one.
    void add_bloom(uint32_t levels) {
        std::vector<graph::ImageHandle> pyramid{light_};
        for (uint32_t level = 1; level <= levels; ++level) {
            const std::string name = "bloom " + std::to_string(level);
            pyramid.push_back(builder_.filter(prefix_ + name + " down", {pyramid.back()},
                                              image(name, VK_FORMAT_R16G16B16A16_SFLOAT, level)));
        }
        for (uint32_t level = levels; level > 0; --level) {
            graph::Pass pass = builder_.pass(prefix_ + "bloom " + std::to_string(level) + " up");
            pass.sampled(pyramid[level], kFragment);
            pyramid[level - 1] = pass.colour_attachment(pyramid[level - 1], Contents::keep());
            builder_.finish(pass);
        }
        light_ = pyramid[0];
    }

    void map_tones() {
        graph::ImageDescription description = size_;
        description.format = VK_FORMAT_R8G8B8A8_UNORM;
        const auto picture = builder_.output(prefix_ + "picture", description);
        graph::Pass pass = builder_.pass(prefix_ + "tone map");
        pass.input_attachment(light_);
        pass.colour_attachment(picture, Contents::discard());
        builder_.finish(pass);
    }

    FamilyBuilder& builder_;
    std::string prefix_;
    graph::ImageDescription size_;
    graph::ImageHandle albedo_, normal_, depth_, light_, occlusion_;
};

}  // namespace

void declare_deferred(graph::Graph& graph, const FamilyOptions& options) {
    FamilyBuilder builder(graph, options);
    const uint32_t views = std::max(options.passes / kDeferredViewPasses, 1U);
    for (uint32_t view = 0; view < views; ++view) {
        const bool last = view + 1 == views;
        const uint32_t passes = last ? options.passes - view * kDeferredViewPasses : kDeferredViewPasses;
        ViewBuilder(builder, view, views > 1).declare(DeferredView::of(passes));
    }
}

}  // namespace splice::bench
