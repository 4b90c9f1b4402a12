// Quadric edge collapse (Garland and Heckbert 1997) with the subset placement, attributes as Hoppe 1999 has them, a
// link condition (Dey et al. 1999) and a normal test before each collapse.
#include "preprocess/simplify/region_simplifier.h"

#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace splice {
namespace {

// A collapse may turn no triangle to more than 75 degrees from the mean of what its vertices stand for.
constexpr double kLeastCosine = 0.25;

// Twice the area of a triangle by the square of its longest side. Slivers may lie as they like, for they hide nothing;
// none may get thinner than thin.
constexpr double kSliver = 1e-2, kThin = 1e-4;

// Of the squared edge: on flat ground, where all quadrics are zero, short edges go first.
constexpr double kLengthShare = 1e-6;

// A normal that differs by its own length, and a full-scale change of a colour channel, are worth so many widths of
// what a vertex stands for. Texture coordinates need only keep from sliding: unit-box units a unit.
constexpr double kNormalWidths = 0.5, kColourWidths = 0.5, kUvWorth = 0.1;

// Widths across which slopes of attributes are trusted.
constexpr double kSlope = 0.1;

// An error is a quarter of what may be seen of it (engine/scene/patch_view.cpp): half of the largest distance at least;
// and the width of what a vertex stands for, times how far its normals differ, though no more than a share of a width,
// which would be filtered to one normal: where a pixel may be seen, vertices are not kept closer than two.
constexpr double kWorstDistance = 2, kDifference = 5, kFiltered = 0.02;

// An open border's edge counts as a wall of so many of its squares.
constexpr double kBorderSquares = 4;

// Least vertices that are free for each that is locked.
constexpr double kLeastFree = 0.5;

}  // namespace

RegionSimplifier::RegionSimplifier(const IndexedMesh& mesh, const RenderVertices& vertices,
                                   std::span<const std::uint8_t> shared)
    : CollapseQueue(mesh.positions.size()), mesh_(mesh), render_(vertices), shared_(shared) {
    attribute_count_ = mesh.corner_uvs.empty() ? mesh.has_colours ? 6 : 3 : 8;
}

std::vector<RegionLevel> RegionSimplifier::simplify(const RegionTriangles& triangles, std::span<const double> shares,
                                                    bool keep_topology) {
    own_ = &triangles;
    keep_topology_ = keep_topology;
    load(triangles);
    const auto finest = static_cast<double>(alive_count_);
    std::vector<RegionLevel> levels;
    for (const double share : shares) {
        const std::size_t before = alive_count_;
        collapse_until(static_cast<std::size_t>(std::ceil(finest * share)));
        if (alive_count_ != before) levels.push_back(level());
        if (queue_is_empty() || free_ <= least_free_) break;
    }
    forget();
    return levels;
}

void RegionSimplifier::load(const RegionTriangles& triangles) {
    const std::vector<std::uint32_t> corners = without_fins(triangles.corners);
    begin(corners.size() / 3);
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k)
            add_corner(mesh_, position_at(corners[i + k]), corners[i + k]);
        add_normal();
    }
    end_load();
    merged_.assign(position_.size(), 0);
    kind_.resize(position_.size());
    for (Index vertex = 0; vertex < kind_.size(); ++vertex)
        kind_[vertex] = kind_of(vertex);
    free_ = kind_.size() - static_cast<std::size_t>(std::ranges::count(kind_, Kind::kLocked));
    least_free_ = static_cast<std::size_t>(kLeastFree * static_cast<double>(kind_.size() - free_));
    weigh_attributes();
    add_quadrics();
    fill_queue();
}

// Parts that were simplified apart may leave a triangle and its reverse at the border between them: a fin of no volume.
std::vector<std::uint32_t> RegionSimplifier::without_fins(std::span<const std::uint32_t> corners) const {
    using Key = std::pair<std::array<std::uint32_t, 3>, std::size_t>;  // positions ascending; triangle
    std::vector<Key> keys;
    std::vector<bool> reversed;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        std::array<std::uint32_t, 3> at{position_at(corners[i]), position_at(corners[i + 1]),
                                        position_at(corners[i + 2])};
        std::ranges::rotate(at, std::ranges::min_element(at));
        reversed.push_back(at[1] > at[2]);
        std::ranges::sort(at);
        keys.emplace_back(at, i / 3);
    }
    std::ranges::sort(keys);
    std::vector<bool> dropped(keys.size(), false);
    for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
        const std::size_t a = keys[i].second, b = keys[i + 1].second;
        if (keys[i].first != keys[i + 1].first || dropped[a] || reversed[a] == reversed[b]) continue;
        dropped[a] = dropped[b] = true;
    }
    std::vector<std::uint32_t> kept;
    for (std::size_t triangle = 0; triangle < dropped.size(); ++triangle)
        for (std::size_t k = 0; k < 3 && !dropped[triangle]; ++k)
            kept.push_back(corners[3 * triangle + k]);
    return kept;
}

