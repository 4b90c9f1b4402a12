// Every surfel of the groups that the frame lists becomes the record of its splat, once a frame. Most surfels of a
// frame are cheap to reject: a workgroup, which is one subgroup, first finds which of its group are not, then works on
// those with all of its invocations.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#define COPY_UNIFORMS
#include "frame.glsl"
#include "octahedral.glsl"
#include "colour.glsl"
#include "lighting.glsl"
#include "splat.glsl"
#include "surfel_record.glsl"
#include "surfel_frame.glsl"
#include "tile.glsl"
#include "splat_record.glsl"

layout(local_size_x = 8) in;

layout(constant_id = 5) const bool DEFERRED = false;  // records have normals and albedos instead of lit colours

// format::Surfel, two texels each, or format::PackedSurfel, one.
layout(set = 1, binding = 0) uniform usamplerBuffer surfels;
layout(set = 2, binding = 1, rgba32ui) uniform writeonly uimageBuffer records;
layout(set = 2, binding = 2, rg32ui) uniform writeonly uimageBuffer block_bounds;

shared uint remaining[GROUP];

uint first_solid;  // of tiles

// Texels of a record; the second of a packed surfel's is none.
uvec4 first_of(uint index) { return texelFetch(surfels, int(is_packed() ? index : 2 * index)); }
uvec4 second_of(uint index) { return is_packed() ? uvec4(0) : texelFetch(surfels, int(2 * index + 1)); }

// Whether anything of a surfel can be in the picture; true when in doubt. Nothing it stands for is farther from its
// centre than a radius across and one along its normal.
bool may_show(uint index) {
    const uvec4 first = first_of(index);
    const vec3 centre = to_view_space(position_of(first));
    const float depth = -centre.z;
    const float reach = sqrt(2.0) * abs(radius_of(first)) * instance.scale;
    const vec2 half_view = (frame.viewport * 0.5 + PREFILTER_REACH) / frame.pixel_scale;
    const vec2 outside = ORTHOGRAPHIC ? abs(centre.xy) - half_view
                                      : (abs(centre.xy) - half_view * depth) * inversesqrt(1 + half_view * half_view);
    const vec3 normal = decode_octahedral(normal_of(first, second_of(index)));
    const bool away =
        (instance.flags & INSTANCE_TWO_SIDED) == 0 && beyond_horizon(normal_to_view_space(normal), centre);
    return !(any(greaterThan(outside, vec2(reach))) || depth + reach < frame.near_plane || away);
}

// Marks of a solid or a cut disk; 0: the surfel is a flat disk.
uint solid_marks(SurfelRecord record) {
    if (VIEW == VIEW_SAMPLES) return 0;
    const bool cut = !is_ellipse(record) && record.clip >> 6 != 0;
    return ((record.extent & EXTENT_SWELL) != 0 ? MARK_SWELL : 0) | (cut ? MARK_CUT : 0);
}

struct PixelBounds {
    uvec2 low, high;
    bool solid, close;
};

// Whose pixel centres a splat may reach; none where it is outside.
PixelBounds bounds_of(Splat splat, out vec2 reach) {
    const vec2 corner = floor(splat.anchor);
    const vec2 low = min(splat.splat_bounds.xy, corner), high = max(splat.splat_bounds.zw, corner + 1);
    reach = max(splat.anchor - low, high - splat.anchor);
    const float slack = 0.51;
    const vec2 first = clamp(ceil(low - slack), vec2(0), frame.viewport);
    const vec2 beyond = clamp(floor(high + slack), vec2(0), frame.viewport);
    return PixelBounds(uvec2(first), uvec2(beyond), false, false);
}

// What one invocation records at `place`; a place without a splat reaches nothing. Only stores are branched over.
PixelBounds record_surfel(bool takes_part, uint surfel_index, uint place) {
    const SurfelRecord record = decode_surfel(first_of(surfel_index), second_of(surfel_index), surfel_index);
    Splat splat;
    SurfelFrame surfel;
    const bool drawn = surfel_splat(record, splat, surfel);
    vec2 reach;
    PixelBounds bounds = bounds_of(splat, reach);
    const bool recorded = takes_part && drawn && all(lessThan(bounds.low, bounds.high));
    const uvec2 size = bounds.high - bounds.low;
    bounds.low = recorded ? bounds.low : uvec2(0xffff);
    bounds.high = recorded ? bounds.high : uvec2(0);
    SurfelColour colour;
    if (DEFERRED) {
        const SurfelNormals normals = surfel_normals(record, surfel);
        colour = SurfelColour(normals.centre, normals.along_u, normals.along_v);
    } else {
        colour = surfel_colour(record, surfel);
    }
    const float to_z = ORTHOGRAPHIC ? 1 / depth_range() : 1;
    const float push = splat.epsilon * (ORTHOGRAPHIC ? to_z : 1 / frame.near_plane);
    const float climb = splat.skew.z * (ORTHOGRAPHIC ? to_z : 1 / splat.anchor_depth);
    // Rounded up, so that nothing on the disk is beyond it.
    const float rise = splat.rise * (ORTHOGRAPHIC ? to_z : 1 / splat.anchor_depth) * (1 + 1.0 / 512) + 1e-7;
    // What is narrower than a fraction of a pixel is so small that nobody sees its shape.
    const bool speck = is_sub_pixel(splat);
    const bool near = splat.plane_offset != vec2(0) || splat.anchor_depth - splat.rise < frame.near_plane;
    const uint marks = (speck ? MARK_SPECK : solid_marks(record)) | (near ? MARK_NEAR : 0);
    const bool solid = recorded && (marks & ~MARK_SPECK) != 0;
    const vec2 gains = splat.swell * vec2(climb, -climb);
    const bool large = any(greaterThan(size, uvec2(LARGE_SOLID)));
    bounds.solid = solid;
    bounds.close = recorded &&
                   (near || (solid && (large || (!ORTHOGRAPHIC && min(gains.x, gains.y) < LEAST_GAIN))));

    const int texel = int(place * RECORD_TEXELS), solid_texel = int(first_solid + 2 * place);
    const uvec4 reaches = pack_place(splat.anchor, reach, encode_depth(splat.anchor_depth));
    imageStore(records, texel, recorded ? reaches : pack_place(vec2(0), vec2(-1e4), 0));
    if (recorded) {
        imageStore(records, texel + 1, floatBitsToUint(splat.plane_map));
        imageStore(records, texel + 2,
                   uvec4(floatBitsToUint(splat.g * to_z), (floatBitsToUint(push) & ~MARKS) | marks,
                         packHalf2x16(vec2(min(rise, 6e4), colour.along_v.b))));
        imageStore(records, texel + 3,
                   uvec4(packHalf2x16(colour.centre.rg), packHalf2x16(vec2(colour.centre.b, colour.along_u.r)),
                         packHalf2x16(colour.along_u.gb), packHalf2x16(colour.along_v.rg)));
    }
    if (solid)
        imageStore(records, solid_texel,
                   uvec4(floatBitsToUint(vec3(splat.skew.xy, climb)), packSnorm2x16(splat.plane_offset)));
    if (solid || (DEFERRED && recorded)) {
        const vec3 clip = (marks & MARK_CUT) != 0 ? decode_clip(record.clip) : NO_CLIP;
        imageStore(records, solid_texel + 1,
                   pack_last(clip, (marks & MARK_SWELL) != 0 ? record.extent & EXTENT_SWELL : 0,
                             DEFERRED ? surfel_albedo(record) : vec3(0)));
    }
    return bounds;
}

