// THE CONTRACT between the preprocessor and the engine: a .splice file, byte by byte (docs/model_format.md tells the
// same in prose). Little-endian, no padding that is not spelled out. A file is a FileHeader, a table of SectionEntry,
// and the sections, each aligned to kSectionAlignment and laid out as the GPU reads it, so loading is "check, then
// upload".
//
// Lengths are in unit-box units: the model is scaled uniformly so that the longest side of its bounding box is 1
// (thesis 4.2); ModelInfo stores the way back. Colours are sRGB-encoded RGBA, one byte a channel, not premultiplied, R
// in the lowest byte. Normals are octahedral (octahedral.h), two 16-bit snorm, x in the low half.
#pragma once

#include <cstddef>
#include <cstdint>

namespace splice::format {

inline constexpr char kMagic[8] = {'S', 'P', 'L', 'I', 'C', 'E', '\r', '\n'};
inline constexpr std::uint32_t kVersion = 6;
inline constexpr std::uint32_t kCompressedVersion = 7;  // compressed_model.h
inline constexpr std::uint64_t kSectionAlignment = 64;

struct FileHeader {
    char magic[8];                // kMagic; the CR LF shows a transfer in text mode
    std::uint32_t version;        // kVersion or kCompressedVersion; any other value is refused
    std::uint32_t section_count;  // entries in the table
    std::uint64_t file_bytes;     // size of the whole file
    std::uint64_t checksum;       // checksum.h over the whole file with this field taken as 0
    std::uint64_t table_offset;   // byte offset of the first SectionEntry
    std::uint64_t reserved[3];    // 0
};
static_assert(sizeof(FileHeader) == 64 && offsetof(FileHeader, checksum) == 24);

enum class SectionKind : std::uint32_t {
    kModelInfo = 1,   // one ModelInfo
    kVertices = 2,    // Vertex
    kIndices = 3,     // uint32; the finest level of all patches comes first, patch by patch
    kSurfels = 4,     // Surfel; a patch's are contiguous, in the order of the point tree; none in a point cloud
    kPatches = 5,     // Patch, in octree order
    kLods = 6,        // Lod; those of the patches come first, then those of the octree's nodes
    kOctree = 7,      // OctreeNode; node 0 is the root, children of a node are contiguous
    kMergeTree = 8,   // MergeNode
    kMaterials = 9,   // Material; at least one
    kTextures = 10,   // Texture
    kTexels = 11,     // bytes, RGBA8 sRGB, mip levels one after another, rows top to bottom
    kPointTree = 12,  // PackedPointNode; none without surfels. Node 0 is the root, children of a node are contiguous
    kPackedSurfels = 13,  // PackedSurfel; the surfels of a point cloud, in place of kSurfels
};

struct SectionEntry {
    SectionKind kind;
    std::uint32_t stride;    // bytes an element; must equal the struct's size
    std::uint64_t offset;    // from the start of the file
    std::uint64_t count;     // elements
    std::uint64_t reserved;  // 0; in a compressed file, bytes of the section there, 0 if it is not compressed
};
static_assert(sizeof(SectionEntry) == 32);

enum ModelFlags : std::uint32_t {
    kTwoSided = 1u << 0,    // open or inconsistently oriented surface: flip normals to the eye, cull nothing
    kHasColours = 1u << 1,  // vertex colours came with the input
    kHasUvs = 1u << 2,
    kPointCloud = 1u << 3,  // baked from points: surfels only, no vertices, triangles or merges
};

struct ModelInfo {
    double source_scale;  // source = unit * source_scale + source_offset
    double source_offset[3];
    float bounds_min[3];  // of all patches, unit-box units
    std::uint32_t flags;  // ModelFlags
    float bounds_max[3];
    std::uint32_t lod_levels;       // levels that every patch has at most
    std::uint64_t source_vertices;  // of the repaired mesh; points of a cloud
    std::uint64_t source_triangles;
    std::uint64_t drawn_triangles;  // finest triangles of triangle patches
    float max_surfel_radius;
    float median_surfel_radius;
};
static_assert(sizeof(ModelInfo) == 96);

struct Vertex {
    float position[3];
    std::uint32_t normal;  // octahedral
    std::uint32_t colour;  // material diffuse times vertex colour, textures not included
    float uv[2];           // v grows downwards, as the texel rows do
};
static_assert(sizeof(Vertex) == 28 && offsetof(Vertex, uv) == 20);

struct Surfel {
    float position[3];
    std::uint16_t radius;    // half (half.h): baked disk radius; the reconstruction covariance is radius^2 / 2
    std::uint16_t extent;    // surfel_extent.h: epsilon, and how far the surface it stands for leaves its plane
    std::uint32_t normal;    // octahedral; of the disk's plane
    std::uint8_t colour[3];  // sRGB; texture included, filtered over the footprint
    // The shading normal over the disk, to first order (Botsch, Spernat and Kobbelt 2004): at (u, v), in radii along
    // s, t = tangents_of(normal) (tangent_frame.h), it is
    //   normal + (b0 + b2 u + b3 v) s + (b1 + b3 u + b4 v) t, normalised, b = shading_bend / 127 * kLargestBend.
    std::int8_t shading_bend[5];
    std::uint16_t patch;  // index into kPatches, its low 16 bits
    std::uint16_t clip;   // surfel_clip.h: the line at which the disk is cut
};
static_assert(sizeof(Surfel) == 32 && offsetof(Surfel, shading_bend) == 23 && offsetof(Surfel, patch) == 28);

/// What Surfel::shading_bend can hold: b0, b1 (45 degrees between the disk and the surface's normal) and b2, b3, b4 (29
/// degrees per radius); more is clamped.
inline constexpr float kLargestBend[5] = {1.0f, 1.0f, 0.5f, 0.5f, 0.5f};

enum class Representation : std::uint32_t { kTriangles = 0, kSurfels = 1 };

struct Patch {
    float bounds_min[3];            // of its triangles and its surfels' disks
    Representation representation;  // what the bake chose to draw
    float bounds_max[3];
    std::uint32_t material;  // index into kMaterials; a patch has one
    float cone_axis[3];      // unit; every normal of the patch is within the cone
    float cone_cos;          // cosine of the half-angle; -1: normals in all directions
    std::uint64_t first_surfel;
    std::uint32_t surfel_count;  // 0 for triangle patches
    std::uint32_t first_lod;
    std::uint32_t lod_count;  // at least 1; the first is the finest
    float area;               // of its source triangles; 0 in a cloud
    float max_surfel_radius;
    float max_surfel_epsilon;
    float roughness;  // area-weighted RMS angle of face normals to the mean normal, radians
    std::uint32_t
        merge_root;          // node of the merge tree that became this patch (a leaf id is a triangle id); 0 in a cloud
    std::uint64_t reserved;  // 0
};
static_assert(sizeof(Patch) == 96);

struct Lod {
    std::uint64_t first_index;  // into kIndices
    std::uint32_t index_count;  // a multiple of 3
    float error;                // RMS quadric distance to the finest level, unit-box units; 0 for a patch's finest
};
static_assert(sizeof(Lod) == 16);

struct OctreeNode {
    float bounds_min[3];
    std::uint32_t first_patch;  // a node owns patches [first_patch, first_patch + patch_count), its subtree's included
    float bounds_max[3];
    std::uint32_t patch_count;
    std::uint32_t first_child;  // 0 for a leaf
    std::uint32_t child_count;
    std::uint32_t first_lod;  // levels of all its patches together, 0 if there are none
    std::uint32_t lod_count;  // 0 where its patches are of several materials
};
static_assert(sizeof(OctreeNode) == 48 && offsetof(OctreeNode, first_lod) == 40);

/// Inner node i of the merge tree has id source_triangles + i; ids below are leaves, leaf t being triangle t of
/// kIndices. Children come before parents.
struct MergeNode {
    std::uint32_t child[2];
    float cost;           // of the contraction (thesis 3.2.2); smaller merges first
    std::uint32_t phase;  // 1 or 2
};
static_assert(sizeof(MergeNode) == 16);

/// A surfel of a point cloud: whole, and with one normal all over. packed_surfel.h encodes it and states its errors.
struct PackedSurfel {
    std::uint32_t place[2];  // bits 0..19, 20..39, 40..59: x, y, z; 60..63: above, its lower bits
    std::uint32_t look;  // bits 0..23: red, green, blue, sRGB; 24..27: below, its lower bits; 28..31: radius, its lower
    std::uint32_t shape;  // bits 0..9, 10..19: octahedral normal; 20..29: radius, its upper bits; 30: above, 31: below
};
static_assert(sizeof(PackedSurfel) == 16);

/// A node of the point octree; point_node.h says what it stands for, encodes it and states its errors.
struct PackedPointNode {
    std::uint32_t place[2];       // as a PackedSurfel's; bits 60..63: 0
    std::uint16_t major;          // half (half.h): major half axis of the ellipse
    std::uint16_t sphere_radius;  // half
    std::uint32_t frame;          // bits 0..11, 12..23: octahedral normal; 24..31: direction of the major axis
    std::uint8_t ratio;           // minor half axis over the major one, 255ths
    std::uint8_t colour[3];       // sRGB
    std::uint8_t cone_angle;      // steps of pi / 255
    std::uint8_t below;           // 1..127: a leaf of so many surfels; 128 + n: n children
    std::uint16_t extent;         // surfel_extent.h, with the major half axis as the radius
};
static_assert(sizeof(PackedPointNode) == 24 && offsetof(PackedPointNode, extent) == 22);

inline constexpr std::uint32_t kNoTexture = 0xffffffffu;

struct Material {
    std::uint32_t diffuse;  // colour; already in Vertex::colour and Surfel::colour
    std::uint32_t texture;  // index into kTextures or kNoTexture
};
static_assert(sizeof(Material) == 8);

struct Texture {
    std::uint32_t width, height;
    std::uint32_t mip_levels;  // full chain down to 1x1, each side halved rounding down
    std::uint32_t reserved;
    std::uint64_t first_byte;  // into kTexels
    std::uint64_t byte_count;
};
static_assert(sizeof(Texture) == 32);

}  // namespace splice::format
