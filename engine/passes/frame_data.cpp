#include "engine/passes/frame_data.h"

#include "engine/scene/surfel_store.h"
#include "preprocess/model_format/error.h"

#include <bit>
#include <cstring>
#include <string>
#include <vector>

namespace splice {

namespace {

// The view of sampling (thesis figure 4.4) has to show single disks: so few, and so much smaller, that they lie apart.
constexpr float kSampleShare = 0.12f;
constexpr float kSampleRadius = 0.6f;
constexpr std::size_t kLightTexels = sizeof(LightRecord) / 16;

LightRecord light_record(const Light& light, const glm::dmat4& view) {
    const glm::dmat4 to_view = light.space == LightSpace::kWorld ? view : glm::dmat4(1.0);
    LightRecord record{};
    if (light.kind == LightKind::kDirectional) {
        record.vector = glm::vec4(glm::normalize(-glm::dmat3(to_view) * light.direction), 0);
        record.colour = glm::vec4(light.colour, 0);
    } else {
        record.vector = glm::vec4(glm::dvec3(to_view * glm::dvec4(light.position, 1)), 1);
        record.colour = glm::vec4(light.colour, 1 / (light.range * light.range));
    }
    return record;
}

}  // namespace

bool is_numeric(View view) {
    return view == View::kDepth || view == View::kVisibility || view == View::kOverlap;
}

std::uint32_t lighting_flags(const Lighting& lighting) {
    std::uint32_t flags = 0;
    if (lighting.specular > 0) flags |= kLightingHighlights;
    if (lighting.highlight == HighlightModel::kPhong) flags |= kLightingPhong;
    if (lighting.rim > 0) flags |= kLightingRim;
    for (const Light& light : lighting.lights)
        if (light.kind == LightKind::kPoint) flags |= kLightingLamps;
    return flags;
}

bool is_deferred(const FrameSettings& settings) {
    return settings.shading == Shading::kDeferred && !is_numeric(settings.view) && settings.view != View::kNormals &&
           settings.view != View::kAccumulation;
}

gpu::DescriptorSetLayout frame_set_layout(const gpu::Device& device) {
    const VkShaderStageFlags stages =
        VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;
    return {
        device,
        {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, stages, 1}, {1, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, stages, 1}}};
}

FrameData::FrameData(gpu::Device& device)
    : device_(device),
      layout_(frame_set_layout(device)),
      pool_(device),
      uniforms_(device, {.size = sizeof(FrameUniforms),
                         .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                         .memory = gpu::MemoryUse::upload,
                         .name = "frame uniforms"}),
      set_(pool_.allocate(layout_)) {
    reserve_lights(1);
}

void FrameData::reserve_lights(std::size_t count) {
    const std::size_t most = device_.limits().maxTexelBufferElements / kLightTexels;
    if (count > most)
        throw UsageError("a scene of " + std::to_string(count) + " lights: this device can take " +
                         std::to_string(most));
    if (lights_ && lights_.size() >= count * sizeof(LightRecord)) return;
    lights_ = gpu::Buffer(device_, {.size = count * sizeof(LightRecord),
                                    .usage = VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
                                    .memory = gpu::MemoryUse::upload,
                                    .name = "lights"});
    light_view_ = gpu::create_texel_view(device_, lights_, VK_FORMAT_R32G32B32A32_SFLOAT);
    gpu::DescriptorWriter(set_)
        .uniform_buffer(0, uniforms_.handle())
        .sampled_texels(1, light_view_.get())
        .write(device_);
}

void FrameData::update(const FrameSettings& settings, const Lighting& lighting, const Background& background) {
    const Camera& camera = settings.camera;
    FrameUniforms uniforms{};
    uniforms.projection = glm::mat4(projection_matrix(camera, settings.width, settings.height));
    uniforms.viewport = glm::vec2(settings.width, settings.height);
    uniforms.pixel_scale = static_cast<float>(pixel_scale(camera, settings.height));
    uniforms.near_plane = static_cast<float>(camera.near_plane);
    uniforms.far_plane = static_cast<float>(camera.far_plane);
    uniforms.prefilter = settings.prefilter ? 1 : 0;
    uniforms.ambient = glm::vec3(lighting.ambient);
    uniforms.light_count = static_cast<std::uint32_t>(lighting.lights.size());
    uniforms.specular = static_cast<float>(lighting.specular);
    uniforms.shininess = static_cast<float>(lighting.shininess);
    uniforms.rim = static_cast<float>(lighting.rim);
    uniforms.rim_exponent = static_cast<float>(lighting.rim_exponent);
    uniforms.sample_share = kSampleShare;
    uniforms.sample_radius = kSampleRadius;
    uniforms.background = glm::vec4(linear_light(background.colour), background.transparent ? 0 : 1);
    uniforms.samples_per_side = settings.antialias;
    std::memcpy(uniforms_.mapped().data(), &uniforms, sizeof uniforms);

    const glm::dmat4 view = view_matrix(camera);
    std::vector<LightRecord> records;
    for (const Light& light : lighting.lights)
        records.push_back(light_record(light, view));
    reserve_lights(records.size());
    if (!records.empty()) std::memcpy(lights_.mapped().data(), records.data(), records.size() * sizeof(LightRecord));
}

FrameVariant frame_variant(const FrameSettings& settings) {
    return {static_cast<std::uint32_t>(settings.view), settings.camera.orthographic ? 1u : 0u, is_deferred(settings),
            settings.lighting, settings.kernel};
}

std::map<std::uint32_t, std::uint32_t> frame_constants(const FrameSettings& settings) {
    const FrameVariant variant = frame_variant(settings);
    const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
    const Kernel& kernel = variant.kernel;
    return {{1, variant.view},          {2, variant.orthographic},
            {6, variant.lighting},      {20, static_cast<std::uint32_t>(kernel.shape)},
            {21, bits(kernel.support)}, {22, bits(kernel.moment)},
            {23, bits(kernel.a)},       {24, bits(kernel.n)}};
}

InstanceConstants instance_constants(const InstanceDraws& draws, double epsilon_scale) {
    InstanceConstants constants{};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            constants.model_to_view[row][column] = static_cast<float>(draws.model_to_view[column][row]);
    constants.scale = static_cast<float>(draws.scale);
    constants.epsilon_scale = static_cast<float>(epsilon_scale);
    constants.flags = draws.two_sided ? kInstanceTwoSided : 0u;
    if (draws.surfels != nullptr && draws.surfels->is_packed()) constants.flags |= kInstancePacked;
    constants.first_patch = draws.first_patch;
    return constants;
}

}  // namespace splice
