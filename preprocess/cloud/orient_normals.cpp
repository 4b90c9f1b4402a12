#include "preprocess/cloud/orient_normals.h"

#include "preprocess/cloud/signed_sets.h"
#include "preprocess/large_vector.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>

namespace splice {
namespace {

constexpr std::size_t kPiece = 4096;   // points; consecutive, so mostly near each other
constexpr float kCertain = 0.8f;       // edges between parallel enough normals join a piece's points
constexpr float kBeyondDoubt = 0.95f;  // such edges join them in any order
constexpr std::size_t kBuckets = 32;   // of certainty
constexpr double kClosed = 0.3;        // |sum of n A| / sum of A: 0 for a closed surface, 1 for a plane
constexpr float kParallel = 0.7f;

struct Edge {
    bool opposite;
    float certainty;  // 0..1
};

// Nearly parallel normals: of one sheet, unless the edge leaves it. Otherwise the surface turns; on an arc, the normal
// at one end of a chord is that at the other mirrored at the plane across the chord.
inline Edge judge(const Vec3f& along, const Vec3f& normal_a, const Vec3f& normal_b) {
    const float cosine = normal_a.dot(normal_b), square = along.squaredNorm();
    const float rise_a = along.dot(normal_a), rise_b = along.dot(normal_b);
    if (std::abs(cosine) >= kParallel) {
        const float rise = std::sqrt(std::max(rise_a * rise_a, rise_b * rise_b) / square);
        return {cosine < 0, std::max(0.0f, std::abs(cosine) - rise / 2)};
    }
    const float mirrored = cosine - 2 * rise_a * rise_b / square;
    return {mirrored < 0, std::abs(mirrored) / 2};
}

// Whole numbers, so that sums do not depend on the order.
constexpr float kVoteSteps = 1 << 20;

struct Vote {
    std::uint64_t pair;     // numbers of two sets, the smaller in the upper half
    std::int64_t opposite;  // certainty for opposite less that for equal signs, in kVoteSteps

    std::uint32_t low() const { return static_cast<std::uint32_t>(pair >> 32); }
    std::uint32_t high() const { return static_cast<std::uint32_t>(pair); }
};

class Orienter {
  public:
    Orienter(std::span<const Vec3f> positions, std::span<const StoredNeighbours> neighbours, std::span<CloudDisk> disks)
        : positions_(positions),
          neighbours_(neighbours),
          disks_(disks),
          set_(large_vector<std::uint32_t>(disks.size())) {}

    OrientationStats orient() {
        const std::size_t pieces = (disks_.size() + kPiece - 1) / kPiece;
        tbb::parallel_for(std::size_t{0}, pieces, [&](std::size_t piece) { join_piece(piece); });
        number_sets(pieces);
        std::vector<std::vector<Vote>> votes(pieces);
        tbb::parallel_for(std::size_t{0}, pieces, [&](std::size_t piece) { votes[piece] = count_votes(piece); });
        join_sets(votes);
        face_outward();
        return stats_;
    }

  private:
    Edge edge_between(std::size_t a, std::size_t b) const {
        return judge(positions_[b] - positions_[a], disks_[a].normal, disks_[b].normal);
    }
    bool is_neighbour(std::size_t of, std::size_t point) const {
        return std::ranges::count(neighbours_[of], static_cast<std::uint32_t>(point)) != 0;
    }
    bool is_within(std::size_t piece, const Vote& vote) const {
        return vote.low() >= first_set_[piece] && vote.high() < first_set_[piece + 1];
    }
    std::size_t end_of(std::size_t piece) const { return std::min(disks_.size(), (piece + 1) * kPiece); }

