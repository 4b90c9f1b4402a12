#include "preprocess/simplify/collapse_mesh.h"

#include <Eigen/Geometry>

namespace splice {

void CollapseMesh::begin(std::size_t triangles) {
    for (auto* array : {&corner_vertex_, &corner_render_, &next_corner_, &mesh_position_, &first_corner_, &degree_})
        array->clear();
    position_.clear();
    normal_.clear();
    alive_.assign(triangles, 1);
    alive_count_ = triangles;
}

CollapseMesh::Index CollapseMesh::add_corner(const IndexedMesh& mesh, Index mesh_position, Index render) {
    Index& vertex = local_of_position_[mesh_position];
    if (vertex == kNone) {
        vertex = static_cast<Index>(position_.size());
        position_.push_back(mesh.positions[mesh_position].cast<double>());
        normal_.push_back(Vec3d::Zero());
        mesh_position_.push_back(mesh_position);
        first_corner_.push_back(kNone);
        degree_.push_back(0);
    }
    const Index corner = static_cast<Index>(corner_vertex_.size());
    corner_vertex_.push_back(vertex);
    corner_render_.push_back(render);
    next_corner_.push_back(first_corner_[vertex]);
    first_corner_[vertex] = corner;
    ++degree_[vertex];
    return vertex;
}

Vec3d CollapseMesh::add_normal() {
    const Index* local = &corner_vertex_[corner_vertex_.size() - 3];
    const Vec3d cross = (position_[local[1]] - position_[local[0]]).cross(position_[local[2]] - position_[local[0]]);
    for (std::size_t k = 0; k < 3; ++k)
        normal_[local[k]] += cross;
    return cross;
}

void CollapseMesh::end_load() {
    mark_.assign(position_.size(), 0);
    current_mark_ = 0;
}

void CollapseMesh::forget() {
    for (const Index position : mesh_position_)
        local_of_position_[position] = kNone;
}

bool CollapseMesh::is_fan(Index vertex, Index start, Index end) const {
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
        if (at == end) return step + 1 == degree_[vertex];
    }
    return false;
}

CollapseMesh::EdgeTriangles CollapseMesh::triangles_on_edge(Index vertex, Index target) {
    const Index near = ++current_mark_;
    EdgeTriangles edge;
    for_each_corner(vertex, [&](Index corner) {
        mark_[after(corner)] = near;
        mark_[before(corner)] = near;
        if (after(corner) == target) {
            edge.simple = edge.simple && edge.tips[0] == kNone;
            edge.tips[0] = before(corner);
            edge.render[0] = corner_render_[next_in_triangle(corner)];
        } else if (before(corner) == target) {
            edge.simple = edge.simple && edge.tips[1] == kNone;
            edge.tips[1] = after(corner);
            edge.render[1] = corner_render_[next_in_triangle(next_in_triangle(corner))];
        }
    });
    return edge;
}

bool CollapseMesh::shares_only_tips(Index target, const EdgeTriangles& edge) {
    const Index near = current_mark_, seen = ++current_mark_;
    Index common = 0;
    bool folds = false;
    for_each_corner(target, [&](Index corner) {
        for (const Index neighbour : {after(corner), before(corner)}) {
            if (mark_[neighbour] != near) continue;
            mark_[neighbour] = seen;
            ++common;
        }
        folds = folds || (after(corner) == edge.tips[0] && before(corner) == edge.tips[1]) ||
                (after(corner) == edge.tips[1] && before(corner) == edge.tips[0]);
    });
    return common == edge.count() && !folds;
}

void CollapseMesh::drop_triangles_on_edge(Index vertex, Index target) {
    for_each_corner(vertex, [&](Index corner) {
        if (after(corner) != target && before(corner) != target) return;
        alive_[corner / 3] = 0;
        --alive_count_;
    });
}

void CollapseMesh::move_corners(Index vertex, Index target, Index render) {
    Index last = kNone;
    for_each_corner(vertex, [&](Index corner) {
        last = corner;
        corner_vertex_[corner] = target;
        corner_render_[corner] = render;
    });
    next_corner_[last] = first_corner_[target];
    first_corner_[target] = first_corner_[vertex];
    first_corner_[vertex] = kNone;
}

void CollapseMesh::drop_dead_corners(Index vertex) {
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

void CollapseMesh::add_ring(Index vertex) {
    const Index near = ++current_mark_;
    for (const Index touched : ring_)
        mark_[touched] = near;
    for_each_corner(vertex, [&](Index corner) {
        for (const Index neighbour : {after(corner), before(corner)}) {
            if (mark_[neighbour] == near) continue;
            mark_[neighbour] = near;
            ring_.push_back(neighbour);
        }
    });
}

}  // namespace splice
