// Surface simplification using quadric error metrics (Garland and Heckbert 1997; Ni 2005, algorithm 3.1) with the
// subset placement, a link condition (Dey et al. 1999) and a normal test before each collapse.
#include "preprocess/simplify/patch_simplifier.h"

#include <algorithm>
#include <cmath>

namespace splice {
namespace {

// Vertices with more triangles are neither moved nor moved onto, which bounds the work of a collapse.
constexpr std::uint32_t kMaxDegree = 128;

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

bool costs_more(double cost_a, std::uint32_t vertex_a, double cost_b, std::uint32_t vertex_b) {
    return cost_a != cost_b ? cost_a > cost_b : vertex_a > vertex_b;
}

}  // namespace

bool PatchSimplifier::goes_later(const Candidate& a, const Candidate& b) {
    return costs_more(a.cost, a.vertex, b.cost, b.vertex);
}

PatchSimplifier::PatchSimplifier(const IndexedMesh& mesh, const RenderVertices& vertices,
                                 std::span<const std::uint8_t> on_border)
    : mesh_(mesh), render_(vertices), on_border_(on_border), local_of_position_(mesh.positions.size(), kNone) {}

PatchSimplifier::CoarserLevels PatchSimplifier::simplify(std::span<const std::uint32_t> triangles,
                                                         const SimplifyOptions& options) {
    load(triangles);
    const auto finest = static_cast<double>(triangles.size());
    const auto coarser_levels = static_cast<double>(options.levels - 1);
    const double floor = finest * std::pow(static_cast<double>(options.reduction), coarser_levels);
    CoarserLevels ladder;
    for (double rung = finest * kLadderStep; options.levels > 1; rung *= kLadderStep) {
        const std::size_t before = alive_count_;
        collapse_until(static_cast<std::size_t>(std::ceil(std::max(rung, floor))));
        if (alive_count_ != before) append_level(ladder);
        if (heap_.empty() || rung <= floor) break;
    }
    for (const Index position : mesh_position_)
        local_of_position_[position] = kNone;
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
    corner_vertex_.clear();
    corner_render_.clear();
    next_corner_.clear();
    alive_.assign(triangles.size(), 1);
    alive_count_ = triangles.size();
    position_.clear();
    normal_.clear();
    mesh_position_.clear();
    first_corner_.clear();
    degree_.clear();
    locked_.clear();
    quadric_.clear();
    for (const std::uint32_t triangle : triangles)
        load_triangle(triangle);
    for (Vec3d& normal : normal_)
        normal.normalize();  // leaves a zero vector as it is
    version_.assign(position_.size(), 0);
    mark_.assign(position_.size(), 0);
    current_mark_ = 0;
    error_ = 0;
    lock_seams_and_borders();
    heap_.clear();
    for (Index vertex = 0; vertex < position_.size(); ++vertex)
        push_candidate(vertex);
    std::make_heap(heap_.begin(), heap_.end(), goes_later);
}

void PatchSimplifier::load_triangle(std::uint32_t triangle) {
    Index local[3];
    for (std::size_t k = 0; k < 3; ++k) {
        const Index mesh_position = mesh_.triangles[triangle][k];
        Index& vertex = local_of_position_[mesh_position];
        if (vertex == kNone) {
            vertex = static_cast<Index>(position_.size());
            position_.push_back(mesh_.positions[mesh_position].cast<double>());
            normal_.push_back(Vec3d::Zero());
            mesh_position_.push_back(mesh_position);
            first_corner_.push_back(kNone);
            degree_.push_back(0);
            locked_.push_back(on_border_[mesh_position]);
            quadric_.emplace_back();
        }
        const Index corner = static_cast<Index>(corner_vertex_.size());
        corner_vertex_.push_back(vertex);
        corner_render_.push_back(render_.indices[std::size_t{3} * triangle + k]);
        next_corner_.push_back(first_corner_[vertex]);
        first_corner_[vertex] = corner;
        ++degree_[vertex];
        local[k] = vertex;
    }
    const Vec3d cross = (position_[local[1]] - position_[local[0]]).cross(position_[local[2]] - position_[local[0]]);
    const double length = cross.norm();
    if (length == 0) return;
    for (const Index vertex : local) {
        normal_[vertex] += cross;
        quadric_[vertex].add_plane(cross / length, position_[local[0]], length / 2);
    }
}

void PatchSimplifier::lock_seams_and_borders() {
    for (Index vertex = 0; vertex < position_.size(); ++vertex) {
        if (locked_[vertex]) continue;
        const Index render = corner_render_[first_corner_[vertex]];
        bool seam = false;
        for_each_corner(vertex, [&](Index corner) { seam |= corner_render_[corner] != render; });
        locked_[vertex] = seam || degree_[vertex] > kMaxDegree || !is_interior(vertex);
    }
}

// The triangles around the vertex form one closed, consistently oriented fan.
bool PatchSimplifier::is_interior(Index vertex) const {
    const Index start = after(first_corner_[vertex]);
    Index at = start;
    for (Index step = 0; step < degree_[vertex]; ++step) {
        Index next = kNone, leaving = 0;
        for_each_corner(vertex, [&](Index corner) {
            if (after(corner) != at) return;
            next = before(corner);
            ++leaving;
        });
        if (leaving != 1) return false;
        at = next;
        if (at == start) return step + 1 == degree_[vertex];
    }
    return false;
}

void PatchSimplifier::collapse_until(std::size_t triangle_count) {
    while (alive_count_ > triangle_count && !heap_.empty()) {
        std::pop_heap(heap_.begin(), heap_.end(), goes_later);
        const Candidate candidate = heap_.back();
        heap_.pop_back();
        if (candidate.version != version_[candidate.vertex]) continue;
        const std::size_t before_push = heap_.size();
        take(candidate);
        for (std::size_t size = before_push + 1; size <= heap_.size(); ++size)
            std::push_heap(heap_.begin(), heap_.begin() + static_cast<std::ptrdiff_t>(size), goes_later);
    }
}

// Appends to the heap's array without restoring its order: collapse_until does that.
void PatchSimplifier::push_candidate(Index vertex) {
    ++version_[vertex];
    if (locked_[vertex] || degree_[vertex] > kMaxDegree) return;
    Candidate best{0, vertex, kNone, version_[vertex], false};
    // The fan is closed, so each neighbour is the one after exactly one corner.
    for_each_corner(vertex, [&](Index corner) {
        const Index target = after(corner);
        const double target_cost = cost(vertex, target);
        if (best.target != kNone && !costs_more(best.cost, best.target, target_cost, target)) return;
        best.cost = target_cost;
        best.target = target;
    });
    heap_.push_back(best);
}

// Legality is checked only for the cheapest candidate of all. When its target is refused, the vertex waits again with
// the cheapest legal one; without any, until its surroundings change.
void PatchSimplifier::take(const Candidate& candidate) {
    if (candidate.legal || is_legal(candidate.vertex, candidate.target)) {
        collapse(candidate.vertex, candidate.target);
        return;
    }
    list_targets(candidate.vertex);
    for (const Target& target : targets_) {
        if (target.vertex == candidate.target || !is_legal(candidate.vertex, target.vertex)) continue;
        heap_.push_back({target.cost, candidate.vertex, target.vertex, candidate.version, true});
        return;
    }
}

void PatchSimplifier::list_targets(Index vertex) {
    targets_.clear();
    for_each_corner(vertex, [&](Index corner) { targets_.push_back({cost(vertex, after(corner)), after(corner)}); });
    std::ranges::sort(targets_,
                      [](const Target& a, const Target& b) { return costs_more(b.cost, b.vertex, a.cost, a.vertex); });
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

// The neighbours that both share are exactly the tips of the two triangles on the edge, and no triangle joins the tips
// to the target already; else the collapse would pinch the surface or fold it onto itself. The two triangles must also
// agree on the target's attributes.
bool PatchSimplifier::link_is_simple(Index vertex, Index target) {
    const Index near = ++current_mark_;
    Index tips[2] = {kNone, kNone}, render[2] = {kNone, kNone};
    bool shared_ok = true;
    for_each_corner(vertex, [&](Index corner) {
        mark_[after(corner)] = near;
        if (after(corner) == target) {
            shared_ok &= tips[0] == kNone;
            tips[0] = before(corner);
            render[0] = corner_render_[next_in_triangle(corner)];
        } else if (before(corner) == target) {
            shared_ok &= tips[1] == kNone;
            tips[1] = after(corner);
            render[1] = corner_render_[next_in_triangle(next_in_triangle(corner))];
        }
    });
    if (!shared_ok || tips[0] == kNone || tips[1] == kNone || render[0] != render[1]) return false;
    const Index seen = ++current_mark_;
    Index common = 0;
    bool folds = false;
    for_each_corner(target, [&](Index corner) {
        for (const Index neighbour : {after(corner), before(corner)}) {
            if (mark_[neighbour] != near) continue;
            mark_[neighbour] = seen;
            ++common;
        }
        folds |= (after(corner) == tips[0] && before(corner) == tips[1]) ||
                 (after(corner) == tips[1] && before(corner) == tips[0]);
    });
    return common == 2 && !folds;
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
    Index render = kNone;
    Index tips[2] = {kNone, kNone};
    for_each_corner(vertex, [&](Index corner) {
        if (after(corner) == target) {
            render = corner_render_[next_in_triangle(corner)];
            tips[0] = before(corner);
        } else if (before(corner) == target) {
            tips[1] = after(corner);
        }
    });
    Index last = kNone;
    for_each_corner(vertex, [&](Index corner) {
        last = corner;
        if (after(corner) == target || before(corner) == target) {
            alive_[corner / 3] = 0;
            --alive_count_;
        }
    });
    for_each_corner(vertex, [&](Index corner) {
        corner_vertex_[corner] = target;
        corner_render_[corner] = render;
    });
    next_corner_[last] = first_corner_[target];
    first_corner_[target] = first_corner_[vertex];
    first_corner_[vertex] = kNone;
    ++version_[vertex];
    for (const Index touched : {target, tips[0], tips[1]})
        drop_dead_corners(touched);

    quadric_[target] += quadric_[vertex];
    const PlaneQuadric& merged = quadric_[target];
    if (merged.weight() > 0) error_ = std::max(error_, std::sqrt(merged.value(position_[target]) / merged.weight()));

    ring_.clear();
    const Index near = ++current_mark_;
    for_each_corner(target, [&](Index corner) {
        for (const Index neighbour : {after(corner), before(corner)}) {
            if (mark_[neighbour] == near) continue;
            mark_[neighbour] = near;
            ring_.push_back(neighbour);
        }
    });
    push_candidate(target);
    for (const Index neighbour : ring_)
        push_candidate(neighbour);
}

void PatchSimplifier::drop_dead_corners(Index vertex) {
    Index* link = &first_corner_[vertex];
    Index degree = 0;
    while (*link != kNone) {
        if (alive_[*link / 3]) {
            link = &next_corner_[*link];
            ++degree;
        } else {
            *link = next_corner_[*link];
        }
    }
    degree_[vertex] = degree;
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