    // Kruskal's algorithm on the certain edges inside a piece; those beyond doubt are neither sorted nor, once their
    // ends are joined, looked at.
    void join_piece(std::size_t piece) {
        const std::size_t begin = piece * kPiece, end = end_of(piece);
        struct Candidate {
            std::uint16_t a, b;
            std::uint8_t bucket;
            bool opposite;
        };
        SignedSets sets(end - begin);
        std::vector<Candidate> found;
        std::array<std::size_t, kBuckets> place{};
        for (std::size_t a = begin; a < end; ++a) {
            const auto own = static_cast<std::uint32_t>(a - begin);
            for (const std::uint32_t b : neighbours_[a]) {
                if (b < begin || b >= end || b == a) continue;
                const auto other = static_cast<std::uint32_t>(b - begin);
                if (sets.are_joined(own, other)) continue;
                if (std::abs(disks_[a].normal.dot(disks_[b].normal)) < kCertain) continue;
                const Edge edge = edge_between(a, b);
                if (edge.certainty < kCertain) continue;
                if (edge.certainty >= kBeyondDoubt) {
                    sets.join(own, other, edge.opposite);
                    continue;
                }
                // From b's side this edge was seen already.
                if (b < a && is_neighbour(b, a)) continue;
                const float share = (kBeyondDoubt - edge.certainty) / (kBeyondDoubt - kCertain);
                const auto bucket = std::min(static_cast<std::size_t>(share * kBuckets), kBuckets - 1);
                ++place[bucket];
                found.push_back({static_cast<std::uint16_t>(own), static_cast<std::uint16_t>(other),
                                 static_cast<std::uint8_t>(bucket), edge.opposite});
            }
        }
        // The most certain bucket first.
        std::exclusive_scan(place.begin(), place.end(), place.begin(), std::size_t{0});
        std::vector<Candidate> sorted(found.size());
        for (const Candidate& candidate : found)
            sorted[place[candidate.bucket]++] = candidate;
        for (const Candidate& candidate : sorted)
            sets.join(candidate.a, candidate.b, candidate.opposite);
        for (std::size_t a = begin; a < end; ++a) {
            const auto [representative, opposite] = sets.find(static_cast<std::uint32_t>(a - begin));
            set_[a] = static_cast<std::uint32_t>(begin + representative);
            if (opposite) flip(a);
        }
    }

    // From representatives to consecutive numbers, piece by piece; a representative is the first point of its set.
    void number_sets(std::size_t pieces) {
        first_set_.assign(pieces + 1, 0);
        tbb::parallel_for(std::size_t{0}, pieces, [&](std::size_t piece) {
            for (std::size_t a = piece * kPiece; a < end_of(piece); ++a)
                first_set_[piece + 1] += set_[a] == a;
        });
        std::inclusive_scan(first_set_.begin(), first_set_.end(), first_set_.begin());
        sets_ = first_set_.back();
        tbb::parallel_for(std::size_t{0}, pieces, [&](std::size_t piece) {
            std::uint32_t next = first_set_[piece];
            for (std::size_t a = piece * kPiece; a < end_of(piece); ++a)
                set_[a] = set_[a] == a ? next++ : set_[set_[a]];
        });
    }

    // Of a piece's sets and those beside them. Within the piece only such votes are left as Kruskal's algorithm would
    // not pass over for clearer ones of the same piece: so it would among the votes of all pieces.
    std::vector<Vote> count_votes(std::size_t piece) const {
        std::vector<Vote> votes;
        for (std::size_t a = piece * kPiece; a < end_of(piece); ++a) {
            for (const std::uint32_t b : neighbours_[a]) {
                if (set_[a] == set_[b]) continue;
                // Edges that both ends name are counted twice at once.
                const bool mutual = is_neighbour(b, a);
                if (b < a && mutual) continue;
                const auto [low, high] = std::minmax(set_[a], set_[b]);
                const Edge edge = edge_between(a, b);
                const auto weight = (mutual ? 2 : 1) * static_cast<std::int64_t>(edge.certainty * kVoteSteps);
                votes.push_back({std::uint64_t{low} << 32 | high, edge.opposite ? weight : -weight});
            }
        }
        votes = summed(std::move(votes));
        const auto inner =
            std::partition(votes.begin(), votes.end(), [&](const Vote& vote) { return is_within(piece, vote); });
        std::sort(votes.begin(), inner, is_clearer);
        SignedSets sets(first_set_[piece + 1] - first_set_[piece]);
        votes.erase(std::remove_if(votes.begin(), inner,
                                   [&](const Vote& vote) {
                                       return !sets.join(vote.low() - first_set_[piece],
                                                         vote.high() - first_set_[piece], vote.opposite > 0);
                                   }),
                    inner);
        return votes;
    }

    // By pair.
    static std::vector<Vote> summed(std::vector<Vote> votes) {
        tbb::parallel_sort(votes.begin(), votes.end(), [](const Vote& a, const Vote& b) { return a.pair < b.pair; });
        std::size_t sums = 0;
        for (const Vote& vote : votes) {
            if (sums == 0 || votes[sums - 1].pair != vote.pair) {
                votes[sums++] = vote;
            } else {
                votes[sums - 1].opposite += vote.opposite;
            }
        }
        votes.resize(sums);
        return votes;
    }