// Of all invocations, for all of them.
PixelBounds united(PixelBounds bounds) {
    [[unroll]] for (uint step = 1; step < gl_WorkGroupSize.x; step *= 2) {
        const uint other = gl_LocalInvocationID.x ^ step;
        bounds.low = min(bounds.low, subgroupShuffle(bounds.low, other));
        bounds.high = max(bounds.high, subgroupShuffle(bounds.high, other));
    }
    return bounds;
}

void main() {
    copy_uniforms();
    first_solid = tiles.first_solid;
    // A dispatch is at most 65,535 workgroups wide.
    const uint workgroup = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (workgroup >= instance.surfel_count) return;
    const uint number = turn_of(workgroup, instance.surfel_count);
    const uvec2 source = group_sources[instance.first_source + number];
    // Those of some groups need no look at each: all that is known of them says that they show.
    const bool certain = (source.y & GROUP_SHOWS) != 0;
    const uint first = source.x, end = source.x + (source.y & ~GROUP_SHOWS);
    const uint group = instance.first_group + number;
    const uint lane = gl_LocalInvocationID.x;

    uint kept = 0, batch = certain ? end : first;
    do {
        const uint index = batch + lane;
        const bool shows = index < end && may_show(min(index, end - 1));
        const uvec4 all = subgroupBallot(shows);
        if (shows) remaining[kept + subgroupBallotExclusiveBitCount(all)] = index;
        kept += subgroupBallotBitCount(all);
        batch += gl_WorkGroupSize.x;
    } while (batch < end);
    if (certain) kept = end - first;
    subgroupMemoryBarrierShared();
    subgroupBarrier();

    PixelBounds group_bounds = PixelBounds(uvec2(0xffff), uvec2(0), false, false);
    uint shown = 0;
    uvec2 own_block = uvec2(0);  // of the block with the number of this invocation
    uint cell_marks = 0;
    if (kept != 0) {
        uint block = 0;
        do {
            const uint i = block * BLOCK + lane;
            PixelBounds bounds =
                record_surfel(i < kept, certain ? first + min(i, kept - 1) : remaining[min(i, kept - 1)],
                              group * GROUP + i);
            const bool solid = subgroupBallot(bounds.solid).x != 0;
            shown += subgroupBallotBitCount(subgroupBallot(bounds.low.x < bounds.high.x));
            bounds = united(bounds);
            group_bounds.low = min(group_bounds.low, bounds.low);
            group_bounds.high = max(group_bounds.high, bounds.high);
            if (block == lane && bounds.low.x < bounds.high.x)
                own_block = bounds.low | bounds.high << 16 | uvec2(solid ? BLOCK_SOLID : 0, 0);
            cell_marks |= subgroupBallot(bounds.close).x != 0 ? CELL_HAS_CLOSE : 0;
            ++block;
        } while (block * BLOCK < kept);
    }
    imageStore(block_bounds, int(group * BLOCKS + lane), uvec4(own_block, 0, 0));
    if ((instance.flags & INSTANCE_LISTED) != 0 && lane == 0) list.first[group] = shown;

    if ((instance.flags & INSTANCE_TILED) == 0 || group_bounds.low.x >= group_bounds.high.x) return;
    const uvec2 first_cell = group_bounds.low >> tiles.cell_shift;
    const uvec2 touched = ((group_bounds.high - 1) >> tiles.cell_shift) + 1 - first_cell;
    uint i = lane;
    if (i < touched.x * touched.y) do {
            const uint cell = (first_cell.y + i / touched.x) * tiles.cells_x + first_cell.x + i % touched.x;
            atomicOr(masks[cell * tiles.words + group / 32], 1u << group % 32);
            atomicAdd(cells[cell], 1);
            atomicOr(cells[cell], cell_marks);
            i += gl_WorkGroupSize.x;
        } while (i < touched.x * touched.y);
}
