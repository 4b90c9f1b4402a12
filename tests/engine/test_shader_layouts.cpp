// The structures that C++ and GLSL share are declared twice; here the compiled shaders are reflected and compared with
// the C++ side, member by member.
#include "engine/passes/shader_types.h"
#include "engine/passes/splat_buffers.h"
#include "engine/scene/draw_list.h"
#include "preprocess/model_format/model_format.h"
#include "preprocess/model_format/packed_surfel.h"
#include "preprocess/model_format/surfel_clip.h"
#include "preprocess/model_format/surfel_extent.h"
#include "shaders/deferred_attribute_frag.h"
#include "shaders/deferred_attribute_vert.h"
#include "shaders/deferred_shade_frag.h"
#include "shaders/list_fill_comp.h"
#include "shaders/list_scan_comp.h"
#include "shaders/point_attributes_comp.h"
#include "shaders/point_sums_comp.h"
#include "shaders/point_visibility_comp.h"
#include "shaders/raster_attribute_vert.h"
#include "shaders/raster_deferred_vert.h"
#include "shaders/raster_visibility_vert.h"
#include "shaders/resolve_frag.h"
#include "shaders/splat_setup_comp.h"
#include "shaders/surfel_attribute_frag.h"
#include "shaders/surfel_attribute_vert.h"
#include "shaders/surfel_normalise_frag.h"
#include "shaders/surfel_visibility_frag.h"
#include "shaders/surfel_visibility_vert.h"
#include "shaders/tile_gather_comp.h"
#include "shaders/triangle_frag.h"
#include "shaders/triangle_vert.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>
#include <spirv_cross/spirv_cross_c.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <span>
#include <string>
#include <vector>

using namespace splice;

namespace {

struct Layout {
    std::size_t size = 0;
    std::vector<unsigned> offsets;  // of the members in order; shaders are compiled without their names
};

class Reflection {
  public:
    explicit Reflection(std::span<const std::uint32_t> words) {
        REQUIRE(spvc_context_create(&context_) == SPVC_SUCCESS);
        spvc_parsed_ir ir = nullptr;
        REQUIRE(spvc_context_parse_spirv(context_, words.data(), words.size(), &ir) == SPVC_SUCCESS);
        REQUIRE(spvc_context_create_compiler(context_, SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP,
                                             &compiler_) == SPVC_SUCCESS);
    }
    ~Reflection() { spvc_context_destroy(context_); }
    Reflection(const Reflection&) = delete;
    Reflection& operator=(const Reflection&) = delete;

    /// The blocks of this kind at the descriptor set's binding, by default at any. `inside`: of the elements of the
    /// runtime array that is their only member.
    std::vector<Layout> blocks(spvc_resource_type kind, bool inside = false, unsigned set = 0,
                               std::optional<unsigned> binding = {}) const {
        spvc_resources resources = nullptr;
        REQUIRE(spvc_compiler_create_shader_resources(compiler_, &resources) == SPVC_SUCCESS);
        const spvc_reflected_resource* list = nullptr;
        std::size_t count = 0;
        REQUIRE(spvc_resources_get_resource_list_for_type(resources, kind, &list, &count) == SPVC_SUCCESS);
        std::vector<Layout> layouts;
        for (std::size_t i = 0; i < count; ++i) {
            if (kind != SPVC_RESOURCE_TYPE_PUSH_CONSTANT &&
                spvc_compiler_get_decoration(compiler_, list[i].id, SpvDecorationDescriptorSet) != set)
                continue;
            if (binding && spvc_compiler_get_decoration(compiler_, list[i].id, SpvDecorationBinding) != *binding)
                continue;
            spvc_type_id id = list[i].base_type_id;
            if (inside) {
                const spvc_type outer = spvc_compiler_get_type_handle(compiler_, id);
                const spvc_type array = spvc_compiler_get_type_handle(compiler_, spvc_type_get_member_type(outer, 0));
                id = spvc_type_get_base_type_id(array);
            }
            layouts.push_back(layout_of(id));
        }
        return layouts;
    }