    static bool is_clearer(const Vote& a, const Vote& b) {
        const std::int64_t of_a = std::abs(a.opposite), of_b = std::abs(b.opposite);
        return of_a != of_b ? of_a > of_b : a.pair < b.pair;
    }

    // The pairs with the clearest votes first.
    void join_sets(const std::vector<std::vector<Vote>>& votes_of_pieces) {
        // Two pieces may have voted on a pair only if it has a set of each.
        std::vector<Vote> votes, across;
        for (std::size_t piece = 0; piece < votes_of_pieces.size(); ++piece)
            for (const Vote& vote : votes_of_pieces[piece])
                (is_within(piece, vote) ? votes : across).push_back(vote);
        across = summed(std::move(across));
        votes.insert(votes.end(), across.begin(), across.end());
        tbb::parallel_sort(votes.begin(), votes.end(), is_clearer);
        SignedSets components(sets_);
        for (const Vote& vote : votes)
            components.join(vote.low(), vote.high(), vote.opposite > 0);
        place_.reserve(sets_);
        for (std::uint32_t set = 0; set < sets_; ++set)
            place_.push_back(components.find(set));
    }

    // Sums over a set or component, weighted by area.
    struct Sums {
        double area = 0;
        Vec3d centre = Vec3d::Zero(), normal = Vec3d::Zero();
        double outward = 0;  // of normal times position

        void add(const Sums& other, double sign) {
            area += other.area;
            centre += other.centre;
            normal += sign * other.normal;
            outward += sign * other.outward;
        }
    };

    void face_outward() {
        std::vector<Sums> sums(sets_);
        const std::size_t pieces = first_set_.size() - 1;
        tbb::parallel_for(std::size_t{0}, pieces, [&](std::size_t piece) {
            for (std::size_t point = piece * kPiece; point < end_of(piece); ++point) {
                Sums& set = sums[set_[point]];
                const auto radius = static_cast<double>(disks_[point].radius);
                const double area = radius * radius;
                const Vec3d normal = area * disks_[point].normal.cast<double>(),
                            position = positions_[point].cast<double>();
                set.area += area;
                set.centre += area * position;
                set.normal += normal;
                set.outward += normal.dot(position);
            }
        });
        std::vector<Sums> components(sets_);
        for (std::uint32_t set = 0; set < sets_; ++set)
            components[place_[set].representative].add(sums[set], place_[set].opposite ? -1 : 1);
        std::vector<char> inward(sets_, 0);
        for (std::uint32_t set = 0; set < sets_; ++set) {
            const Sums& component = components[set];
            if (place_[set].representative != set) continue;
            ++stats_.components;
            Vec3d::Index axis = 0;
            component.normal.cwiseAbs().maxCoeff(&axis);
            const bool closed = component.normal.norm() < kClosed * component.area;
            const double outward = component.outward - component.normal.dot(component.centre) / component.area;
            inward[set] = (closed ? outward : component.normal[axis]) < 0;
        }
        std::atomic<std::uint64_t> flipped{0};
        tbb::parallel_for(std::size_t{0}, pieces, [&](std::size_t piece) {
            std::uint64_t of_piece = 0;
            for (std::size_t point = piece * kPiece; point < end_of(piece); ++point) {
                const SignedSets::Place place = place_[set_[point]];
                if (place.opposite == (inward[place.representative] != 0)) continue;
                flip(point);
                ++of_piece;
            }
            flipped += of_piece;
        });
        stats_.flipped_normals = flipped;
    }

    void flip(std::size_t point) {
        CloudDisk& disk = disks_[point];
        disk.normal = -disk.normal;
        std::swap(disk.above, disk.below);
    }

    std::span<const Vec3f> positions_;
    std::span<const StoredNeighbours> neighbours_;
    std::span<CloudDisk> disks_;
    std::vector<std::uint32_t> set_;  // of each point: its representative, later its number
    std::uint32_t sets_ = 0;
    std::vector<std::uint32_t> first_set_;  // of each piece
    std::vector<SignedSets::Place> place_;  // of each set in its component
    OrientationStats stats_;
};

}  // namespace

OrientationStats orient_normals(std::span<const Vec3f> positions, std::span<const StoredNeighbours> neighbours,
                                std::span<CloudDisk> disks) {
    return Orienter(positions, neighbours, disks).orient();
}

}  // namespace splice