// By the width of what a vertex stands for on the way to the coarsest level.
void RegionSimplifier::weigh_attributes() {
    double area = 0;
    for (Index corner = 0; corner < corner_vertex_.size(); corner += 3) {
        const Vec3d& origin = position_[corner_vertex_[corner]];
        area += (position_[after(corner)] - origin).cross(position_[before(corner)] - origin).norm() / 2;
    }
    width_ = std::sqrt(2 * area / static_cast<double>(std::max<std::size_t>(position_.size(), 1)));
    normal_worth_ = kNormalWidths * width_;
    colour_worth_ = kColourWidths * width_;
    uv_worth_ = kUvWorth;
}

RegionSimplifier::Attributes RegionSimplifier::attributes_of(const format::Vertex& vertex) const {
    const auto normal = decode_octahedral(vertex.normal);
    const auto colour = linear_from_rgba8(vertex.colour);
    Attributes attributes{};
    for (std::size_t k = 0; k < 3; ++k) {
        attributes[k] = normal_worth_ * static_cast<double>(normal[k]);
        attributes[3 + k] = colour_worth_ * static_cast<double>(colour[k]);
    }
    for (std::size_t k = 0; k < 2; ++k)
        attributes[6 + k] = uv_worth_ * static_cast<double>(vertex.uv[k]);
    return attributes;
}

void RegionSimplifier::add_quadrics() {
    quadric_.assign(position_.size(), {});
    for (Index corner = 0; corner < corner_vertex_.size(); corner += 3) {
        std::array<Vec3d, 3> places;
        std::array<Attributes, 3> attributes{};
        for (Index k = 0; k < 3; ++k) {
            places[k] = position_[corner_vertex_[corner + k]];
            attributes[k] = attributes_of(vertex_at(corner_render_[corner + k]));
        }
        AttributeQuadric quadric;
        quadric.add_triangle(places, attributes, attribute_count_, kSlope * width_);
        for (Index k = 0; k < 3; ++k)
            quadric_[corner_vertex_[corner + k]] += quadric;
    }
    for (Index vertex = 0; vertex < position_.size(); ++vertex) {
        if (kind_[vertex] != Kind::kBorder) continue;
        const Index next = open_edges(vertex).after;
        const Vec3d edge = position_[next] - position_[vertex];
        const Vec3d wall = edge.cross(normal_[vertex] + normal_[next]);
        if (!(wall.norm() > 0)) continue;
        for (const Index end : {vertex, next})
            quadric_[end].add_plane(wall.normalized(), position_[vertex], kBorderSquares * edge.squaredNorm());
    }
}

bool RegionSimplifier::is_seam(std::uint32_t a, std::uint32_t b) const {
    const format::Vertex &first = vertex_at(a), &second = vertex_at(b);
    return first.uv[0] != second.uv[0] || first.uv[1] != second.uv[1];
}

// The triangles around an inner vertex form one closed, consistently oriented fan; around one on an open border, one
// fan from an edge of the border to another.
RegionSimplifier::Kind RegionSimplifier::kind_of(Index vertex) {
    if (shared_[mesh_position_[vertex]] || degree_[vertex] > kMaxDegree) return Kind::kLocked;
    bool seam = false;
    const Index render = corner_render_[first_corner_[vertex]];
    for_each_corner(vertex, [&](Index corner) { seam = seam || is_seam(corner_render_[corner], render); });
    if (seam) return Kind::kLocked;
    const OpenEdges open = open_edges(vertex);
    if (open.count != 0 && open.count != 2) return Kind::kLocked;
    if (open.count == 2 && (open.before == kNone || open.after == kNone)) return Kind::kLocked;
    if (!keep_topology_) return open.count == 0 ? Kind::kInner : Kind::kBorder;
    const Index start = open.count == 0 ? after(first_corner_[vertex]) : open.after;
    const Kind kind = open.count == 0 ? Kind::kInner : Kind::kBorder;
    return is_fan(vertex, start, open.count == 0 ? start : open.before) ? kind : Kind::kLocked;
}