  private:
    Layout layout_of(spvc_type_id id) const {
        const spvc_type type = spvc_compiler_get_type_handle(compiler_, id);
        Layout layout;
        REQUIRE(spvc_compiler_get_declared_struct_size(compiler_, type, &layout.size) == SPVC_SUCCESS);
        for (unsigned i = 0; i < spvc_type_get_num_member_types(type); ++i) {
            unsigned offset = 0;
            REQUIRE(spvc_compiler_type_struct_member_offset(compiler_, type, i, &offset) == SPVC_SUCCESS);
            layout.offsets.push_back(offset);
        }
        return layout;
    }

    spvc_context context_ = nullptr;
    spvc_compiler compiler_ = nullptr;
};

std::vector<std::pair<std::string, std::span<const std::uint32_t>>> shaders() {
    return {{"surfel_attribute.vert", surfel_attribute_vert},
            {"surfel_attribute.frag", surfel_attribute_frag},
            {"surfel_visibility.vert", surfel_visibility_vert},
            {"surfel_visibility.frag", surfel_visibility_frag},
            {"surfel_normalise.frag", surfel_normalise_frag},
            {"resolve.frag", resolve_frag},
            {"deferred_attribute.vert", deferred_attribute_vert},
            {"deferred_attribute.frag", deferred_attribute_frag},
            {"deferred_shade.frag", deferred_shade_frag},
            {"splat_setup.comp", splat_setup_comp},
            {"list_scan.comp", list_scan_comp},
            {"list_fill.comp", list_fill_comp},
            {"point_visibility.comp", point_visibility_comp},
            {"point_attributes.comp", point_attributes_comp},
            {"point_sums.comp", point_sums_comp},
            {"raster_visibility.vert", raster_visibility_vert},
            {"raster_attribute.vert", raster_attribute_vert},
            {"raster_deferred.vert", raster_deferred_vert},
            {"tile_gather.comp", tile_gather_comp},
            {"triangle.vert", triangle_vert},
            {"triangle.frag", triangle_frag}};
}

// Every block of the kind in every shader; at least one shader must have it.
void expect_everywhere(spvc_resource_type kind, bool inside, const Layout& expected, unsigned set = 0,
                       std::optional<unsigned> binding = {}) {
    int found = 0;
    for (const auto& [name, words] : shaders()) {
        CAPTURE(name);
        for (const Layout& layout : Reflection(words).blocks(kind, inside, set, binding)) {
            ++found;
            CHECK(layout.size == expected.size);
            CHECK(layout.offsets == expected.offsets);
        }
    }
    CHECK(found > 0);
}

// Of a shader's source.
double constant(const std::string& file, const std::string& name, int component = 0) {
    std::ifstream stream(test::source_file("shaders/glsl/" + file));
    const std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    std::smatch match;
    CAPTURE(file, name);
    REQUIRE(std::regex_search(text, match,
                              std::regex(name + R"( = (?:u?vec[23]\()?)" +
                                         (component == 0   ? ""
                                          : component == 1 ? "[0-9.]+, "
                                                           : "[0-9.]+, [0-9.]+, ") +
                                         R"((-?[0-9.]+))")));
    return std::stod(match[1]);
}

}  // namespace

#define MEMBER(structure, name) static_cast<unsigned>(offsetof(structure, name))

TEST_CASE("frame uniforms have the layout that the shaders declare") {
    expect_everywhere(
        SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, false,
        {offsetof(FrameUniforms, padding),  // the declared size leaves the final rounding out
         {MEMBER(FrameUniforms, projection), MEMBER(FrameUniforms, viewport), MEMBER(FrameUniforms, pixel_scale),
          MEMBER(FrameUniforms, near_plane), MEMBER(FrameUniforms, far_plane), MEMBER(FrameUniforms, prefilter),
          MEMBER(FrameUniforms, sample_share), MEMBER(FrameUniforms, sample_radius), MEMBER(FrameUniforms, ambient),
          MEMBER(FrameUniforms, light_count), MEMBER(FrameUniforms, specular), MEMBER(FrameUniforms, shininess),
          MEMBER(FrameUniforms, rim), MEMBER(FrameUniforms, rim_exponent), MEMBER(FrameUniforms, background),
          MEMBER(FrameUniforms, samples_per_side)}});
}

