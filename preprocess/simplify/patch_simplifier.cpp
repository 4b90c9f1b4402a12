// Surface simplification using quadric error metrics (Garland and Heckbert 1997; Ni 2005, algorithm 3.1) with the
// subset placement, a link condition (Dey et al. 1999) and a normal test before each collapse.
#include "preprocess/simplify/patch_simplifier.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace splice {
namespace {

// A collapse may turn no triangle by more than 78 degrees, nor to more than 60 degrees from the mean of its vertices'
// normals in the finest level.
constexpr double kMinCosine = 0.2;
constexpr double kMinOriginalCosine = 0.5;

// Added to the squared distance, as shares of the squared edge length. On flat ground all quadrics are zero: the first
// makes short edges go first. A full-scale change of a colour channel, or a normal's change by its own length, counts
// as a displacement of that share of the edge.
constexpr double kLengthShare = 1e-6;
constexpr double kColourShare = 0.25;
constexpr double kNormalShare = 0.01;

// Snapshots are taken each time this share of the triangles is left; levels are chosen among them.
constexpr double kLadderStep = 0.8;

// A level with more than this share of the triangles of the one before is not worth its bytes.
constexpr double kLeastReduction = 0.9;

double squared_colour_distance(std::uint32_t a, std::uint32_t b) {
    double sum = 0;
    for (unsigned shift = 0; shift < 32; shift += 8) {
        const double difference = static_cast<double>((a >> shift) & 255u) - static_cast<double>((b >> shift) & 255u);
        sum += difference * difference;
    }
    return sum / (255.0 * 255.0);
}

}  // namespace

PatchSimplifier::PatchSimplifier(const IndexedMesh& mesh, const RenderVertices& vertices,
                                 std::span<const std::uint8_t> on_border)
    : CollapseQueue(mesh.positions.size()), mesh_(mesh), render_(vertices), on_border_(on_border) {}

PatchSimplifier::CoarserLevels PatchSimplifier::simplify(std::span<const std::uint32_t> triangles,
                                                         const SimplifyOptions& options) {
    load(triangles);
    const auto finest = static_cast<double>(triangles.size());
    const auto coarser_levels = static_cast<double>(options.levels - 1);
    const double floor = finest * std::pow(static_cast<double>(options.reduction), coarser_levels);
    CoarserLevels ladder;
    for (double rung = finest * kLadderStep; options.levels > 1; rung *= kLadderStep) {
        const std::size_t before = alive_count_;
        const auto wanted = static_cast<std::size_t>(std::ceil(std::max(rung, floor)));
        collapse_while([&] { return alive_count_ > wanted; });
        if (alive_count_ != before) append_level(ladder);
        if (queue_is_empty() || rung <= floor) break;
    }
    forget();
    return choose_levels(ladder, triangles.size(), options);
}

// Locked borders often stop a small patch long before reduction^levels is reached. What can be reached is then divided
// evenly among fewer levels, at least two coarser ones.
PatchSimplifier::CoarserLevels PatchSimplifier::choose_levels(const CoarserLevels& ladder, std::size_t finest,
                                                              const SimplifyOptions& options) const {
    CoarserLevels chosen;
    if (ladder.levels.empty()) return chosen;
    const double log_finest = std::log(static_cast<double>(3 * finest));
    const auto log_size = [](const PatchLods::Level& level) {
        return std::log(static_cast<double>(level.index_count));
    };
    const double reach = log_size(ladder.levels.back()) - log_finest;
    const auto most = static_cast<int>(options.levels - 1);
    const double wanted = std::ceil(reach / std::log(static_cast<double>(options.reduction)) - 1e-6);
    const int count =
        static_cast<int>(std::clamp(wanted, std::min(2.0, static_cast<double>(most)), static_cast<double>(most)));
    double previous = log_finest;
    for (int i = 1; i <= count; ++i) {
        const double target = log_finest + reach * i / count;
        const PatchLods::Level& level = *std::ranges::min_element(
            ladder.levels, {},
            [&](const PatchLods::Level& candidate) { return std::abs(log_size(candidate) - target); });
        if (log_size(level) > previous + std::log(kLeastReduction)) continue;
        previous = log_size(level);
        const auto indices = std::span(ladder.indices).subspan(level.first_index, level.index_count);
        chosen.levels.push_back({chosen.indices.size(), level.index_count, level.error});
        chosen.indices.insert(chosen.indices.end(), indices.begin(), indices.end());
    }
    return chosen;
}

void PatchSimplifier::load(std::span<const std::uint32_t> triangles) {
    begin(triangles.size());
    quadric_.clear();
    for (const std::uint32_t triangle : triangles)
        load_triangle(triangle);
    end_load();
    for (Vec3d& normal : normal_)
        normal.normalize();  // leaves a zero vector as it is
    error_ = 0;
    lock_seams_and_borders();
    fill_queue();
}