RegionSimplifier::OpenEdges RegionSimplifier::open_edges(Index vertex) {
    OpenEdges open;
    for_each_corner(vertex, [&](Index corner) {
        bool leads_on = false, leads_here = false;
        for_each_corner(vertex, [&](Index other) {
            leads_on = leads_on || before(other) == after(corner);
            leads_here = leads_here || after(other) == before(corner);
        });
        if (!leads_on) open.after = after(corner);
        if (!leads_here) open.before = before(corner);
        open.count += (leads_on ? 0 : 1) + (leads_here ? 0 : 1);
    });
    return open;
}

void RegionSimplifier::collapse_until(std::size_t triangle_count) {
    collapse_while([&] { return alive_count_ > triangle_count && free_ > least_free_; });
}

// An inner vertex's neighbours: each is the one after exactly one corner. On a border, those along it.
void RegionSimplifier::list_targets(Index vertex) {
    targets_.clear();
    if (kind_[vertex] == Kind::kBorder) {
        const OpenEdges open = open_edges(vertex);
        for (const Index target : {open.before, open.after})
            if (target != kNone) targets_.push_back({cost(vertex, target), target});
        return;
    }
    for_each_corner(vertex, [&](Index corner) { targets_.push_back({cost(vertex, after(corner)), after(corner)}); });
}

double RegionSimplifier::cost(Index vertex, Index target) const {
    const Vec3d& place = position_[target];
    AttributeQuadric both = quadric_[vertex];
    both += quadric_[target];
    return both.distance(place) + both.difference(place, attribute_count_) +
           kLengthShare * quadric_[vertex].weight() * (place - position_[vertex]).squaredNorm();
}

bool RegionSimplifier::is_legal(Index vertex, Index target) {
    return degree_[vertex] + degree_[target] <= kMaxDegree && (!keep_topology_ || link_is_simple(vertex, target)) &&
           turns_no_triangle(vertex, target);
}

// A locked target keeps its texture coordinates, on which the triangles must agree.
bool RegionSimplifier::link_is_simple(Index vertex, Index target) {
    const EdgeTriangles edge = triangles_on_edge(vertex, target);
    const Index expected = kind_[vertex] == Kind::kBorder ? 1 : 2;
    if (!edge.simple || edge.count() != expected) return false;
    if (expected == 2 && kind_[target] == Kind::kLocked && is_seam(edge.render[0], edge.render[1])) return false;
    return shares_only_tips(target, edge);
}

// What matters is the mean of all that the triangle's vertices stand for, not how the triangle lay before: noise is
// full of triangles that turn the wrong way, and must not stay for that.
bool RegionSimplifier::turns_no_triangle(Index vertex, Index target) const {
    const Vec3d& old_place = position_[vertex];
    const Vec3d& new_place = position_[target];
    bool turns = false;
    for_each_corner(vertex, [&](Index corner) {
        const Index a = after(corner), b = before(corner);
        if (turns || a == target || b == target) return;
        const Vec3d edge = position_[b] - position_[a];
        const Vec3d old_normal = edge.cross(old_place - position_[a]);
        const Vec3d new_normal = edge.cross(new_place - position_[a]);
        const auto thinness = [&](const Vec3d& normal, const Vec3d& place) {
            return normal.norm() / std::max(edge.squaredNorm(), (place - position_[a]).squaredNorm());
        };
        const double thin = thinness(new_normal, new_place), was = thinness(old_normal, old_place);
        const Vec3d mean = normal_[a] + normal_[b] + normal_[target] + normal_[vertex];
        const double least = std::min(kLeastCosine * mean.norm(), old_normal.normalized().dot(mean));
        if (thin < kThin && thin < was)
            turns = true;
        else if (thin > kSliver)
            turns = new_normal.dot(mean) < least * new_normal.norm();
    });
    return !turns;
}

void RegionSimplifier::collapse(Index vertex, Index target) {
    Index render = kNone;
    ring_.assign(1, target);
    for_each_corner(vertex, [&](Index corner) {
        if (after(corner) == target) {
            render = corner_render_[next_in_triangle(corner)];
            if (std::ranges::find(ring_, before(corner)) == ring_.end()) ring_.push_back(before(corner));
        } else if (before(corner) == target) {
            render = corner_render_[next_in_triangle(next_in_triangle(corner))];
            if (std::ranges::find(ring_, after(corner)) == ring_.end()) ring_.push_back(after(corner));
        }
    });
    const Index end_of_moved = first_corner_[target];
    drop_triangles_on_edge(vertex, target);
    move_corners(vertex, target, render);
    // Their planes have changed, a sliver's to that of a wide triangle.
    for (Index moved = first_corner_[target]; moved != end_of_moved; moved = next_corner_[moved]) {
        Index corner = moved;
        for (int k = 0; alive_[moved / 3] && k < 3; ++k, corner = next_in_triangle(corner))
            corner_render_[corner] = suiting(corner, corner_render_[corner]);
    }
    drop_candidate(vertex);
    --free_;
    merged_[target] = 1;
    quadric_[target] += quadric_[vertex];
    normal_[target] += normal_[vertex];
    for (const Index touched : ring_)
        drop_dead_corners(touched);
    add_ring(target);
    for (const Index changed : ring_)
        push_candidate(changed);
}