TEST_CASE("light records have the layout that the shaders declare") {
    // Texels of 16 bytes, in this order (frame.glsl, light_record).
    CHECK(MEMBER(LightRecord, vector) == 0);
    CHECK(MEMBER(LightRecord, colour) == 16);
    CHECK(sizeof(LightRecord) == 32);
}

TEST_CASE("instance constants have the layout that the shaders declare") {
    expect_everywhere(SPVC_RESOURCE_TYPE_PUSH_CONSTANT, false,
                      {sizeof(InstanceConstants),
                       {MEMBER(InstanceConstants, model_to_view), MEMBER(InstanceConstants, scale),
                        MEMBER(InstanceConstants, epsilon_scale), MEMBER(InstanceConstants, flags),
                        MEMBER(InstanceConstants, first_patch), MEMBER(InstanceConstants, first_surfel),
                        MEMBER(InstanceConstants, surfel_count), MEMBER(InstanceConstants, first_group),
                        MEMBER(InstanceConstants, first_word), MEMBER(InstanceConstants, first_source)}});
}

TEST_CASE("tile uniforms have the layout that the shaders declare") {
    expect_everywhere(SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, false,
                      {offsetof(TileUniforms, padding),
                       {MEMBER(TileUniforms, cells_x), MEMBER(TileUniforms, cells_y), MEMBER(TileUniforms, cell_shift),
                        MEMBER(TileUniforms, words), MEMBER(TileUniforms, segmented), MEMBER(TileUniforms, first_solid),
                        MEMBER(TileUniforms, first_listed)}},
                      2);
}

TEST_CASE("surfels have the layout that splat_setup.comp reads as texels") {
    using format::Surfel;
    // In words: the radius with the extent, the colour with the first bend.
    const std::vector<unsigned> words{MEMBER(Surfel, position),         MEMBER(Surfel, position) + 4,
                                      MEMBER(Surfel, position) + 8,     MEMBER(Surfel, radius),
                                      MEMBER(Surfel, normal),           MEMBER(Surfel, colour),
                                      MEMBER(Surfel, shading_bend) + 1, MEMBER(Surfel, patch)};
    for (unsigned i = 0; i < words.size(); ++i)
        CHECK(words[i] == 4 * i);
    CHECK(sizeof(Surfel) == 4 * words.size());
    CHECK(offsetof(Surfel, extent) == offsetof(Surfel, radius) + 2);
    CHECK(offsetof(Surfel, clip) == offsetof(Surfel, patch) + 2);
    CHECK(offsetof(Surfel, shading_bend) == offsetof(Surfel, colour) + 3);
}

TEST_CASE("the cells of tiles have the layout that the shaders declare") {
    expect_everywhere(SPVC_RESOURCE_TYPE_STORAGE_BUFFER, false,
                      {kTileCellList, {tile_dispatch(TileCells::kOthers), kTileCellList}}, 2, 5);
}

TEST_CASE("the list of splats has the layout that the shaders declare") {
    expect_everywhere(SPVC_RESOURCE_TYPE_STORAGE_BUFFER, false, {kListGroups, {kListDraw, kListGroups}}, 2, 8);
}