void PatchSimplifier::load_triangle(std::uint32_t triangle) {
    std::array<Index, 3> local{};
    for (std::size_t k = 0; k < 3; ++k)
        local[k] = add_corner(mesh_, mesh_.triangles[triangle][k], render_.indices[std::size_t{3} * triangle + k]);
    quadric_.resize(position_.size());
    const Vec3d cross = add_normal();
    const double length = cross.norm();
    if (length == 0) return;
    for (const Index vertex : local)
        quadric_[vertex].add_plane(cross / length, position_[local[0]], length / 2);
}

// The triangles around a vertex that may move form one closed fan.
void PatchSimplifier::lock_seams_and_borders() {
    locked_.resize(position_.size());
    for (Index vertex = 0; vertex < position_.size(); ++vertex) {
        locked_[vertex] = on_border_[mesh_position_[vertex]];
        if (locked_[vertex]) continue;
        const Index render = corner_render_[first_corner_[vertex]], start = after(first_corner_[vertex]);
        bool seam = false;
        for_each_corner(vertex, [&](Index corner) { seam |= corner_render_[corner] != render; });
        locked_[vertex] = seam || degree_[vertex] > kMaxDegree || !is_fan(vertex, start, start);
    }
}

// The fan is closed, so each neighbour is the one after exactly one corner.
void PatchSimplifier::list_targets(Index vertex) {
    targets_.clear();
    for_each_corner(vertex, [&](Index corner) { targets_.push_back({cost(vertex, after(corner)), after(corner)}); });
}

double PatchSimplifier::cost(Index vertex, Index target) const {
    const Vec3d& place = position_[target];
    const double squared_length = (place - position_[vertex]).squaredNorm();
    const format::Vertex& from = render_.vertices[corner_render_[first_corner_[vertex]]];
    const format::Vertex& to = render_.vertices[corner_render_[first_corner_[target]]];
    const double colour = squared_colour_distance(from.colour, to.colour);
    const double turn = 1 - normal_[vertex].dot(normal_[target]);
    const double attributes =
        kLengthShare + kColourShare * kColourShare * colour + kNormalShare * kNormalShare * 2 * turn;
    return quadric_[vertex].value(place) + quadric_[target].value(place) +
           quadric_[vertex].weight() * squared_length * attributes;
}

bool PatchSimplifier::is_legal(Index vertex, Index target) {
    return degree_[vertex] + degree_[target] <= kMaxDegree && link_is_simple(vertex, target) &&
           turns_no_triangle(vertex, target);
}

// The two triangles must also agree on the target's attributes.
bool PatchSimplifier::link_is_simple(Index vertex, Index target) {
    const EdgeTriangles edge = triangles_on_edge(vertex, target);
    return edge.simple && edge.count() == 2 && edge.render[0] == edge.render[1] && shares_only_tips(target, edge);
}

bool PatchSimplifier::turns_no_triangle(Index vertex, Index target) const {
    const Vec3d& old_place = position_[vertex];
    const Vec3d& new_place = position_[target];
    bool turns = false;
    for_each_corner(vertex, [&](Index corner) {
        const Index a = after(corner), b = before(corner);
        if (turns || a == target || b == target) return;
        const Vec3d edge = position_[b] - position_[a];
        const Vec3d old_normal = edge.cross(old_place - position_[a]);
        const Vec3d new_normal = edge.cross(new_place - position_[a]);
        // Triangles thinner than 1/1000 of their longest side are refused, too.
        const double longest = std::max(edge.squaredNorm(), (new_place - position_[a]).squaredNorm());
        const double length = new_normal.norm();
        const Vec3d original = normal_[a] + normal_[b] + normal_[target];
        turns = length <= 1e-3 * longest || new_normal.dot(old_normal) < kMinCosine * length * old_normal.norm() ||
                new_normal.dot(original) < kMinOriginalCosine * length * original.norm();
    });
    return !turns;
}

void PatchSimplifier::collapse(Index vertex, Index target) {
    const EdgeTriangles edge = triangles_on_edge(vertex, target);
    drop_triangles_on_edge(vertex, target);
    move_corners(vertex, target, edge.render[0]);
    drop_candidate(vertex);
    for (const Index touched : {target, edge.tips[0], edge.tips[1]})
        drop_dead_corners(touched);

    quadric_[target] += quadric_[vertex];
    const PlaneQuadric& merged = quadric_[target];
    if (merged.weight() > 0) error_ = std::max(error_, std::sqrt(merged.value(position_[target]) / merged.weight()));

    ring_.assign(1, target);
    add_ring(target);
    for (const Index changed : ring_)
        push_candidate(changed);
}

void PatchSimplifier::append_level(CoarserLevels& result) const {
    const std::size_t first = result.indices.size();
    for (std::size_t triangle = 0; triangle < alive_.size(); ++triangle)
        if (alive_[triangle])
            for (std::size_t k = 0; k < 3; ++k)
                result.indices.push_back(corner_render_[3 * triangle + k]);
    result.levels.push_back(
        {first, static_cast<std::uint32_t>(result.indices.size() - first), static_cast<float>(error_)});
}

}  // namespace splice