// A vertex that is not fitted keeps its own attributes, of which it has several at a crease: on scans also at slivers
// of no width, whose normals are anyone's. A triangle takes those whose normal is nearest to its own.
std::uint32_t RegionSimplifier::suiting(Index corner, std::uint32_t render) const {
    const Index vertex = corner_vertex_[corner];
    const Vec3d plane =
        (position_[after(corner)] - position_[vertex]).cross(position_[before(corner)] - position_[vertex]);
    const auto along = [&](std::uint32_t candidate) {
        const auto normal = decode_octahedral(vertex_at(candidate).normal);
        return plane.dot(Vec3d(normal[0], normal[1], normal[2]));
    };
    std::uint32_t best = render;
    for_each_corner(vertex, [&](Index other) {
        const std::uint32_t candidate = corner_render_[other];
        if (candidate != best && !is_seam(candidate, render) && along(candidate) > along(best)) best = candidate;
    });
    return best;
}

// What normals and colours differ by matters by the width of what a vertex stands for, and no more than if that were of
// one colour, the right one.
void RegionSimplifier::measure(RegionLevel& level) const {
    double shape = 0, looks = 0, area = 0, worst = 0;
    const double worth = normal_worth_ * normal_worth_ / (kNormalWidths * kNormalWidths);
    for (Index vertex = 0; vertex < quadric_.size(); ++vertex) {
        const AttributeQuadric& quadric = quadric_[vertex];
        const double weight = quadric.weight();
        if (first_corner_[vertex] == kNone || !(weight > 0)) continue;
        const double distance = quadric.distance(position_[vertex]);
        const double difference = quadric.difference(position_[vertex], attribute_count_) / (worth * weight);
        shape += distance;
        looks +=
            weight * std::min(kDifference * difference, kFiltered) * weight / 3;  // a triangle is in three quadrics
        area += weight;
        worst = std::max(worst, distance / weight);
    }
    if (!(area > 0)) return;
    level.shape_error = std::max(std::sqrt(shape / area), std::sqrt(worst) / kWorstDistance);
    level.looks_error = std::sqrt(looks / area);
}

format::Vertex RegionSimplifier::fitted_vertex(Index vertex) const {
    format::Vertex fitted = vertex_at(corner_render_[first_corner_[vertex]]);
    const Attributes best = quadric_[vertex].best(position_[vertex], attribute_count_);
    const Vec3d normal(best[0], best[1], best[2]);
    if (normal.norm() > 0) {
        const Vec3f unit = normal.normalized().cast<float>();
        fitted.normal = encode_octahedral(unit.x(), unit.y(), unit.z());
    }
    if (attribute_count_ >= 6) {
        const auto channel = [&](std::size_t k) { return static_cast<float>(best[3 + k] / colour_worth_); };
        fitted.colour =
            rgba8_from_linear({channel(0), channel(1), channel(2), static_cast<float>(fitted.colour >> 24) / 255});
    }
    if (attribute_count_ >= 8)
        for (std::size_t k = 0; k < 2; ++k)
            fitted.uv[k] = static_cast<float>(best[6 + k] / uv_worth_);
    return fitted;
}

RegionLevel RegionSimplifier::level() const {
    RegionLevel level;
    std::vector<std::uint32_t> own(position_.size(), kNone);
    const auto add = [&](const format::Vertex& vertex, Index local) {
        level.triangles.vertices.push_back(vertex);
        level.triangles.position.push_back(mesh_position_[local]);
        return first_own() + static_cast<std::uint32_t>(level.triangles.vertices.size() - 1);
    };
    for (Index corner = 0; corner < corner_vertex_.size(); ++corner) {
        if (!alive_[corner / 3]) continue;
        const Index vertex = corner_vertex_[corner];
        const bool fitted = merged_[vertex] != 0 && kind_[vertex] != Kind::kLocked;
        if (!fitted && corner_render_[corner] < first_own()) {
            level.triangles.corners.push_back(corner_render_[corner]);
            continue;
        }
        if (own[vertex] == kNone)
            own[vertex] = add(fitted ? fitted_vertex(vertex) : vertex_at(corner_render_[corner]), vertex);
        level.triangles.corners.push_back(own[vertex]);
    }
    measure(level);
    return level;
}

}  // namespace splice