TEST_CASE("constants that C++ and GLSL share have the same values") {
    CHECK(constant("include/frame.glsl", "HORIZON") == kHorizon);
    CHECK(constant("include/splat.glsl", "PREFILTER_REACH") == kSetupReach);
    CHECK(constant("include/frame.glsl", "LIGHTING_HIGHLIGHTS") == std::uint32_t{kLightingHighlights});
    CHECK(constant("include/frame.glsl", "LIGHTING_PHONG") == std::uint32_t{kLightingPhong});
    CHECK(constant("include/frame.glsl", "LIGHTING_RIM") == std::uint32_t{kLightingRim});
    CHECK(constant("include/frame.glsl", "LIGHTING_LAMPS") == std::uint32_t{kLightingLamps});
    CHECK(constant("include/tile.glsl", "TILE") == kTileWidth);
    CHECK(constant("include/tile.glsl", "TILE", 1) == kTileHeight);
    CHECK(constant("include/tile.glsl", "GROUP") == kTileGroup);
    CHECK(constant("include/tile.glsl", "BLOCK") == kTileBlock);
    CHECK(constant("include/tile.glsl", "RECORD_TEXELS") == kTileRecordTexels);
    CHECK(constant("include/tile.glsl", "SEGMENT_WORDS") == kTileSegmentWords);
    CHECK(constant("include/tile.glsl", "FUSED_GROUPS") == kTileFusedGroups);
    CHECK(constant("include/tile.glsl", "CELLS_OTHERS") == static_cast<std::uint32_t>(TileCells::kOthers));
    CHECK(constant("include/tile.glsl", "CELLS_SEGMENTED") == static_cast<std::uint32_t>(TileCells::kSegmented));
    CHECK(constant("tile_cells.comp", "local_size_x") == kTileCellsGroup);
    CHECK(static_cast<float>(constant("include/surfel_record.glsl", "EXTENT_POWERS")) == kSwellStep);
    CHECK(static_cast<float>(constant("include/surfel_record.glsl", "EXTENT_POWERS", 2)) == kEpsilonStep);
    CHECK(static_cast<float>(constant("include/surfel_record.glsl", "EXTENT_ONES")) == kSwellOne);
    CHECK(static_cast<float>(constant("include/surfel_record.glsl", "EXTENT_ONES", 2)) == kEpsilonOne);
    CHECK(static_cast<float>(constant("include/surfel_record.glsl", "PACKED_EPSILON")) == kPackedEpsilon);
    CHECK(constant("include/surfel_record.glsl", "PACKED_BLOCK") == kPackedBlock);
    CHECK(constant("include/surfel_record.glsl", "PLACE_STEPS") == kPlaceSteps);
    CHECK(constant("include/surfel_frame.glsl", "CLIP_DIRECTIONS") == kClipDirections);
    CHECK(static_cast<float>(constant("include/surfel_frame.glsl", "CLIP_STEPS")) == kClipSteps);
    const double lean = constant("include/surfel_frame.glsl", "LARGEST_LEAN");
    const double turn = constant("include/surfel_frame.glsl", "LARGEST_TURN");
    const std::vector<double> bend(std::begin(format::kLargestBend), std::end(format::kLargestBend));
    CHECK(bend == std::vector<double>{lean, lean, turn, turn, turn});
}

TEST_CASE("no tile takes more rounds of loops than drivers allow, nor shares more memory than devices have") {
    // llvmpipe ends every loop of an invocation once all its loops have run so often.
    constexpr double kMostRounds = 65535;
    constexpr double kBlocks = kTileGroup / kTileBlock;
    // Listing a block's splats, reading them, and handing them round; reading the numbers of as many blocks at once as
    // there are lanes; and as much again for lists and reads that are not full.
    constexpr double kRoundsABlock = 1 + 1 + kTileBlock + 2.0 / kTileWidth;
    // At once: finding a group's blocks, then seeing, painting, and painting what lacks. In segments: one of these.
    CHECK(kTileFusedGroups * (1 + 3 * kBlocks * kRoundsABlock) < kMostRounds);
    CHECK(32 * kTileSegmentWords * (1 + kBlocks * kRoundsABlock) < kMostRounds);
    // VkPhysicalDeviceLimits::maxComputeSharedMemorySize; a word a block, and one a splat of both lists.
    const double listed = constant("include/tile.glsl", "MOST_LISTED");
    CHECK(4 * (kBlocks * std::max(32 * kTileSegmentWords, kTileFusedGroups) + 2 * listed) <= 16384);
    // What all lanes' blocks may add must fit at first.
    CHECK(kTileWidth * kTileBlock <= listed);
}
